// SPDX-License-Identifier: Apache-2.0
#include "tetwright/io.h"

#include <algorithm>
#include <array>
#include <optional>
#include <set>

#include "common/io/surfaces/surface_builder.h"
#include "common/io/tets/msh_data.h"
#include "common/io/text/text_scanner.h"
#include "common/unique_names.h"
#include "tetwright/error.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/sheets.h"

namespace tetwright {

namespace {

constexpr std::size_t max_groups = 0xffff;

/// A group with a larger share of the faces between two tets of one material lists the faces of the tets; it
/// is no sheet.
constexpr double max_sheet_share = 0.5;

Triangle sorted(Triangle ids) {
  std::sort(ids.begin(), ids.end());
  return ids;
}

class TriangleTaker {
 public:
  TriangleTaker(const FileTriangles& listed, const std::string& group_word, const std::string& file,
                ReadTetMesh& read)
      : listed_(listed),
        group_word_(group_word),
        file_(file),
        read_(read),
        interfaces_(find_interfaces(read.mesh)),
        group_of_(interfaces_.size(), 0) {}

  void take() {
    for (std::size_t i = 0; i < listed_.triangles.size(); ++i) add(i);
    count_groups();
    take_others();
    find_derived();
    for (const std::int64_t number : derived_) restored_ += groups_.at(number).triangles;
    set_patches();
    note();
  }

 private:
  /// Converts a name to the form of the format.
  std::string form(const std::string& name) const {
    return listed_.name_form ? listed_.name_form(name) : msh_name(name);
  }

  struct Group {
    std::size_t triangles = 0;
    std::set<MaterialPair> pairs;
  };
  struct FacesOfPair {
    std::size_t without_group = 0;
    std::set<std::int64_t> groups;
  };

  void add(std::size_t i) {
    const Triangle ids = sorted(listed_.triangles[i]);
    const std::int64_t number = listed_.groups[i];
    const auto face =
        std::lower_bound(interfaces_.begin(), interfaces_.end(), ids,
                         [](const InterfaceTriangle& f, const Triangle& t) { return sorted(f.ids) < t; });
    if (face == interfaces_.end() || sorted(face->ids) != ids) {
      if (number != 0)
        others_.push_back(i);
      else
        ++without_group_;
      return;
    }
    std::int64_t& group = group_of_[static_cast<std::size_t>(face - interfaces_.begin())];
    if (number == 0)
      ++restored_;
    else if (group == 0)
      group = number;
    else
      ++repeated_;
  }

  /// Takes the triangles that are not on the boundary or an interface. Those of a group that has none there
  /// are sheets.
  void take_others() {
    if (others_.empty()) return;
    const TetMesh& mesh = read_.mesh;
    std::vector<std::uint8_t> candidates(mesh.points.size(), 0);
    for (const std::size_t i : others_)
      for (const Index vertex : listed_.triangles[i])
        if (vertex < candidates.size()) candidates[vertex] = 1;
    const std::vector<MeshFace> faces = mesh_faces(mesh.tets, mesh.points.size(), &candidates);
    for (const std::size_t i : others_) {
      const Triangle ids = sorted(listed_.triangles[i]);
      const auto face = std::lower_bound(faces.begin(), faces.end(), ids,
                                         [](const MeshFace& f, const Triangle& t) { return f.ids < t; });
      if (face == faces.end() || face->ids != ids) fail(i);
      const std::int64_t number = listed_.groups[i];
      if (face->count != 2 || groups_.contains(number)) {
        ++inside_groups_;
        continue;
      }
      const MaterialTag material = mesh.materials[face->first];
      const auto [known, added] = sheet_of_face_.try_emplace(ids, number);
      if (added)
        sheets_[number].push_back({ids, material, material});
      else
        ++repeated_;
    }
    drop_lists_of_all_faces();
  }

  /// Drops groups that list most faces of the tets.
  void drop_lists_of_all_faces() {
    const TetMesh& mesh = read_.mesh;
    const std::size_t between_materials = static_cast<std::size_t>(
        std::count_if(interfaces_.begin(), interfaces_.end(),
                      [](const InterfaceTriangle& t) { return t.other.has_value(); }));
    const std::size_t boundary = interfaces_.size() - between_materials;
    const std::size_t sides = 4 * mesh.tets.size();
    if (sides < boundary + 2 * between_materials) return;  // the mesh is not valid
    const std::size_t inner = (sides - boundary) / 2 - between_materials;
    for (auto sheet = sheets_.begin(); sheet != sheets_.end();) {
      if (static_cast<double>(sheet->second.size()) > max_sheet_share * static_cast<double>(inner) &&
          sheet->second.size() > 1) {
        inside_groups_ += sheet->second.size();
        sheet = sheets_.erase(sheet);
      } else {
        ++sheet;
      }
    }
  }

