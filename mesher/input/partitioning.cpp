// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/partitioning.h"

#include <algorithm>
#include <map>

#include "common/features/edge_uses.h"

namespace tetwright {

namespace {

/// The border of a surface: for each point on it the sum of the directions, in the planes of the triangles
/// there, that lead away from it.
struct Border {
  struct Edge {
    Index from, to;  ///< as the triangle traverses it
  };
  std::vector<Edge> edges;
  std::map<Index, std::vector<Vec3>> outwards;
};

Border border_of(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles) {
  Border border;
  const std::vector<EdgeUse> uses = edge_uses(triangles, {});
  for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
    while (j < uses.size() && uses[j].key == uses[i].key) ++j;
    if (j - i != 1) continue;
    auto [from, to] = ends_of(uses[i].key);
    if (!uses[i].ascending) std::swap(from, to);
    const Triangle& t = triangles[uses[i].triangle];
    const Vec3 normal = (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]);
    const Vec3 out = (points[to] - points[from]).cross(normal).normalized();
    if (!out.allFinite()) continue;
    border.edges.push_back({from, to});
    border.outwards[from].push_back(out);
    border.outwards[to].push_back(out);
  }
  return border;
}

/// Continues a surface by a strip along its border. At corners the strip has the full width along both sides.
void continue_border(double width, Partition& p) {
  const Border border = border_of(p.points, p.triangles);
  std::map<Index, Index> beyond;
  for (const auto& [point, outwards] : border.outwards) {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& out : outwards) sum += out;
    const Vec3 middle = sum.normalized();
    if (!middle.allFinite()) continue;
    // A spike would become arbitrarily long.
    constexpr double min_cosine = 0.5;
    double cosine = 1;
    for (const Vec3& out : outwards) cosine = std::min(cosine, out.dot(middle));
    beyond[point] = static_cast<Index>(p.points.size());
    p.points.push_back(p.points[point] + width / std::max(cosine, min_cosine) * middle);
  }
  for (const auto& [from, to] : border.edges) {
    const auto a = beyond.find(from), b = beyond.find(to);
    if (a == beyond.end() || b == beyond.end()) continue;
    p.triangles.push_back({to, from, a->second});
    p.triangles.push_back({to, a->second, b->second});
  }
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
