// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/msh4_pieces.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "common/io/tets/msh4_numbers.h"
#include "common/io/tets/msh_data.h"
#include "common/io/tets/msh_elements.h"
#include "common/io/tets/msh_groups.h"
#include "common/io/text/text_writer.h"
#include "tetwright/io.h"

namespace tetwright {

namespace {

/// The piece without the triangles that other pieces write.
MeshPiece without_foreign_triangles(MeshPiece piece) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < piece.mesh.interfaces.size(); ++i) {
    if (piece.face_owners[i] != piece.part) continue;
    piece.mesh.interfaces[kept] = piece.mesh.interfaces[i];
    piece.face_numbers[kept] = piece.face_numbers[i];
    if (piece.midside) piece.midside->of_faces[kept] = piece.midside->of_faces[i];
    ++kept;
  }
  piece.mesh.interfaces.resize(kept);
  piece.face_numbers.resize(kept);
  if (piece.midside) piece.midside->of_faces.resize(kept);
  return piece;
}

class Msh4PieceWriter {
 public:
  Msh4PieceWriter(const MeshPiece& piece, const DividedMesh& whole, bool binary, const ByteSink& sink)
      : piece_(without_foreign_triangles(piece)),
        whole_(whole),
        groups_(whole.names),
        volumes_(msh4_volumes(whole.names)),
        out_(sink),
        numbers_(out_, binary),
        binary_(binary),
        written_(piece_.mesh, piece_.midside ? &*piece_.midside : nullptr) {
    for (const BoundaryGroups::Group& group : groups_.faces.all()) surfaces_.insert(group.number);
    for (const InterfaceTriangle& t : whole.names.interfaces) {
      if (t.is_sheet()) continue;  // it bounds no volume
      const std::int64_t number = groups_.faces.number_of(t);
      bounds_[volumes_.at(t.material)].insert(number);
      if (t.other) bounds_[volumes_.at(*t.other)].insert(-number);
    }
    collect_parts();
    classify_nodes();
  }

  void write() {
    numbers_.begin_file();
    write_msh4_groups(out_, groups_, volumes_);
    write_parents();
    write_parts();
    write_nodes();
    write_elements();
    write_ghosts();
    std::vector<std::size_t> node_numbers, nodes;
    for (const std::uint64_t n : piece_.node_numbers) node_numbers.push_back(n + 1);
    for (const Part& part : parts_) nodes.insert(nodes.end(), part.nodes.begin(), part.nodes.end());
    std::string data;
    append_msh_data(data, "NodeData", written_.node_fields(), nodes.size(), binary_, nodes, node_numbers);
    std::vector<std::size_t> element_numbers, elements;
    for (const std::uint64_t n : piece_.tet_numbers) element_numbers.push_back(n + 1);
    for (const std::uint64_t n : piece_.face_numbers) element_numbers.push_back(whole_.tets + n + 1);
    for (const Part& part : parts_)
      for (const std::size_t e : part.elements)
        elements.push_back((part.dimension == surface_dimension ? piece_.mesh.tets.size() : 0) + e);
    append_msh_data(data, "ElementData", fields_of_elements(piece_.mesh), elements.size(), binary_, elements,
                    element_numbers);
    out_ << data;
    out_.flush();
  }

 private:
  /// A surface or volume of the piece; the last one holds its ghosts.
  struct Part {
    int dimension;
    std::int64_t number, parent;        ///< parent 0: ghosts
    std::vector<std::size_t> elements;  ///< tets or triangles of the piece
    std::vector<std::size_t> nodes;     ///< nodes classified on it, ascending
    Vec3 min = Vec3::Constant(std::numeric_limits<double>::infinity());
    Vec3 max = -min;
  };

  /// Number of this piece's part of the surface or volume `index`: unique among all pieces, and no parent's.
  std::int64_t free_number(const std::set<std::int64_t>& parents, std::size_t index) const {
    auto number = static_cast<std::int64_t>(index * whole_.parts + piece_.part + 1);
    for (const std::int64_t parent : parents)
      if (parent <= number) ++number;
    return number;
  }

