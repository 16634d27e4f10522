// SPDX-License-Identifier: Apache-2.0
#include "common/features/surface_noise.h"

#include <algorithm>
#include <map>

#include "common/features/edge_uses.h"
#include "common/mesh/disjoint_sets.h"

namespace tetwright {

namespace {

// Tuned on 13 scans, two of them also cut by planes, and 17 parts. Loose ends for each sharp edge of a part:
constexpr double max_loose = 0.14;                ///< the noisiest part of a CAD model: 0.11; scans: 0.32 up
constexpr double max_loose_beside_noise = 0.025;  ///< flat cuts: up to 0.02; wings of a scanned model: 0.04
constexpr double min_loose_ends = 2;              ///< fewer are no noise
constexpr double min_noisy_border = 0.25;         ///< fraction of its border at which a part is beside noise
/// Parts beside noise belong to it unless they have this fraction of the area (largest otherwise: 0.4 %) or
/// are flat.
constexpr double min_large_share = 0.005;
constexpr std::size_t min_flat_triangles = 16;
constexpr double min_flat_cosine = 0.99985;  ///< 1 degree between the normal of each triangle and the mean
/// Triangles smaller than this fraction of a part's largest do not bend it.
constexpr double min_area_of_largest = 1e-6;

/// Edges that turn by more than an angle, and their loose ends.
struct SharpEdges {
  double edges = 0, loose = 0;
  double ratio() const { return edges == 0 ? 0 : loose / edges; }
};

/// Calls add(edge, its number of loose ends) for each edge that turns by more than the angle.
template <class Add>
void for_each_sharp_edge(const std::vector<InnerEdge>& edges, const std::vector<std::uint8_t>& on_border,
                         double angle, const Add& add) {
  std::vector<std::uint32_t> degrees(on_border.size(), 0);
  for (const InnerEdge& e : edges)
    if (e.turn > angle)
      for (const Index p : e.ends) ++degrees[p];
  for (const InnerEdge& e : edges) {
    if (e.turn <= angle) continue;
    int loose = 0;
    for (const Index p : e.ends) loose += degrees[p] == 1 && !on_border[p];
    add(e, loose);
  }
}

/// The sharp edges of each part. Those between two parts count by half for either.
std::vector<SharpEdges> edges_of_parts(const std::vector<InnerEdge>& edges,
                                       const std::vector<std::uint8_t>& on_border,
                                       std::span<const Index> part, std::size_t part_count, double angle) {
  std::vector<SharpEdges> found(part_count);
  for_each_sharp_edge(edges, on_border, angle, [&](const InnerEdge& e, int loose) {
    for (const Index t : e.triangles) {
      found[part[t]].edges += 0.5;
      found[part[t]].loose += 0.5 * loose;
    }
  });
  return found;
}

/// Flags the parts that are large or flat and have hardly a loose end.
std::vector<std::uint8_t> parts_that_count(std::span<const Vec3> points, std::span<const Triangle> triangles,
                                           std::span<const Index> part,
                                           const std::vector<SharpEdges>& sharp) {
  const std::size_t part_count = sharp.size();
  struct Shape {
    Vec3 normal = Vec3::Zero();  // of twice the area
    double area = 0, largest = 0;
    std::size_t triangles = 0;
    bool flat = true;
  };
  std::vector<Shape> shapes(part_count);
  const auto normal_of = [&](const Triangle& t) -> Vec3 {
    return (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]);
  };
  double total_area = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Vec3 n = normal_of(triangles[t]);
    Shape& s = shapes[part[t]];
    s.normal += n;
    s.area += n.norm();
    s.largest = std::max(s.largest, n.norm());
    ++s.triangles;
    total_area += n.norm();
  }
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    Shape& s = shapes[part[t]];
    const Vec3 n = normal_of(triangles[t]);
    if (n.norm() > min_area_of_largest * s.largest &&
        n.dot(s.normal) < min_flat_cosine * n.norm() * s.normal.norm())
      s.flat = false;
  }
  std::vector<std::uint8_t> counts(part_count);
  for (std::size_t p = 0; p < part_count; ++p)
    counts[p] = sharp[p].ratio() <= max_loose_beside_noise &&
                (shapes[p].area >= min_large_share * total_area ||
                 (shapes[p].flat && shapes[p].triangles >= min_flat_triangles));
  return counts;
}

}  // namespace

