// SPDX-License-Identifier: Apache-2.0
#include "tetwright/compare.h"

#include <map>

namespace tetwright {

namespace {

struct GroupFaces {
  std::size_t triangles = 0;
  double area = 0, largest = -1;
  Vec3 place = Vec3::Zero();  ///< centre of the largest triangle

  void add(const std::vector<Vec3>& points, const Triangle& t) {
    const Vec3 &a = points[t[0]], &b = points[t[1]], &c = points[t[2]];
    const double own = (b - a).cross(c - a).norm() / 2;
    ++triangles;
    area += own;
    if (own <= largest) return;
    largest = own;
    place = (a + b + c) / 3;
  }
};

using FacesByGroup = std::map<SurfaceRegion, GroupFaces>;

FacesByGroup faces_by_group(const TetMesh& mesh) {
  FacesByGroup faces;
  if (mesh.patch_groups.empty()) return faces;
  for (const InterfaceTriangle& t : mesh.interfaces)
    if (const auto group = mesh.patch_groups.find({t.pair(), t.patch}); group != mesh.patch_groups.end())
      faces[group->second].add(mesh.points, t.ids);
  return faces;
}

}  // namespace

std::string patch_name(const SurfaceRegion& group) {
  return group.name.empty() ? std::to_string(group.number) : group.name;
}

std::vector<PatchComparison> patches_of_input(const MesherInput& input) {
  std::vector<PatchComparison> patches;
  patches.reserve(input.groups.size());
  for (const MesherInput::Group& g : input.groups) patches.push_back({g.group, g.area, 0, 0, g.place});
  return patches;
}

std::vector<PatchComparison> patches_of_input(const TetMesh& mesh) {
  std::vector<PatchComparison> patches;
  for (const auto& [group, f] : faces_by_group(mesh)) patches.push_back({group, f.area, 0, 0, f.place});
  return patches;
}

void compare_patches(const TetMesh& result, std::vector<PatchComparison>& patches) {
  const FacesByGroup faces = faces_by_group(result);
  for (PatchComparison& p : patches) {
    const auto found = faces.find(p.group);
    if (found == faces.end()) continue;
    p.triangles = found->second.triangles;
    p.area = found->second.area;
  }
}

}  // namespace tetwright
