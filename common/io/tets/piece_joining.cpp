// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/piece_joining.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "common/message_text.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

/// Maps the numbers of items in files, which may have gaps, to indices.
class NumberIndices {
 public:
  explicit NumberIndices(std::vector<std::int64_t> numbers) : numbers_(std::move(numbers)) {
    std::sort(numbers_.begin(), numbers_.end());
    numbers_.erase(std::unique(numbers_.begin(), numbers_.end()), numbers_.end());
  }
  std::size_t size() const { return numbers_.size(); }
  std::int64_t number(std::size_t index) const { return numbers_[index]; }
  /// Index of a number; size() if no item has it.
  std::size_t index(std::int64_t number) const {
    // In files of this program the numbers are the indices.
    if (number >= 0 && static_cast<std::size_t>(number) < size() &&
        numbers_[static_cast<std::size_t>(number)] == number)
      return static_cast<std::size_t>(number);
    const auto at = std::lower_bound(numbers_.begin(), numbers_.end(), number);
    return at == numbers_.end() || *at != number ? size() : static_cast<std::size_t>(at - numbers_.begin());
  }
  /// Smallest number from 0 on that is missing.
  std::int64_t first_missing() const {
    std::int64_t next = 0;
    for (const std::int64_t number : numbers_) {
      if (number != next) break;
      ++next;
    }
    return next;
  }

 private:
  std::vector<std::int64_t> numbers_;
};

bool equal_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

class PieceJoiner {
 public:
  PieceJoiner(std::vector<ReadPiece> pieces, const std::optional<WholeCounts>& whole, const std::string& name)
      : pieces_(std::move(pieces)),
        whole_(whole),
        name_(name),
        tets_(numbers_of_own_tets()),
        nodes_(numbers_of_nodes()) {}

  JoinedPieces join() {
    choose_fields();
    place_nodes();
    place_tets();
    check_counts();
    check_owners_of_nodes();
    compare_ghosts();
    take_faces();
    return std::move(out_);
  }

 private:
  static constexpr std::size_t nowhere = SIZE_MAX;
  struct Home {
    std::size_t piece = nowhere;
    Index local = 0;
  };

  [[noreturn]] void fail(std::size_t piece, const std::string& what) const {
    throw InputError(name_ + ": " + named(piece) + ": " + what);
  }
  std::string named(std::size_t piece) const {
    return "piece " + std::to_string(piece) + " (" + pieces_[piece].file + ")";
  }

  std::vector<std::int64_t> numbers_of_own_tets() const {
    std::vector<std::int64_t> numbers;
    for (const ReadPiece& piece : pieces_)
      for (std::size_t t = 0; t < piece.tets.size(); ++t)
        if (!piece.tet_ghosts[t]) numbers.push_back(piece.tet_numbers[t]);
    return numbers;
  }
  std::vector<std::int64_t> numbers_of_nodes() const {
    std::vector<std::int64_t> numbers;
    for (const ReadPiece& piece : pieces_)
      numbers.insert(numbers.end(), piece.node_numbers.begin(), piece.node_numbers.end());
    return numbers;
  }

  /// Compares the numbers with those of the whole mesh.
  void check_counts() const {
    if (!whole_) return;
    const auto check = [&](const NumberIndices& all, std::int64_t count, const char* what) {
      const std::int64_t missing = all.first_missing();
      if (missing < count)
        throw InputError(name_ + ": no piece has the " + what + " number " + std::to_string(missing) +
                         " of the mesh's " + std::to_string(count) +
                         "; the set of pieces is incomplete: write it again");
      if (all.size() > static_cast<std::size_t>(count))
        throw InputError(name_ + ": there is a " + what + " number " +
                         std::to_string(all.number(all.size() - 1)) + ", but the mesh has " +
                         std::to_string(count) + "; pieces of several meshes are mixed: write them again");
    };
    check(tets_, whole_->tets, "tet");
    check(nodes_, whole_->nodes, "point");
  }

