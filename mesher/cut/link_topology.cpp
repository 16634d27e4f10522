// SPDX-License-Identifier: Apache-2.0
#include "mesher/cut/link_topology.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <utility>

namespace tetwright {

namespace {

using Mask = std::uint64_t;

constexpr Mask bit(int i) { return Mask{1} << i; }

/// The region of the space beyond the box, which has no lattice points.
constexpr RegionIndex beyond_box = 0xfffe;

/// The link of a point as bit masks over at most 64 neighbours. Lattice stars have at most 17; only octrees
/// with many hanging edges around one point come near the limit. The link of a point on the box is a disc;
/// one more neighbour beyond the box, joined to the rim of the disc, makes it a sphere like the others.
struct Link {
  static constexpr int capacity = 64;
  /// The number of triangles of a triangulated sphere of `capacity` points.
  static constexpr int max_triangles = 2 * capacity - 4;
  Index points[capacity];
  Mask neighbours[capacity];
  std::array<std::uint8_t, 3> triangles[max_triangles];
  int size = 0, triangle_count = 0;
  int beyond = -1;  ///< index of the neighbour beyond the box
  bool overflow = false;
  const LabelledLattice& lattice;
  Index centre;

  Link(const LabelledLattice& l, Index c) : lattice(l), centre(c) {
    const unsigned faces = lattice.box_faces(centre);
    for (Index t : lattice.stars.tets(centre)) {
      std::array<int, 3> local{};
      int n = 0;
      for (Index v : lattice.tets[t])
        if (v != centre) local[n++] = number(v);
      add_triangle(local[0], local[1], local[2]);
      if (faces) close_at_box(local, faces);
      if (overflow) return;
    }
  }

  void add_triangle(int a, int b, int d) {
    if (triangle_count == max_triangles) overflow = true;
    if (overflow) return;
    triangles[triangle_count++] = {static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b),
                                   static_cast<std::uint8_t>(d)};
    neighbours[a] |= bit(b) | bit(d);
    neighbours[b] |= bit(a) | bit(d);
    neighbours[d] |= bit(a) | bit(b);
  }

  /// Joins the triangle's edges that lie on one of the centre's box faces to the neighbour beyond the box.
  void close_at_box(const std::array<int, 3>& triangle, unsigned faces) {
    for (int k = 0; k < 3 && !overflow; ++k) {
      const int a = triangle[k], b = triangle[(k + 1) % 3];
      if (!(lattice.box_faces(points[a]) & lattice.box_faces(points[b]) & faces)) continue;
      if (beyond < 0) beyond = number(no_index);
      add_triangle(a, b, beyond);
    }
  }

  int number(Index v) {
    for (int i = 0; i < size; ++i)
      if (points[i] == v) return i;
    if (size == capacity) {
      overflow = true;
      return 0;
    }
    points[size] = v;
    neighbours[size] = 0;
    return size++;
  }

  /// The current region of a neighbour, or on_interface.
  RegionIndex region(int i) const { return i == beyond ? beyond_box : lattice.region(points[i]); }

  Mask of_region(RegionIndex region) const {
    Mask mask = 0;
    for (int i = 0; i < size; ++i)
      if (this->region(i) == region) mask |= bit(i);
    return mask;
  }

  /// The regions of the link's pure points and of the space beyond the box; nothing if there are too many.
  std::optional<RegionSet> pure() const {
    RegionSet set;
    for (int i = 0; i < size; ++i)
      if (const RegionIndex r = region(i); r != on_interface && !set.insert(r)) return std::nullopt;
    return set;
  }

  /// True if the mask is not empty and its points are connected.
  bool one_piece(Mask mask) const {
    if (mask == 0) return false;
    Mask reached = mask & (~mask + 1), frontier = reached;
    while (frontier) {
      const int i = std::countr_zero(frontier);
      frontier &= frontier - 1;
      const Mask fresh = neighbours[i] & mask & ~reached;
      reached |= fresh;
      frontier |= fresh;
    }
    return reached == mask;
  }

  /// True if the points of the mask, with the edges and triangles between them, form one disc.
  bool one_disc(Mask mask) {
    if (!one_piece(mask)) return false;
    int twice_edges = 0, inside = 0;
    for (Mask rest = mask; rest; rest &= rest - 1)
      twice_edges += std::popcount(neighbours[std::countr_zero(rest)] & mask);
    for (int t = 0; t < triangle_count; ++t) {
      const Mask corners = bit(triangles[t][0]) | bit(triangles[t][1]) | bit(triangles[t][2]);
      inside += corners == (corners & mask);
    }
    return std::popcount(mask) - twice_edges / 2 + inside == 1;
  }

