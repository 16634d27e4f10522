// SPDX-License-Identifier: Apache-2.0
#include "mesher/level_sets/field_solid.h"

#include <algorithm>

#include "common/parallel/parallel_sort.h"
#include "mesher/tuning/distance_tuning.h"

namespace tetwright {

namespace {

/// Bits of a coordinate in the number of an edge: a frame has at most 2^18 cells along a side.
constexpr int coordinate_bits = 19;

using Corner = std::array<int, 3>;
/// An edge of the tets: from a corner to another one, 1 farther along one or more axes.
using Edge = std::uint64_t;

Edge edge_number(const Corner& corner, int axes) {
  Edge edge = 0;
  for (int a = 2; a >= 0; --a) edge = edge << coordinate_bits | static_cast<Edge>(corner[a]);
  return edge << 3 | static_cast<Edge>(axes);
}

Corner moved(const Corner& corner, int axes) {
  return {corner[0] + (axes & 1), corner[1] + (axes >> 1 & 1), corner[2] + (axes >> 2)};
}

/// The corners of the six tets of a voxel. Bit `axis` of a corner: it is at the upper end along that axis.
constexpr std::array<std::array<int, 4>, 6> kuhn_tets{
    {{0, 1, 3, 7}, {0, 1, 5, 7}, {0, 2, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 4, 6, 7}}};

/// Twice the midpoint of the edge between two corners of a voxel.
Vec3 doubled_middle(int a, int b) {
  const auto coordinate = [&](int axis) { return static_cast<double>((a >> axis & 1) + (b >> axis & 1)); };
  return {coordinate(0), coordinate(1), coordinate(2)};
}

/// Appends the triangles in which the surface cuts a tet, as the three edges that are cut, oriented outwards.
void cut_tet(const std::array<int, 4>& tet, const std::array<bool, 8>& inside, const Corner& low,
             std::vector<Edge>& out) {
  std::array<int, 4> in{}, beyond{};
  int n = 0, m = 0;
  for (const int corner : tet) (inside[static_cast<std::size_t>(corner)] ? in[n++] : beyond[m++]) = corner;
  if (n == 0 || m == 0) return;
  const auto add = [&](std::array<std::array<int, 2>, 3> t) {
    const Vec3 a = doubled_middle(t[0][0], t[0][1]), b = doubled_middle(t[1][0], t[1][1]),
               c = doubled_middle(t[2][0], t[2][1]);
    const Vec3 outwards = doubled_middle(beyond[0], beyond[0]) - doubled_middle(in[0], in[0]);
    if ((b - a).cross(c - a).dot(outwards) < 0) std::swap(t[1], t[2]);
    for (const auto& [from, to] : t) {
      const int start = from & to;  // the bits of one corner include those of the other
      out.push_back(edge_number(moved(low, start), from ^ to));
    }
  };
  if (n == 1) add({{{in[0], beyond[0]}, {in[0], beyond[1]}, {in[0], beyond[2]}}});
  if (n == 3) add({{{in[0], beyond[0]}, {in[1], beyond[0]}, {in[2], beyond[0]}}});
  if (n != 2) return;
  add({{{in[0], beyond[0]}, {in[0], beyond[1]}, {in[1], beyond[1]}}});
  add({{{in[0], beyond[0]}, {in[1], beyond[1]}, {in[1], beyond[0]}}});
}

/// The point at which the surface of the region cuts an edge, input units.
Vec3 cut_of(FieldSampler& sampler, const GridFrame& voxels, Edge edge) {
  constexpr Edge mask = (Edge{1} << coordinate_bits) - 1;
  const int axes = static_cast<int>(edge & 7);
  Corner a{};
  for (int i = 0; i < 3; ++i)
    a[static_cast<std::size_t>(i)] = static_cast<int>(edge >> (3 + i * coordinate_bits) & mask);
  const Corner b = moved(a, axes);
  const double from = sampler.nearest_at_voxel(a[0], a[1], a[2]).margin,
               to = sampler.nearest_at_voxel(b[0], b[1], b[2]).margin;
  const double share = from + to > 0 ? from / (from + to) : 0.5;
  const Vec3 start(a[0], a[1], a[2]), end(b[0], b[1], b[2]);
  return voxels.to_input(start + share * (end - start));
}

}  // namespace

SolidShape field_solid(const MaterialField& field, const std::vector<MortonKey>& interface_voxels,
                       RegionIndex region) {
  const std::vector<Edge> cuts =
      parallel_collect<Edge>(0, interface_voxels.size(), DistanceGrains::marched_voxels,
                             [&](std::size_t begin, std::size_t end, std::vector<Edge>& out) {
                               const std::unique_ptr<FieldSampler> sampler = field.sampler();
                               for (std::size_t i = begin; i < end; ++i) {
                                 const Corner low = morton_decode(interface_voxels[i]);
                                 std::array<bool, 8> inside{};
                                 for (int k = 0; k < 8; ++k) {
                                   const Corner c = moved(low, k);
                                   inside[static_cast<std::size_t>(k)] =
                                       sampler->nearest_at_voxel(c[0], c[1], c[2]).region == region;
                                 }
                                 for (const auto& tet : kuhn_tets) cut_tet(tet, inside, low, out);
                               }
                             });
  std::vector<Edge> edges = cuts;
  parallel_sort_unique(edges);
  std::vector<Vec3> points(edges.size());
  parallel_for(0, edges.size(), DistanceGrains::marched_voxels, [&](std::size_t begin, std::size_t end) {
    const std::unique_ptr<FieldSampler> sampler = field.sampler();
    for (std::size_t i = begin; i < end; ++i) points[i] = cut_of(*sampler, field.voxels(), edges[i]);
  });
  std::vector<Triangle> triangles(cuts.size() / 3);
  parallel_for(0, triangles.size(), DistanceGrains::marched_voxels, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      for (std::size_t k = 0; k < 3; ++k)
        triangles[t][k] =
            static_cast<Index>(std::lower_bound(edges.begin(), edges.end(), cuts[3 * t + k]) - edges.begin());
  });
  return solid_shape(points, triangles);
}

}  // namespace tetwright