  void count_groups() {
    for (std::size_t f = 0; f < interfaces_.size(); ++f) {
      const MaterialPair pair = interfaces_[f].pair();
      FacesOfPair& of_pair = pairs_[pair];
      if (const std::int64_t number = group_of_[f]) {
        Group& group = groups_[number];
        ++group.triangles;
        group.pairs.insert(pair);
        of_pair.groups.insert(number);
      } else {
        ++of_pair.without_group;
      }
    }
  }

  /// Finds the derived groups, which writers generate for pairs of materials.
  void find_derived() {
    std::set<std::string> names;
    for (const auto& [number, name] : listed_.names) names.insert(form(name));
    // A number without a name and a comment may come from the input: it identifies a derived group only if
    // all groups are derived.
    std::set<std::int64_t> by_number;
    std::int64_t next = 0;
    for (const auto& [pair, faces] : pairs_) {
      ++next;
      if (faces.without_group > 0) continue;
      if (const std::int64_t number = named_like(pair, faces, names))
        derived_.insert(number);
      else if (faces.groups == std::set{next} && !listed_.names.contains(next) &&
               !listed_.comments.contains(next) && is_of(next, pair))
        by_number.insert(next);
    }
    if (derived_.size() + by_number.size() == groups_.size()) derived_.merge(by_number);
  }

  bool is_of(std::int64_t number, const MaterialPair& pair) const {
    return groups_.at(number).pairs == std::set{pair};
  }

  /// Group of a pair of materials that a name or comment identifies as derived; 0 if there is none. Among
  /// several groups that have the pair's name with a suffix, the one with the largest suffix, which must
  /// exceed another group's by one.
  std::int64_t named_like(const MaterialPair& pair, const FacesOfPair& faces,
                          const std::set<std::string>& names) const {
    std::int64_t found = 0, largest = 0;
    const std::map<MaterialTag, std::string>& materials = read_.mesh.material_names;
    // If a format has not kept the tags, the name may list the materials in the order of the original tags.
    std::vector<std::string> bases = {form(pair_name(pair, materials))};
    if (pair.second) bases.push_back(form(pair_name({*pair.second, pair.first}, materials)));
    for (const std::int64_t number : faces.groups) {
      if (!is_of(number, pair)) continue;
      if (const auto comment = listed_.comments.find(number); comment != listed_.comments.end()) {
        if (comment->second == pair_name(pair)) found = number;
        continue;
      }
      const auto name = listed_.names.find(number);
      if (name == listed_.names.end()) continue;
      for (const std::string& base : bases) {
        const std::int64_t n = name_suffix(base, form(name->second));
        if (n <= largest) continue;
        if (n > 1 && !names.contains(n == 2 ? base : base + "_" + std::to_string(n - 1))) continue;
        found = number;
        largest = n;
      }
    }
    return found;
  }

  std::string name_of(std::int64_t number) const {
    const auto name = listed_.names.find(number);
    return name == listed_.names.end() ? std::to_string(number) : name->second;
  }

  [[noreturn]] void fail(std::size_t i) const {
    const Triangle& ids = listed_.triangles[i];
    std::string place;
    for (const Index vertex : ids)
      if (vertex < read_.mesh.points.size()) {
        const Vec3& p = read_.mesh.points[vertex];
        place = " at (" + std::to_string(p.x()) + ", " + std::to_string(p.y()) + ", " +
                std::to_string(p.z()) + ")";
        break;
      }
    throw InputError(file_ + ": listed triangle " + std::to_string(i + 1) + ", of the " + group_word_ + " " +
                     in_quotes(name_of(listed_.groups[i])) + place +
                     ", is not a face of any tet; the surfaces do not belong to this mesh: save both again "
                     "from one mesh, or leave the triangles out");
  }