  /// True if no region appears twice around the edge from the centre to neighbour i. The link of that edge is
  /// a cycle, in which each region must form one stretch (points on interfaces do not interrupt it).
  /// Otherwise two regions could touch along the edge alone, with a third one on either side.
  bool one_stretch_each(int i) {
    // The two neighbours of each point of the cycle.
    std::array<std::array<int, 2>, capacity> beside;
    std::array<int, capacity> known{};
    int first = -1;
    for (int t = 0; t < triangle_count; ++t) {
      std::array<std::uint8_t, 3> c = triangles[t];
      const auto at = std::find(c.begin(), c.end(), i);
      if (at == c.end()) continue;
      std::swap(*at, c[2]);
      for (const auto& [a, b] : {std::pair(c[0], c[1]), std::pair(c[1], c[0])}) {
        if (known[a] == 2) return false;
        beside[a][known[a]++] = b;
      }
      first = c[0];
    }
    std::array<RegionIndex, capacity> stretches;
    int count = 0;
    for (int previous = -1, now = first, steps = 0; steps < size && known[now] == 2; ++steps) {
      if (const RegionIndex r = region(now); r != on_interface && (count == 0 || stretches[count - 1] != r))
        stretches[count++] = r;
      const int next = beside[now][0] == previous ? beside[now][1] : beside[now][0];
      previous = now;
      now = next;
      if (now == first) break;
    }
    if (count > 1 && stretches[count - 1] == stretches[0]) --count;  // the cycle closes
    std::sort(stretches.begin(), stretches.begin() + count);
    return std::adjacent_find(stretches.begin(), stretches.begin() + count) == stretches.begin() + count;
  }

  /// True if the points of the mask satisfy the condition for every region of the set around a point on an
  /// interface.
  bool regular(const RegionSet& regions, Mask keep) {
    for (RegionIndex r : regions) {
      const Mask part = of_region(r) & keep;
      // On a sphere divided into two regions, both are discs if and only if both are connected.
      if (regions.size() == 2 ? !one_piece(part) : !one_disc(part)) return false;
    }
    return true;
  }
};

}  // namespace

std::optional<RegionSet> pure_regions(const LabelledLattice& lattice, Index point) {
  RegionSet set;
  for (Index t : lattice.stars.tets(point))
    for (Index v : lattice.tets[t])
      if (const RegionIndex r = lattice.region(v); r != on_interface && !set.insert(r)) return std::nullopt;
  return set;
}

std::optional<RegionSet> regions_if_moved(const LabelledLattice& lattice, Index point) {
  Link link(lattice, point);
  if (link.overflow) return std::nullopt;
  const std::optional<RegionSet> regions = link.pure();
  const RegionIndex region = lattice.first_region[point];
  if (!regions || !regions->contains(region)) return std::nullopt;
  RegionSet meeting;
  for (const RegionIndex r : *regions)
    if (r != beyond_box) meeting.insert(r);
  if (meeting.size() < 2) return std::nullopt;
  if (!link.regular(*regions, ~Mask{0})) return std::nullopt;
  const Mask on = link.of_region(on_interface);
  const Mask own = link.of_region(region);
  for (Mask rest = on; rest; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    const Index u = link.points[i];
    const Mask around_edge = link.neighbours[i];
    const bool same_origin = lattice.first_region[u] == region;
    if (same_origin && !(around_edge & own)) return std::nullopt;
    // After the move, the triangles of the point, u and w would lie on interfaces. Each is shared by two
    // tets, whose tips are the common neighbours of u and w in the link. Further common neighbours are rare
    // and only make the test stricter.
    for (Mask more = around_edge & on; more; more &= more - 1) {
      const int j = std::countr_zero(more);
      const Mask tips = around_edge & link.neighbours[j];
      if (tips & on) return std::nullopt;
      if (same_origin && lattice.first_region[link.points[j]] == region && !(tips & own)) return std::nullopt;
    }
    // Two regions cannot alternate around an edge if both ends see each of them as one piece.
    if (regions->size() > 2 && !link.one_stretch_each(i)) return std::nullopt;
    // The regions that meet at u are those around it now, including the point itself.
    Link around_u(lattice, u);
    const std::optional<RegionSet> at_u = around_u.pure();
    if (around_u.overflow || !at_u) return std::nullopt;
    Mask keep = ~Mask{0};
    for (int k = 0; k < around_u.size; ++k)
      if (around_u.points[k] == point) keep &= ~bit(k);
    if (!around_u.regular(*at_u, keep)) return std::nullopt;
  }
  return meeting;
}

}  // namespace tetwright
