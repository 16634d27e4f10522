// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/partitioning.h"

#include <algorithm>
#include <map>

#include "common/features/edge_uses.h"
#include "common/geometry/self_intersection.h"
#include "common/message_text.h"
#include "mesher/tuning/input_tuning.h"
#include "tetwright/error.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

/// An edge of one triangle only, as that triangle traverses it.
struct BorderEdge {
  Index from, to;
  Vec3 out;  ///< unit, in the plane of the triangle
};

std::vector<BorderEdge> border_of(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles) {
  std::vector<BorderEdge> border;
  const std::vector<EdgeUse> uses = edge_uses(triangles, {});
  for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
    while (j < uses.size() && uses[j].key == uses[i].key) ++j;
    if (j - i != 1) continue;
    auto [from, to] = ends_of(uses[i].key);
    if (!uses[i].ascending) std::swap(from, to);
    const Triangle& t = triangles[uses[i].triangle];
    const Vec3 normal = (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]);
    const Vec3 out = (points[to] - points[from]).cross(normal).normalized();
    if (out.allFinite()) border.push_back({from, to, out});
  }
  return border;
}

/// The directions away from a border, smoothed over a width: small waves of the border would become folds.
/// Sides of a corner keep their own.
std::vector<Vec3> smooth_directions(const std::vector<Vec3>& points, const std::vector<BorderEdge>& border,
                                    double width) {
  std::vector<Vec3> smooth(border.size());
  const auto middle = [&](const BorderEdge& e) { return Vec3((points[e.from] + points[e.to]) / 2); };
  parallel_for(0, border.size(), InputGrains::border_edges, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Vec3 sum = Vec3::Zero();
      for (const BorderEdge& e : border)
        if (e.out.dot(border[i].out) > InputTuning::Partitions::same_side &&
            (middle(e) - middle(border[i])).norm() <= width)
          sum += (points[e.to] - points[e.from]).norm() * e.out;
      smooth[i] = sum.normalized();
    }
  });
  return smooth;
}

/// Continues a surface by a strip along its border. At corners the strip has the full width along both sides.
/// \throws InputError if the strip meets itself or the surface
void continue_border(double width, Partition& p) {
  const std::vector<BorderEdge> border = border_of(p.points, p.triangles);
  if (border.size() > InputTuning::Partitions::max_border)
    throw InputError(p.file, 0,
                     "the partition '" + p.name + "' has a border of " + std::to_string(border.size()) +
                         " edges, and --extend continues at most " +
                         std::to_string(InputTuning::Partitions::max_border) +
                         "; leave out --extend and continue the surface to the boundary yourself");
  const std::vector<Vec3> directions = smooth_directions(p.points, border, width);
  std::map<Index, std::vector<Vec3>> outwards;
  for (std::size_t i = 0; i < border.size(); ++i) {
    outwards[border[i].from].push_back(directions[i]);
    outwards[border[i].to].push_back(directions[i]);
  }
  std::map<Index, Index> beyond;
  for (const auto& [point, outs] : outwards) {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& out : outs) sum += out;
    const Vec3 middle = sum.normalized();
    if (!middle.allFinite()) continue;
    double cosine = 1;
    for (const Vec3& out : outs) cosine = std::min(cosine, out.dot(middle));
    beyond[point] = static_cast<Index>(p.points.size());
    p.points.push_back(p.points[point] +
                       width / std::max(cosine, InputTuning::Partitions::min_cosine) * middle);
  }
  for (const auto& [from, to, out] : border) {
    const auto a = beyond.find(from), b = beyond.find(to);
    if (a == beyond.end() || b == beyond.end()) continue;
    p.triangles.push_back({to, from, a->second});
    p.triangles.push_back({to, a->second, b->second});
  }
  const auto folds = self_intersections(p.points, p.triangles);
  const auto of_strip = std::find_if(folds.begin(), folds.end(), [&](const auto& pair) {
    return pair.second >= p.triangles.size() - 2 * border.size();
  });
  if (of_strip == folds.end()) return;
  const Triangle& t = p.triangles[of_strip->second];
  throw InputError(p.file, 0,
                   "continued by --extend " + short_number(width) + ", the partition '" + p.name +
                       "' would cross itself at " +
                       place_text((p.points[t[0]] + p.points[t[1]] + p.points[t[2]]) / 3) +
                       "; use a smaller --extend, or continue the surface to the boundary yourself");
}

}  // namespace

Partition make_partition(const SheetSurface& surface, double extend, std::vector<Diagnostic>& findings) {
  std::vector<Diagnostic> own;
  CleanedSurface cleaned = clean_surface(surface.surface, surface.file, own);
  for (Diagnostic& f : own) {
    f.file = surface.file;
    findings.push_back(std::move(f));
  }
  Partition p{surface.name, surface.file, std::move(cleaned.points), std::move(cleaned.triangles), {}};
  const std::size_t given = p.triangles.size();
  if (extend > 0) continue_border(extend, p);
  p.continued.assign(p.triangles.size(), 1);
  std::fill_n(p.continued.begin(), given, 0);
  p.low = p.high = p.points[0];
  for (const Vec3& q : p.points) p.low = p.low.cwiseMin(q), p.high = p.high.cwiseMax(q);
  return p;
}

PartitionedSurface with_partitions(const CleanedSurface& body, const std::vector<SurfaceRegion>& groups,
                                   const std::vector<Partition>& partitions) {
  PartitionedSurface result;
  CleanedSurface& all = result.surface;
  all = body;
  result.groups = groups;
  result.body_triangles = body.triangles.size();
  Vec3 low = body.points[0], high = body.points[0];
  for (const Vec3& q : body.points) low = low.cwiseMin(q), high = high.cwiseMax(q);
  if (all.groups.empty()) {
    all.groups.assign(all.triangles.size(), 0);
    result.groups = {SurfaceRegion{}};
  }
  for (std::uint32_t k = 0; k < partitions.size(); ++k) {
    const Partition& p = partitions[k];
    if ((p.low.array() > high.array()).any() || (p.high.array() < low.array()).any()) continue;
    const auto first = static_cast<Index>(all.points.size());
    const auto group = static_cast<std::uint32_t>(result.groups.size());
    result.groups.push_back({0, p.name});
    all.points.insert(all.points.end(), p.points.begin(), p.points.end());
    for (std::size_t t = 0; t < p.triangles.size(); ++t) {
      const auto& [a, b, c] = p.triangles[t];
      all.triangles.push_back({first + a, first + b, first + c});
      all.groups.push_back(group);
      result.partition.push_back(k);
      result.continued.push_back(p.continued[t]);
    }
  }
  all.two_sided.resize(all.triangles.size(), 0);
  all.even.resize(all.triangles.size(), 0);
  return result;
}

}  // namespace tetwright
