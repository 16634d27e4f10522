// SPDX-License-Identifier: Apache-2.0
#include "mesher/features/sliver_patches.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "common/features/edge_uses.h"
#include "common/mesh/disjoint_sets.h"

namespace tetwright {

namespace {

/// An edge between two triangles of one sheet.
struct SheetEdge {
  std::array<Index, 2> ends, triangles;
};

std::vector<SheetEdge> edges_of_sheets(std::span<const Triangle> triangles,
                                       std::span<const std::size_t> sheet_of_patch,
                                       std::span<const std::uint16_t> patches) {
  std::vector<std::uint32_t> sheets;
  sheets.reserve(triangles.size());
  for (const std::uint16_t patch : patches)
    sheets.push_back(static_cast<std::uint32_t>(sheet_of_patch[patch]));
  const std::vector<EdgeUse> uses = edge_uses(triangles, sheets);
  std::vector<SheetEdge> edges;
  for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
    while (j < uses.size() && uses[j].same_edge(uses[i])) ++j;
    if (j - i == 2) edges.push_back({ends_of(uses[i].key), {uses[i].triangle, uses[i + 1].triangle}});
  }
  return edges;
}

}  // namespace

void merge_slivers(std::span<const Vec3> points, std::span<const Triangle> triangles,
                   std::span<const std::size_t> sheet_of_patch, double min_area,
                   std::span<std::uint16_t> patches) {
  const std::vector<SheetEdge> edges = edges_of_sheets(triangles, sheet_of_patch, patches);
  DisjointSets parts(triangles.size());
  for (const SheetEdge& e : edges)
    if (patches[e.triangles[0]] == patches[e.triangles[1]]) parts.unite(e.triangles[0], e.triangles[1]);
  std::vector<double> areas(triangles.size(), 0);
  for (Index t = 0; t < triangles.size(); ++t) {
    const auto& [a, b, c] = triangles[t];
    areas[parts.root(t)] += (points[b] - points[a]).cross(points[c] - points[a]).norm() / 2;
  }
  std::vector<std::pair<double, Index>> slivers;
  std::vector<char> is_sliver(triangles.size(), 0);
  for (Index t = 0; t < triangles.size(); ++t)
    if (parts.is_root(t) && areas[t] < min_area) slivers.emplace_back(areas[t], t), is_sliver[t] = 1;
  if (slivers.empty()) return;
  std::sort(slivers.begin(), slivers.end());

  std::map<Index, std::map<Index, double>> borders;  // length by neighbour, of each sliver
  for (const SheetEdge& e : edges) {
    const Index a = parts.root(e.triangles[0]), b = parts.root(e.triangles[1]);
    if (a == b) continue;
    const double length = (points[e.ends[1]] - points[e.ends[0]]).norm();
    if (is_sliver[a]) borders[a][b] += length;
    if (is_sliver[b]) borders[b][a] += length;
  }
  // A sliver that others have joined still decides by its own borders.
  std::vector<Index> joins(triangles.size(), no_index);
  const auto joined = [&](Index part) {
    while (joins[part] != no_index) {
      if (const Index next = joins[joins[part]]; next != no_index) joins[part] = next;
      part = joins[part];
    }
    return part;
  };
  for (const auto& [area, sliver] : slivers) {
    std::map<Index, double> lengths;
    for (const auto& [other, length] : borders[sliver])
      if (const Index now = joined(other); now != sliver) lengths[now] += length;
    const auto longest = std::max_element(lengths.begin(), lengths.end(),
                                          [](const auto& x, const auto& y) { return x.second < y.second; });
    if (longest == lengths.end()) continue;
    joins[sliver] = longest->first;
  }
  std::vector<std::uint16_t> of_parts(triangles.size());
  for (Index t = 0; t < triangles.size(); ++t) of_parts[t] = patches[joined(parts.root(t))];
  std::copy(of_parts.begin(), of_parts.end(), patches.begin());
}

}  // namespace tetwright
