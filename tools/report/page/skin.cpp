// SPDX-License-Identifier: Apache-2.0
#include "tools/report/page/skin.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "common/geometry/box_tree.h"

namespace tetwright {

namespace {

/// For each point of the interfaces the first point of its cell in a grid of `cells` along the longest side.
std::unordered_map<Index, Index> join_points(const TetMesh& mesh, const Box3& box, double cells) {
  const double scale = cells / (box.high - box.low).maxCoeff();
  std::unordered_map<std::uint64_t, Index> first;
  std::unordered_map<Index, Index> joined;
  const auto cell_of = [&](Index p) {
    constexpr int bits = 21;  // of each coordinate: 63 in all
    std::uint64_t cell = 0;
    for (int axis = 0; axis < 3; ++axis)
      cell = cell << bits | static_cast<std::uint64_t>((mesh.points[p][axis] - box.low[axis]) * scale);
    return cell;
  };
  for (const InterfaceTriangle& t : mesh.interfaces)
    for (const Index p : t.ids) {
      const auto [at, is_new] = first.try_emplace(cell_of(p), p);
      at->second = std::min(at->second, p);
      joined[p] = 0;
    }
  for (auto& [point, to] : joined) to = first.at(cell_of(point));
  return joined;
}

/// The triangles that still have three corners.
std::vector<InterfaceTriangle> coarsened(const TetMesh& mesh, const Box3& box, double cells) {
  const auto joined = join_points(mesh, box, cells);
  std::vector<InterfaceTriangle> out;
  for (InterfaceTriangle t : mesh.interfaces) {
    for (Index& p : t.ids) p = joined.at(p);
    if (t.ids[0] != t.ids[1] && t.ids[1] != t.ids[2] && t.ids[2] != t.ids[0]) out.push_back(t);
  }
  return out;
}

}  // namespace

std::vector<InterfaceTriangle> skin_within(const TetMesh& mesh, std::size_t max_triangles) {
  if (mesh.interfaces.size() <= max_triangles) return mesh.interfaces;
  Box3 box;
  for (const Vec3& p : mesh.points) box.add(p);
  const double side = (box.high - box.low).maxCoeff();
  if (!(side > 0) || !std::isfinite(side)) return {};
  // Finer than this a cell is smaller than a pixel of the page.
  constexpr double finest = 1024, coarser = 0.7;
  for (double cells = finest; cells > 1; cells *= coarser)
    if (auto out = coarsened(mesh, box, cells); out.size() <= max_triangles) return out;
  return {};
}

}  // namespace tetwright