  /// Sorts the fields of each piece into the order of the first piece that has items, and leaves out those
  /// that are not in all of these.
  void choose_fields() {
    choose_fields([](ReadPiece& p) -> std::vector<MeshField>& { return p.point_fields; },
                  [](const ReadPiece& p) { return p.points.size(); }, out_.mesh.point_fields);
    choose_fields([](ReadPiece& p) -> std::vector<MeshField>& { return p.cell_fields; },
                  [](const ReadPiece& p) { return p.tets.size(); }, out_.mesh.cell_fields);
  }
  template <class FieldsOf, class ItemsOf>
  void choose_fields(const FieldsOf& fields_of, const ItemsOf& items_of, std::vector<MeshField>& chosen) {
    bool first = true;
    const auto same_as = [](const MeshField& a) {
      return [&a](const MeshField& b) { return a.name == b.name && a.components == b.components; };
    };
    for (ReadPiece& piece : pieces_) {
      if (items_of(piece) == 0) continue;
      std::vector<MeshField>& fields = fields_of(piece);
      if (std::exchange(first, false))
        for (const MeshField& f : fields) chosen.push_back({f.name, f.components, f.integer, {}});
      const auto is_in = [&](const std::vector<MeshField>& all, const MeshField& field) {
        return std::any_of(all.begin(), all.end(), same_as(field));
      };
      for (const MeshField& field : fields)
        if (!is_in(chosen, field)) note_some(field.name);
      std::erase_if(chosen, [&](const MeshField& field) {
        const bool missing = !is_in(fields, field);
        if (missing) note_some(field.name);
        return missing;
      });
    }
    for (ReadPiece& piece : pieces_) {
      if (items_of(piece) == 0) continue;
      std::vector<MeshField> sorted;
      for (MeshField& field : chosen) {
        std::vector<MeshField>& fields = fields_of(piece);
        sorted.push_back(std::move(*std::find_if(fields.begin(), fields.end(), same_as(field))));
        field.integer &= sorted.back().integer;
      }
      fields_of(piece) = std::move(sorted);
    }
  }
  void note_some(const std::string& field) {
    if (std::find(out_.some_pieces.begin(), out_.some_pieces.end(), field) == out_.some_pieces.end())
      out_.some_pieces.push_back(field);
  }

  /// Copies the values of an item.
  /// \pre both lists are those of choose_fields()
  static void copy_values(const std::vector<MeshField>& from, Index local, std::vector<MeshField>& to,
                          std::size_t index) {
    for (std::size_t f = 0; f < to.size(); ++f) {
      const auto n = static_cast<std::size_t>(to[f].components);
      std::copy_n(from[f].values.begin() + static_cast<std::ptrdiff_t>(local * n), n,
                  to[f].values.begin() + static_cast<std::ptrdiff_t>(index * n));
    }
  }
  /// First field in which an item of a piece differs from the values that were copied; null: none.
  static const MeshField* differing(const std::vector<MeshField>& of_piece, Index local,
                                    const std::vector<MeshField>& copied, std::size_t index) {
    for (std::size_t f = 0; f < copied.size(); ++f) {
      const auto n = static_cast<std::size_t>(copied[f].components);
      for (std::size_t k = 0; k < n; ++k)
        if (!equal_bits(of_piece[f].values[local * n + k], copied[f].values[index * n + k]))
          return &copied[f];
    }
    return nullptr;
  }
  static void resize_values(std::vector<MeshField>& fields, std::size_t items) {
    for (MeshField& field : fields) field.values.resize(static_cast<std::size_t>(field.components) * items);
  }

