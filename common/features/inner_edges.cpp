// SPDX-License-Identifier: Apache-2.0
#include "common/features/inner_edges.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "common/parallel/parallel_sort.h"
#include "common/portable_math.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

// Items for each task of a parallel loop.
constexpr std::size_t triangle_grain = 1 << 13;  ///< some ten nanoseconds each
constexpr std::size_t use_grain = 1 << 12;       ///< some ten nanoseconds each

/// Gives each triangle without area the normal of a neighbour that has one, across the longest possible edge.
/// Otherwise patches would be connected across such triangles.
void take_normals_beside(std::span<const Vec3> points, const std::vector<EdgeUse>& uses,
                         std::vector<Vec3>& normals) {
  const auto is_flat = [&](Index t) { return normals[t].isZero(0); };
  if (std::none_of(normals.begin(), normals.end(), [](const Vec3& n) { return n.isZero(0); })) return;
  for (bool again = true; again;) {
    struct Choice {
      double length = -1;
      Vec3 normal = Vec3::Zero();
    };
    std::map<Index, Choice> choices;
    for (std::size_t i = 0; i + 1 < uses.size(); ++i) {
      if (!uses[i].same_edge(uses[i + 1])) continue;
      for (const auto& [flat, other] : {std::pair(uses[i].triangle, uses[i + 1].triangle),
                                        std::pair(uses[i + 1].triangle, uses[i].triangle)}) {
        if (!is_flat(flat) || is_flat(other)) continue;
        const std::array<Index, 2> ends = ends_of(uses[i].key);
        Choice& choice = choices[flat];
        if (const double length = (points[ends[1]] - points[ends[0]]).norm(); length > choice.length)
          choice = {length, normals[other]};
      }
    }
    again = !choices.empty();
    for (const auto& [flat, choice] : choices) normals[flat] = choice.normal;
  }
}

}  // namespace

std::vector<InnerEdge> inner_edges(std::span<const Vec3> points, std::span<const Triangle> triangles,
                                   const std::vector<EdgeUse>& uses) {
  std::vector<Vec3> normals(triangles.size());
  parallel_for(0, triangles.size(), triangle_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const Vec3& a = points[triangles[t][0]];
      const Vec3 n = (points[triangles[t][1]] - a).cross(points[triangles[t][2]] - a);
      const double length = n.norm();
      normals[t] = length > 0 ? Vec3(n / length) : Vec3(Vec3::Zero());
    }
  });
  take_normals_beside(points, uses, normals);
  const auto begins_edge = [&](std::size_t i) { return i == 0 || !uses[i].same_edge(uses[i - 1]); };
  return parallel_collect<InnerEdge>(
      0, uses.size(), use_grain, [&](std::size_t begin, std::size_t end, std::vector<InnerEdge>& edges) {
        for (std::size_t i = begin; i < end; ++i) {
          const bool two_uses = begins_edge(i) && i + 1 < uses.size() && !begins_edge(i + 1) &&
                                (i + 2 == uses.size() || begins_edge(i + 2));
          if (!two_uses || uses[i].ascending == uses[i + 1].ascending) continue;
          const std::array<Index, 2> ends = ends_of(uses[i].key);
          const Vec3 &m = normals[uses[i].triangle], &n = normals[uses[i + 1].triangle];
          const double turn =
              m.isZero(0) || n.isZero(0) ? 0 : 2 * portable_atan2_upper((m - n).norm(), (m + n).norm());
          edges.push_back({ends,
                           {uses[i].triangle, uses[i + 1].triangle},
                           (points[ends[1]] - points[ends[0]]).norm(),
                           turn});
        }
      });
}

}  // namespace tetwright
