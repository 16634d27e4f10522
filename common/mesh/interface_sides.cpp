// SPDX-License-Identifier: Apache-2.0
#include "common/mesh/interface_sides.h"

#include <map>
#include <optional>
#include <set>

#include "tetwright/parted_interfaces.h"

namespace tetwright {

namespace {

std::array<double, 3> coordinates_of_point(const Vec3& p) { return {p[0], p[1], p[2]}; }

/// A group of boundary faces in one material.
struct GroupOfFaces {
  MaterialTag material;
  std::vector<std::size_t> faces;  ///< indices into TetMesh::interfaces
};

/// Groups of boundary faces with a colon in their names, which sides have.
std::map<std::string, GroupOfFaces> groups_with_colons(const TetMesh& mesh) {
  std::map<std::string, GroupOfFaces> groups;
  std::set<std::string> of_several_materials;
  for (std::size_t i = 0; i < mesh.interfaces.size(); ++i) {
    const InterfaceTriangle& face = mesh.interfaces[i];
    if (face.other) continue;
    const std::string& name = region_of(mesh, face).name;
    if (name.find(':') == std::string::npos) continue;
    GroupOfFaces& group = groups.try_emplace(name, GroupOfFaces{face.material, {}}).first->second;
    group.faces.push_back(i);
    if (group.material != face.material) of_several_materials.insert(name);
  }
  for (const std::string& name : of_several_materials) groups.erase(name);
  return groups;
}

class SideFinder {
 public:
  explicit SideFinder(const TetMesh& mesh) : mesh_(mesh), groups_(groups_with_colons(mesh)) {}

  FoundSides find() {
    for (const auto& [name, group] : groups_) find_sheet(name);
    collect_candidates();
    for (const auto& [name, of_name] : candidates_)
      if (of_name.size() == 2) {
        const GroupOfFaces &a = groups_.at(of_name[0].group), &b = groups_.at(of_name[1].group);
        if (a.material == b.material) continue;
        const bool by_materials = name == of_name[0].suffix + "|" + of_name[1].suffix ||
                                  name == of_name[1].suffix + "|" + of_name[0].suffix;
        add(name, by_materials, of_name[0].group, of_name[1].group);
      }
    std::sort(found_.sides.begin(), found_.sides.end(),
              [](const InterfaceSides& a, const InterfaceSides& b) { return a.name < b.name; });
    return std::move(found_);
  }

 private:
  struct Candidate {
    std::string group, suffix;
  };

  /// Adds a sheet if the group is its back, and there is a front.
  void find_sheet(const std::string& back) {
    const std::string suffix = std::string(":") + sheet_sides[0];
    if (back.size() <= suffix.size() || !back.ends_with(suffix)) return;
    const std::string name = back.substr(0, back.size() - suffix.size());
    const std::string front = name + ":" + sheet_sides[1];
    const auto other = groups_.find(front);
    if (other != groups_.end() && other->second.material == groups_.at(back).material)
      add(name, false, back, front);
  }

  /// Collects the groups whose last part is the name of their material, or of one of those before it.
  void collect_candidates() {
    for (const auto& [name, group] : groups_) {
      if (taken_.contains(name)) continue;
      const std::string material = unique_material_name(mesh_.material_names, group.material);
      for (std::size_t colon = name.find(':'); colon != std::string::npos;
           colon = name.find(':', colon + 1)) {
        const std::string before = name.substr(0, colon), suffix = name.substr(colon + 1);
        if (before.empty() || suffix.empty()) continue;
        if (suffix == material || before.starts_with(suffix + "|") || before.ends_with("|" + suffix)) {
          candidates_[before].push_back({name, suffix});
          break;
        }
      }
    }
  }

  /// Adds two groups if their faces coincide.
  void add(const std::string& name, bool by_materials, const std::string& first, const std::string& second) {
    const std::vector<std::size_t>&a = groups_.at(first).faces, &b = groups_.at(second).faces;
    std::map<FaceCoordinates, std::size_t> by_place;
    for (const std::size_t f : a) by_place.emplace(coordinates_of(mesh_, mesh_.interfaces[f].ids), f);
    InterfaceSides sides{name, by_materials, {}};
    for (const std::size_t f : b) {
      const auto same = by_place.find(coordinates_of(mesh_, mesh_.interfaces[f].ids));
      if (same == by_place.end()) continue;
      sides.faces.emplace_back(same->second, f);
      by_place.erase(same);
    }
    const std::size_t alone = a.size() + b.size() - 2 * sides.faces.size();
    if (alone > 0) {
      found_.apart.push_back({name, alone});
      return;
    }
    taken_.insert(first);
    taken_.insert(second);
    found_.sides.push_back(std::move(sides));
  }

  const TetMesh& mesh_;
  std::map<std::string, GroupOfFaces> groups_;
  std::map<std::string, std::vector<Candidate>> candidates_;  ///< by the name of their interface
  std::set<std::string> taken_;                               ///< groups that are the sides of sheets
  FoundSides found_;
};

}  // namespace

Triangle by_coordinates(const TetMesh& mesh, Triangle ids) {
  std::sort(ids.begin(), ids.end(), [&](Index a, Index b) {
    return coordinates_of_point(mesh.points[a]) < coordinates_of_point(mesh.points[b]);
  });
  return ids;
}

FaceCoordinates coordinates_of(const TetMesh& mesh, const Triangle& ids) {
  const Triangle ordered = by_coordinates(mesh, ids);
  return {coordinates_of_point(mesh.points[ordered[0]]), coordinates_of_point(mesh.points[ordered[1]]),
          coordinates_of_point(mesh.points[ordered[2]])};
}

FoundSides find_interface_sides(const TetMesh& mesh) { return SideFinder(mesh).find(); }

std::vector<std::size_t> parted_faces(const TetMesh& mesh) {
  std::vector<std::size_t> faces;
  for (const InterfaceSides& sides : find_interface_sides(mesh).sides)
    for (const auto& [first, second] : sides.faces) faces.insert(faces.end(), {first, second});
  std::sort(faces.begin(), faces.end());
  return faces;
}

bool is_cohesive(const Wedge& wedge, std::span<const Vec3> points) {
  bool apart = false;
  for (std::size_t k = 0; k < 3; ++k) {
    if (points[wedge[k]] != points[wedge[k + 3]]) return false;
    apart |= wedge[k] != wedge[k + 3];
  }
  return apart;
}

std::map<std::string, std::vector<std::size_t>> wedges_by_interface(const TetMesh& mesh) {
  std::map<std::string, std::vector<std::size_t>> result;
  if (mesh.wedges.empty()) return result;
  std::map<Triangle, const std::string*> names;
  const FoundSides found = find_interface_sides(mesh);
  for (const InterfaceSides& sides : found.sides)
    for (const auto& [first, second] : sides.faces)
      for (const std::size_t face : {first, second})
        names[ascending_ids(mesh.interfaces[face].ids)] = &sides.name;
  for (std::size_t w = 0; w < mesh.wedges.size(); ++w) {
    const Wedge& wedge = mesh.wedges[w];
    const auto side = names.find(ascending_ids({wedge[0], wedge[1], wedge[2]}));
    result[side == names.end() ? "cohesive" : *side->second].push_back(w);
  }
  return result;
}

}  // namespace tetwright