  void set_patches() {
    std::vector<std::int64_t> numbers;
    for (const auto& [number, group] : groups_)
      if (!derived_.contains(number)) numbers.push_back(number);
    for (const auto& [number, faces] : sheets_) numbers.push_back(number);
    if (numbers.empty()) return;
    std::sort(numbers.begin(), numbers.end());
    if (numbers.size() > max_groups)
      throw InputError(file_ + ": its triangles are in " + std::to_string(numbers.size()) + " " +
                       group_word_ + "s; at most " + std::to_string(max_groups) +
                       " are possible: merge some of them");
    TetMesh& mesh = read_.mesh;
    mesh.interfaces = std::move(interfaces_);
    for (std::size_t f = 0; f < group_of_.size(); ++f) {
      const auto number = std::lower_bound(numbers.begin(), numbers.end(), group_of_[f]);
      if (number == numbers.end() || *number != group_of_[f]) continue;
      set_patch(mesh.interfaces[f], static_cast<std::size_t>(number - numbers.begin()), *number);
    }
    std::vector<InterfaceTriangle> sheets;
    for (auto& [number, faces] : sheets_) {
      const auto at = std::lower_bound(numbers.begin(), numbers.end(), number);
      for (InterfaceTriangle& t : faces) set_patch(t, static_cast<std::size_t>(at - numbers.begin()), number);
      sheets.insert(sheets.end(), faces.begin(), faces.end());
    }
    append_sheets(mesh.interfaces, std::move(sheets));
  }

  void set_patch(InterfaceTriangle& t, std::size_t index, std::int64_t number) {
    t.patch = static_cast<std::uint16_t>(index + 1);
    const auto name = listed_.names.find(number);
    read_.mesh.patch_groups[{t.pair(), t.patch}] = {number, name == listed_.names.end() ? "" : name->second};
  }

  void note() {
    const auto add = [&](const std::string& what, std::size_t count, bool is_restored) {
      if (count > 0) read_.dropped.push_back({what, count, is_restored});
    };
    const std::size_t groups = derived_.size();
    add("boundary and interface triangles" +
            (groups == 0 ? "" : " of " + std::to_string(groups) + (groups == 1 ? " group" : " groups")),
        restored_, true);
    add("triangles inside a material or not on any tet", without_group_, false);
    add("triangles of " + group_word_ + "s inside a material", inside_groups_, false);
    add("triangles that are already in a " + group_word_, repeated_, false);
  }

  const FileTriangles& listed_;
  const std::string &group_word_, &file_;
  ReadTetMesh& read_;
  std::vector<InterfaceTriangle> interfaces_;  ///< in ascending order of their sorted ids
  std::vector<std::int64_t> group_of_;         ///< group of each interface triangle; 0: none
  std::map<std::int64_t, Group> groups_;       ///< groups with faces
  std::map<MaterialPair, FacesOfPair> pairs_;
  std::set<std::int64_t> derived_;   ///< derived groups
  std::vector<std::size_t> others_;  ///< triangles of a group that are not on an interface
  /// Faces of groups that are sheets, by group.
  std::map<std::int64_t, std::vector<InterfaceTriangle>> sheets_;
  std::map<Triangle, std::int64_t> sheet_of_face_;
  std::size_t inside_groups_ = 0;  ///< triangles of groups inside a material that are no sheets
  std::size_t restored_ = 0, without_group_ = 0, repeated_ = 0;
};

}  // namespace

void take_triangles(const FileTriangles& listed, const std::string& group_word, const std::string& file,
                    ReadTetMesh& read) {
  if (!listed.triangles.empty()) TriangleTaker(listed, group_word, file, read).take();
}

std::string surface_expected(std::size_t tets) {
  return ": there are " + std::to_string(tets) +
         " tets in it; it is not a surface but a tet mesh, which 'tetwright simplify' and 'tetwright "
         "improve' read";
}

TriangleMesh surface_of(const FileTriangles& listed, std::vector<Vec3> points, const std::string& file) {
  SurfaceBuilder surface(file);
  surface.reserve(points.size(), listed.triangles.size());
  for (const Vec3& p : points) surface.add_point(p, [] { return std::string("the points"); });
  points = {};
  std::vector<SurfaceRegion> groups;
  std::map<std::int64_t, std::uint32_t> indices;
  for (std::size_t i = 0; i < listed.triangles.size(); ++i) {
    const std::int64_t number = listed.groups[i];
    const auto [known, added] = indices.emplace(number, static_cast<std::uint32_t>(groups.size()));
    if (added) {
      const auto name = listed.names.find(number);
      groups.push_back({number, name == listed.names.end() ? "" : name->second});
    }
    surface.begin_group(known->second);
    const Triangle& t = listed.triangles[i];
    surface.add_polygon(std::array<std::int64_t, 3>{t[0], t[1], t[2]},
                        [&] { return "listed triangle " + std::to_string(i + 1); });
  }
  return surface.finish(nullptr, groups, listed.names.empty() ? 2 : 1);
}

}  // namespace tetwright
