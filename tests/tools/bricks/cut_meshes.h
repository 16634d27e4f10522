// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "tests/simplify/meshes.h"
#include "tools/bricks/brick_part.h"

/// Meshes that are cut into parts, for comparison with what the parts together give.
namespace tetwright::cut_meshes {

using Corner = std::array<double, 3>;
using Tag = std::optional<MaterialTag>;

inline Corner corner(const Vec3& p) { return {p[0], p[1], p[2]}; }

inline Triangle ascending_ids(Triangle ids) {
  std::sort(ids.begin(), ids.end());
  return ids;
}

inline constexpr int cells = 6;

/// A mesh of three materials with a cavity, whose faces on two sides of its box are patches.
inline TetMesh whole_mesh() {
  TetMesh mesh = grid_mesh({cells, cells, cells}, [](int x, int y, int z) -> Tag {
    if (x == 4 && y == 4 && z == 4) return {};
    return z < 2 ? -9 : x + y < cells ? 3 : 8;
  });
  std::vector<std::array<bool, 2>> on_side;
  for (const Vec3& p : mesh.points) on_side.push_back({p.x() == 0, p.z() == 0});
  jitter(mesh, 8, 0.3);
  mesh.interfaces = find_interfaces(mesh);
  for (InterfaceTriangle& t : mesh.interfaces)
    for (std::size_t side = 0; side < 2; ++side)
      if (std::all_of(t.ids.begin(), t.ids.end(), [&](Index p) { return on_side[p][side]; }))
        t.patch = static_cast<std::uint16_t>(side + 1);
  mesh.material_names = {{-9, "base"}, {8, "right"}};
  return mesh;
}

/// Cuts a mesh into parts as make_brick_part() does, but coarsens none.
/// \param part_of the part of a tet, by its number and its centroid
inline std::vector<BrickPart> cut(const TetMesh& whole, std::size_t parts,
                                  const std::function<std::size_t(std::size_t, const Vec3&)>& part_of) {
  std::vector<std::size_t> part(whole.tets.size());
  std::vector<std::set<std::size_t>> parts_of_point(whole.points.size());
  for (std::size_t t = 0; t < whole.tets.size(); ++t) {
    Vec3 centre = Vec3::Zero();
    for (const Index p : whole.tets[t]) centre += whole.points[p] / 4;
    part[t] = part_of(t, centre);
    for (const Index p : whole.tets[t]) parts_of_point[p].insert(part[t]);
  }
  std::map<Triangle, std::uint16_t> patches;
  for (const InterfaceTriangle& t : whole.interfaces)
    if (t.patch > 0) patches[ascending_ids(t.ids)] = t.patch;

  std::vector<BrickPart> cut(parts);
  for (std::size_t b = 0; b < parts; ++b) {
    TetMesh& mesh = cut[b].mesh;
    std::vector<Index> number(whole.points.size(), no_index), global;
    std::vector<std::uint8_t> shared;
    for (std::size_t t = 0; t < whole.tets.size(); ++t) {
      if (part[t] != b) continue;
      Tet tet = whole.tets[t];
      for (Index& p : tet) {
        if (number[p] == no_index) {
          number[p] = static_cast<Index>(global.size());
          global.push_back(p);
          mesh.points.push_back(whole.points[p]);
          shared.push_back(parts_of_point[p].size() > 1);
        }
        p = number[p];
      }
      mesh.tets.push_back(tet);
      mesh.materials.push_back(whole.materials[t]);
    }
    cut[b].dense = mesh_statistics(mesh);
    cut[b].dense.points -= static_cast<std::size_t>(std::count(shared.begin(), shared.end(), 1));

    cut[b].flags.assign(shared.begin(), shared.end());
    cut[b].surface.points = mesh.points;
    cut[b].surface_shared = shared;
    for (InterfaceTriangle t : find_interfaces(mesh)) {
      const auto patch = patches.find(ascending_ids({global[t.ids[0]], global[t.ids[1]], global[t.ids[2]]}));
      if (patch != patches.end()) t.patch = patch->second;
      for (const Index p : t.ids) cut[b].flags[p] |= BrickPart::on_interface;
      const bool cut_off = !t.other && t.patch == 0 &&
                           std::all_of(t.ids.begin(), t.ids.end(), [&](Index p) { return shared[p] != 0; });
      (cut_off ? cut[b].cut_faces : cut[b].surface.interfaces).push_back(t);
      if (t.patch > 0) mesh.interfaces.push_back(t);
    }
  }
  return cut;
}

using PlainTet = std::pair<MaterialTag, std::array<Corner, 4>>;
inline std::vector<PlainTet> plain_tets(const TetMesh& mesh) {
  std::vector<PlainTet> tets;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    PlainTet& tet = tets.emplace_back();
    tet.first = mesh.materials[t];
    for (std::size_t k = 0; k < 4; ++k) tet.second[k] = corner(mesh.points[mesh.tets[t][k]]);
    std::sort(tet.second.begin(), tet.second.end());
  }
  std::sort(tets.begin(), tets.end());
  return tets;
}

/// Faces by their coordinates, each beginning at the smallest one, with their orientation.
using PlainFace = std::tuple<std::array<Corner, 3>, MaterialTag, Tag, std::uint16_t>;
inline std::vector<PlainFace> plain_faces(const TetMesh& mesh) {
  std::vector<PlainFace> faces;
  for (const InterfaceTriangle& t : mesh.interfaces) {
    std::array<Corner, 3> face;
    for (std::size_t k = 0; k < 3; ++k) face[k] = corner(mesh.points[t.ids[k]]);
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    faces.emplace_back(face, t.material, t.other, t.patch);
  }
  std::sort(faces.begin(), faces.end());
  return faces;
}

}  // namespace tetwright::cut_meshes