  void collect_parts() {
    std::size_t index = 0;
    std::map<std::int64_t, std::size_t> part_of_surface, part_of_volume;
    for (const std::int64_t surface : surfaces_) {
      part_of_surface[surface] = parts_.size();
      parts_.push_back({surface_dimension, free_number(surfaces_, index++), surface, {}, {}});
    }
    std::set<std::int64_t> numbers;
    for (const auto& [tag, number] : volumes_) numbers.insert(number);
    index = 0;
    const auto add_volume = [&](std::int64_t parent) {
      parts_.push_back({volume_dimension, free_number(numbers, index++), parent, {}, {}});
    };
    for (const std::int64_t volume : numbers) {
      part_of_volume[volume] = parts_.size();
      add_volume(volume);
    }
    add_volume(0);
    for (std::size_t i = 0; i < piece_.mesh.interfaces.size(); ++i)
      parts_[part_of_surface.at(groups_.faces.number_of(piece_.mesh.interfaces[i]))].elements.push_back(i);
    for (std::size_t t = 0; t < piece_.own_tets; ++t)
      parts_[part_of_volume.at(volumes_.at(piece_.mesh.materials[t]))].elements.push_back(t);
    for (std::size_t t = piece_.own_tets; t < piece_.mesh.tets.size(); ++t)
      parts_.back().elements.push_back(t);
    std::erase_if(parts_, [](const Part& part) { return part.elements.empty(); });
  }

  /// Classifies each node on the first part that has an element at it.
  void classify_nodes() {
    std::vector<std::uint8_t> done(written_.nodes(), 0);
    for (Part& part : parts_) {
      for (const std::size_t e : part.elements)
        for (const Index node : nodes_of(part, e)) {
          part.min = part.min.cwiseMin(written_.node(node));
          part.max = part.max.cwiseMax(written_.node(node));
          if (!std::exchange(done[node], 1)) part.nodes.push_back(node);
        }
      std::sort(part.nodes.begin(), part.nodes.end());
    }
    for (std::size_t node = 0; node < done.size(); ++node)
      if (!done[node]) parts_.back().nodes.push_back(node);  // without a tet
  }

  /// Nodes of an element in Gmsh's order.
  std::vector<Index> nodes_of(const Part& part, std::size_t element) const {
    std::vector<Index> nodes;
    const auto add = [&](const auto& corners) { nodes.insert(nodes.end(), corners.begin(), corners.end()); };
    const auto add_midside = [&](Index m) {
      nodes.push_back(static_cast<Index>(piece_.mesh.points.size()) + m);
    };
    if (part.dimension == surface_dimension) {
      add(piece_.mesh.interfaces[element].ids);
      if (piece_.midside)
        for (const Index m : piece_.midside->of_faces[element]) add_midside(m);
    } else {
      add(piece_.mesh.tets[element]);
      if (piece_.midside)
        for (const std::size_t m : msh_midside_order) add_midside(piece_.midside->of_tets[element][m]);
    }
    return nodes;
  }

  void write_box(const Vec3& low, const Vec3& high) {
    for (const Vec3& corner : {low, high})
      for (const double x : corner) numbers_.real(x);
  }

  void write_parents() {
    out_ << "$Entities\n";
    std::set<std::int64_t> numbers;
    for (const auto& [tag, number] : volumes_) numbers.insert(number);
    numbers_.size(0).size(0).size(surfaces_.size()).size(numbers.size()).end_line();
    const auto write = [&](std::int64_t number, const std::set<std::int64_t>& bounds) {
      numbers_.integer(number);
      write_box(whole_.low, whole_.high);
      numbers_.size(1).integer(number).size(bounds.size());
      for (const std::int64_t bound : bounds) numbers_.integer(bound);
      numbers_.end_line();
    };
    for (const std::int64_t surface : surfaces_) write(surface, {});
    for (const std::int64_t volume : numbers) write(volume, bounds_[volume]);
    numbers_.end("Entities");
  }

  bool has_ghosts() const { return parts_.back().parent == 0; }

  void write_parts() {
    const auto part_number = static_cast<std::int64_t>(piece_.part) + 1;
    out_ << "$PartitionedEntities\n";
    numbers_.size(whole_.parts).end_line();
    numbers_.size(has_ghosts() ? 1 : 0).end_line();
    if (has_ghosts()) {
      numbers_.integer(parts_.back().number).integer(part_number);
      numbers_.end_line();
    }
    const auto count = [&](int dimension) {
      return static_cast<std::size_t>(std::count_if(parts_.begin(), parts_.end(), [&](const Part& part) {
        return part.dimension == dimension && part.parent != 0;
      }));
    };
    numbers_.size(0).size(0).size(count(surface_dimension)).size(count(volume_dimension)).end_line();
    for (const Part& part : parts_) {
      if (part.parent == 0) continue;
      numbers_.integer(part.number).integer(part.dimension).integer(part.parent);
      numbers_.size(1).integer(part_number);
      write_box(part.min, part.max);
      numbers_.size(1).integer(part.parent).size(0).end_line();
    }
    numbers_.end("PartitionedEntities");
  }