  void place_nodes() {
    TetMesh& mesh = out_.mesh;
    if (nodes_.size() >= no_index)
      throw InputError(name_ + ": more than " + std::to_string(no_index - 1) + " points; split the mesh");
    mesh.points.resize(nodes_.size());
    resize_values(mesh.point_fields, nodes_.size());
    std::vector<std::size_t> first(nodes_.size(), nowhere), last(nodes_.size(), nowhere);
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const ReadPiece& piece = pieces_[i];
      for (Index p = 0; p < piece.points.size(); ++p) {
        const std::size_t at = nodes_.index(piece.node_numbers[p]);
        if (last[at] == i) fail(i, point_text(piece, p) + " is there twice; write the pieces again");
        last[at] = i;
        if (first[at] == nowhere) {
          first[at] = i;
          mesh.points[at] = piece.points[p];
          copy_values(piece.point_fields, p, mesh.point_fields, at);
          continue;
        }
        for (int k = 0; k < 3; ++k)
          if (!equal_bits(piece.points[p][k], mesh.points[at][k]))
            fail(i, point_text(piece, p) + " is elsewhere than in " + named(first[at]) +
                        "; the pieces do not belong together: write them again");
        if (const MeshField* field = differing(piece.point_fields, p, mesh.point_fields, at))
          fail(i, point_text(piece, p) + " has another value of " + in_quotes(field->name) + " than in " +
                      named(first[at]) + "; the pieces do not belong together: write them again");
      }
    }
  }
  static std::string point_text(const ReadPiece& piece, Index local) {
    return "point number " + std::to_string(piece.node_numbers[local]);
  }

  /// Checks that one piece owns each node, if all pieces tell.
  void check_owners_of_nodes() const {
    if (std::any_of(pieces_.begin(), pieces_.end(),
                    [](const ReadPiece& p) { return p.node_ghosts.empty() && !p.points.empty(); }))
      return;
    std::vector<std::size_t> owner(nodes_.size(), nowhere);
    for (std::size_t i = 0; i < pieces_.size(); ++i)
      for (Index p = 0; p < pieces_[i].points.size(); ++p) {
        if (pieces_[i].node_ghosts[p]) continue;
        std::size_t& known = owner[nodes_.index(pieces_[i].node_numbers[p])];
        if (known != nowhere)
          fail(i, point_text(pieces_[i], p) + " is its own, and also that of " + named(known) +
                      "; write the pieces again");
        known = i;
      }
    for (std::size_t at = 0; at < owner.size(); ++at)
      if (owner[at] == nowhere)
        throw InputError(name_ + ": point number " + std::to_string(nodes_.number(at)) +
                         " is a ghost in all pieces; the set of pieces is incomplete: write it again");
  }

  void place_tets() {
    TetMesh& mesh = out_.mesh;
    mesh.tets.resize(tets_.size());
    resize_values(mesh.cell_fields, tets_.size());
    homes_.assign(tets_.size(), {});
    const bool second_order =
        std::any_of(pieces_.begin(), pieces_.end(), [](const ReadPiece& p) { return !p.midside.empty(); });
    if (second_order) out_.midside.resize(6 * tets_.size());
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const ReadPiece& piece = pieces_[i];
      if (second_order && piece.midside.empty() && !piece.tets.empty())
        fail(i, "its tets have 4 nodes, those of other pieces 10; write the pieces again");
      for (Index t = 0; t < piece.tets.size(); ++t) {
        if (piece.tet_ghosts[t]) continue;
        const std::size_t at = tets_.index(piece.tet_numbers[t]);
        Home& home = homes_[at];
        if (home.piece != nowhere)
          fail(i, "tet number " + std::to_string(piece.tet_numbers[t]) + " is its own, and also that of " +
                      named(home.piece) + "; write the pieces again");
        home = {i, t};
        for (std::size_t k = 0; k < 4; ++k) mesh.tets[at][k] = node(piece, piece.tets[t][k]);
        if (second_order)
          for (std::size_t k = 0; k < 6; ++k) out_.midside[6 * at + k] = node(piece, piece.midside[t][k]);
        copy_values(piece.cell_fields, t, mesh.cell_fields, at);
      }
    }
  }
  Index node(const ReadPiece& piece, Index local) const {
    return static_cast<Index>(nodes_.index(piece.node_numbers[local]));
  }

  void compare_ghosts() const {
    std::vector<std::size_t> last(tets_.size(), nowhere);
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const ReadPiece& piece = pieces_[i];
      for (Index t = 0; t < piece.tets.size(); ++t) {
        const std::size_t at = tets_.index(piece.tet_numbers[t]);
        const auto tet = [&] { return "tet number " + std::to_string(piece.tet_numbers[t]); };
        if (at == tets_.size())
          fail(i,
               tet() + " is a ghost, but no piece owns it; the set of pieces is incomplete: write it again");
        if (last[at] == i) fail(i, tet() + " is there twice; write the pieces again");
        last[at] = i;
        if (!piece.tet_ghosts[t]) continue;
        bool same = true;
        for (std::size_t k = 0; k < 4; ++k) same &= node(piece, piece.tets[t][k]) == out_.mesh.tets[at][k];
        if (!out_.midside.empty())
          for (std::size_t k = 0; k < 6; ++k)
            same &= node(piece, piece.midside[t][k]) == out_.midside[6 * at + k];
        const std::string of_owner = " than in its own piece " + std::to_string(homes_[at].piece) +
                                     "; the pieces do not belong together: write them again";
        if (!same) fail(i, "ghost " + tet() + " has other points" + of_owner);
        if (const MeshField* field = differing(piece.cell_fields, t, out_.mesh.cell_fields, at))
          fail(i, "ghost " + tet() + " has another value of " + in_quotes(field->name) + of_owner);
      }
    }
  }

  /// Lists the faces in groups.
  void take_faces() {
    struct Face {
      Triangle ids;
      std::int64_t group;
      std::size_t tet;
    };
    std::vector<Face> faces;
    for (std::size_t at = 0; at < homes_.size(); ++at) {
      const ReadPiece& piece = pieces_[homes_[at].piece];
      if (piece.face_groups.empty()) continue;
      for (std::size_t f = 0; f < 4; ++f) {
        const std::int64_t group = piece.face_groups[4 * std::size_t{homes_[at].local} + f];
        if (group == 0) continue;
        const Tet& tet = out_.mesh.tets[at];
        Face face{{tet[tet_faces[f][0]], tet[tet_faces[f][1]], tet[tet_faces[f][2]]}, group, at};
        std::sort(face.ids.begin(), face.ids.end());
        faces.push_back(face);
      }
    }
    std::sort(faces.begin(), faces.end(),
              [](const Face& a, const Face& b) { return a.ids != b.ids ? a.ids < b.ids : a.tet < b.tet; });
    for (std::size_t i = 0; i < faces.size(); ++i) {
      if (i == 0 || faces[i].ids != faces[i - 1].ids) {
        out_.faces.add(faces[i].ids, faces[i].group);
      } else if (faces[i].group != faces[i - 1].group) {
        const std::int64_t number = tets_.number(faces[i].tet);
        fail(homes_[faces[i].tet].piece, "a face of tet number " + std::to_string(number) + " is in group " +
                                             std::to_string(faces[i].group) +
                                             ", but on its other side in group " +
                                             std::to_string(faces[i - 1].group) + "; write the pieces again");
      }
    }
  }

  std::vector<ReadPiece> pieces_;
  const std::optional<WholeCounts>& whole_;
  const std::string& name_;
  NumberIndices tets_, nodes_;
  std::vector<Home> homes_;  ///< of each tet
  JoinedPieces out_;
};

}  // namespace

JoinedPieces join_pieces(std::vector<ReadPiece> pieces, const std::optional<WholeCounts>& whole,
                         const std::string& name) {
  return PieceJoiner(std::move(pieces), whole, name).join();
}

}  // namespace tetwright