std::vector<std::uint8_t> points_on_borders(const std::vector<EdgeUse>& uses, std::size_t point_count) {
  std::vector<std::uint8_t> on_border(point_count, 0);
  for (std::size_t i = 0, next = 0; i < uses.size(); i = next) {
    while (next < uses.size() && uses[next].key == uses[i].key) ++next;
    if (next - i == 2 && uses[i].group == uses[i + 1].group) continue;
    for (const Index p : ends_of(uses[i].key)) on_border[p] = 1;
  }
  return on_border;
}

double loose_ends(const std::vector<InnerEdge>& edges, const std::vector<std::uint8_t>& on_border,
                  double angle) {
  SharpEdges all;
  for_each_sharp_edge(edges, on_border, angle, [&](const InnerEdge&, int loose) {
    ++all.edges;
    all.loose += loose;
  });
  return all.ratio();
}

std::vector<std::uint8_t> find_noisy_parts(std::span<const Vec3> points, std::span<const Triangle> triangles,
                                           const std::vector<InnerEdge>& edges,
                                           const std::vector<std::uint8_t>& on_border,
                                           std::span<const Index> part, std::size_t part_count,
                                           double angle) {
  const std::vector<SharpEdges> sharp = edges_of_parts(edges, on_border, part, part_count, angle);
  const std::vector<std::uint8_t> counts = parts_that_count(points, triangles, part, sharp);
  std::vector<std::map<Index, double>> borders(part_count);
  for (const InnerEdge& e : edges) {
    const Index a = part[e.triangles[0]], b = part[e.triangles[1]];
    if (a != b) borders[a][b] += e.length, borders[b][a] += e.length;
  }

  std::vector<std::uint8_t> noisy(part_count, 0);
  std::vector<Index> queue;
  for (Index p = 0; p < part_count; ++p)
    if (sharp[p].loose >= min_loose_ends && sharp[p].ratio() > max_loose) {
      noisy[p] = 1;
      queue.push_back(p);
    }
  // More noise only adds to a part's noisy border, so the order of the queue does not matter.
  std::vector<double> length(part_count, 0), beside_noise(part_count, 0);
  for (Index p = 0; p < part_count; ++p)
    for (const auto& [other, shared] : borders[p]) length[p] += shared;
  while (!queue.empty()) {
    const Index beside = queue.back();
    queue.pop_back();
    for (const auto& [p, shared] : borders[beside]) {
      beside_noise[p] += shared;
      if (noisy[p] || counts[p] || beside_noise[p] < min_noisy_border * length[p]) continue;
      noisy[p] = 1;
      queue.push_back(p);
    }
  }

  // Small parts among noise can be each other's neighbours.
  DisjointSets clusters(part_count);
  for (Index p = 0; p < part_count; ++p)
    for (const auto& [other, unused] : borders[p])
      if (!noisy[p] && !noisy[other]) clusters.unite(p, other);
  std::vector<std::uint8_t> has_one(part_count, 0), is_beside(part_count, 0);
  for (Index p = 0; p < part_count; ++p) {
    if (noisy[p]) continue;
    if (counts[p]) has_one[clusters.root(p)] = 1;
    for (const auto& [other, unused] : borders[p])
      if (noisy[other]) is_beside[clusters.root(p)] = 1;
  }
  for (Index p = 0; p < part_count; ++p)
    if (!noisy[p] && is_beside[clusters.root(p)] && !has_one[clusters.root(p)]) noisy[p] = 1;
  return noisy;
}

}  // namespace tetwright