  void begin_block(const Part& part, std::int64_t kind, std::size_t items) {
    numbers_.integer(part.dimension).integer(part.number).integer(kind).size(items).end_line();
  }

  void write_nodes() {
    out_ << "$Nodes\n";
    numbers_.size(parts_.size()).size(written_.nodes());
    numbers_.size(piece_.node_numbers.empty() ? 0 : node_number(0));
    std::size_t largest = 0;
    for (std::size_t node = 0; node < written_.nodes(); ++node)
      largest = std::max(largest, node_number(node));
    numbers_.size(largest).end_line();
    for (const Part& part : parts_) {
      begin_block(part, 0, part.nodes.size());
      for (const std::size_t node : part.nodes) numbers_.size(node_number(node)).end_line();
      for (const std::size_t node : part.nodes) {
        for (const double x : written_.node(node)) numbers_.real(x);
        numbers_.end_line();
      }
    }
    numbers_.end("Nodes");
  }
  std::size_t node_number(std::size_t node) const { return piece_.node_numbers[node] + 1; }
  std::size_t element_number(const Part& part, std::size_t e) const {
    return part.dimension == surface_dimension ? whole_.tets + piece_.face_numbers[e] + 1
                                               : piece_.tet_numbers[e] + 1;
  }

  void write_elements() {
    out_ << "$Elements\n";
    std::size_t count = 0, smallest = SIZE_MAX, largest = 0;
    for (const Part& part : parts_)
      for (const std::size_t e : part.elements) {
        ++count;
        smallest = std::min(smallest, element_number(part, e));
        largest = std::max(largest, element_number(part, e));
      }
    numbers_.size(parts_.size()).size(count).size(smallest).size(largest).end_line();
    for (const Part& part : parts_) {
      begin_block(part,
                  part.dimension == surface_dimension
                      ? (piece_.midside ? element::quadratic_triangle.msh : element::triangle.msh)
                      : (piece_.midside ? element::quadratic_tet.msh : element::tet.msh),
                  part.elements.size());
      for (const std::size_t e : part.elements) {
        numbers_.size(element_number(part, e));
        for (const Index node : nodes_of(part, e)) numbers_.size(node_number(node));
        numbers_.end_line();
      }
    }
    numbers_.end("Elements");
  }

  void write_ghosts() {
    if (!has_ghosts()) return;
    out_ << "$GhostElements\n";
    numbers_.size(parts_.back().elements.size()).end_line();
    for (const std::size_t t : parts_.back().elements) {
      numbers_.size(piece_.tet_numbers[t] + 1).integer(static_cast<std::int64_t>(piece_.tet_owners[t]) + 1);
      numbers_.size(1).integer(static_cast<std::int64_t>(piece_.part) + 1).end_line();
    }
    numbers_.end("GhostElements");
  }

  MeshPiece piece_;
  const DividedMesh& whole_;
  MshGroups groups_;
  std::map<std::int64_t, std::int64_t> volumes_;           ///< numbers by material
  std::set<std::int64_t> surfaces_;                        ///< numbers
  std::map<std::int64_t, std::set<std::int64_t>> bounds_;  ///< signed surfaces of each volume
  TextWriter out_;
  Msh4Numbers numbers_;
  bool binary_;
  MeshToWrite written_;
  std::vector<Part> parts_;  ///< surfaces, volumes, ghosts; those with elements
};

}  // namespace

void write_msh41_piece(const MeshPiece& piece, const DividedMesh& whole, bool binary, const ByteSink& sink) {
  Msh4PieceWriter(piece, whole, binary, sink).write();
}

std::vector<std::string> files_of_msh_pieces(const std::string& path, PartNumber parts) {
  const std::filesystem::path name(path);
  const std::string stem = (name.parent_path() / name.stem()).string(), extension = name.extension().string();
  std::vector<std::string> files;
  for (PartNumber part = 0; part < parts; ++part)
    files.push_back(std::string(stem).append("_").append(std::to_string(part + 1)).append(extension));
  return files;
}

}  // namespace tetwright
