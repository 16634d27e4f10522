// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/connected_patches.h"

#include <algorithm>

#include "common/features/edge_uses.h"
#include "common/mesh/disjoint_sets.h"
#include "mesher/tuning/input_tuning.h"

namespace tetwright {

namespace {

double triangle_area(std::span<const Vec3> points, const Triangle& t) {
  return (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]).norm() / 2;
}

/// Calls `body` with the uses of each edge.
template <class Body>
void for_each_edge(std::span<const EdgeUse> uses, Body&& body) {
  for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
    while (j < uses.size() && uses[j].key == uses[i].key) ++j;
    body(uses.subspan(i, j - i));
  }
}

/// Marks patches with a free edge, and repeats this without those that have one.
void mark_open(std::span<const EdgeUse> uses, ConnectedPatches& patches) {
  std::vector<std::vector<Index>> patches_at;               // of each edge of other than two triangles
  std::vector<std::vector<Index>> edges_of(patches.count);  // with repetitions
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    if (edge.size() == 2) return;
    for (const EdgeUse& use : edge)
      edges_of[patches.of[use.triangle]].push_back(static_cast<Index>(patches_at.size()));
    patches_at.emplace_back();
    for (const EdgeUse& use : edge) patches_at.back().push_back(patches.of[use.triangle]);
  });
  std::vector<std::size_t> left(patches_at.size());
  std::vector<Index> queue;
  for (Index e = 0; e < patches_at.size(); ++e) {
    left[e] = patches_at[e].size();
    if (left[e] == 1) queue.push_back(e);
  }
  for (std::size_t i = 0; i < queue.size(); ++i)
    for (const Index p : patches_at[queue[i]]) {
      if (patches.open[p]) continue;
      patches.open[p] = 1;
      for (const Index e : edges_of[p])
        if (--left[e] == 1) queue.push_back(e);
    }
}

}  // namespace

bool ConnectedPatches::any_open() const {
  return std::any_of(open.begin(), open.end(), [](char o) { return o != 0; });
}

bool ConnectedPatches::open_within_closed(std::span<const Vec3> points,
                                          std::span<const Triangle> triangles) const {
  Eigen::AlignedBox3d box;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (!open[of[t]])
      for (const Index p : triangles[t]) box.extend(points[p]);
  if (box.isEmpty()) return false;
  std::vector<double> within(count, 0);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (!open[of[t]]) continue;
    Eigen::AlignedBox3d own;
    for (const Index p : triangles[t]) own.extend(points[p]);
    if (box.intersects(own)) within[of[t]] += triangle_area(points, triangles[t]);
  }
  for (Index p = 0; p < count; ++p)
    if (open[p] && within[p] < InputTuning::Walls::inside_share * area[p]) return false;
  return true;
}

ConnectedPatches find_connected_patches(std::span<const Vec3> points, std::span<const Triangle> triangles) {
  ConnectedPatches patches;
  DisjointSets sets(triangles.size());
  const std::vector<EdgeUse> uses = edge_uses(triangles, {});
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    if (edge.size() == 2) sets.unite(edge[0].triangle, edge[1].triangle);
  });
  std::vector<Index> number(triangles.size(), no_index);
  for (Index t = 0; t < triangles.size(); ++t) {
    Index& own = number[sets.root(t)];
    if (own == no_index) {
      own = patches.count++;
      patches.area.push_back(0);
    }
    patches.of.push_back(own);
    patches.area[own] += triangle_area(points, triangles[t]);
  }
  patches.open.assign(patches.count, 0);
  mark_open(uses, patches);
  return patches;
}

}  // namespace tetwright
