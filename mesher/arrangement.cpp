#include "mesher/arrangement.h"

#include <bit>
#include <cstdint>

namespace tetwright {

namespace {

/// The link of a point as bit masks over at most 64 neighbours. Stars of the lattice have at most 17; only
/// octrees with many hanging edges around one point come near the limit.
struct Link {
  static constexpr int capacity = 64;
  Index points[capacity];
  std::uint64_t neighbours[capacity];
  int size = 0;
  bool overflow = false;

  Link(const LabelledLattice& lattice, const StarMap& stars, Index centre) {
    for (const Index* t = stars.begin(centre); t != stars.end(centre); ++t) {
      int local[3], n = 0;
      for (Index v : lattice.tets[*t])
        if (v != centre) local[n++] = number(v);
      if (overflow) return;
      neighbours[local[0]] |= std::uint64_t{1} << local[1] | std::uint64_t{1} << local[2];
      neighbours[local[1]] |= std::uint64_t{1} << local[0] | std::uint64_t{1} << local[2];
      neighbours[local[2]] |= std::uint64_t{1} << local[0] | std::uint64_t{1} << local[1];
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

  std::uint64_t of_side(const LabelledLattice& lattice, Side side) const {
    std::uint64_t mask = 0;
    for (int i = 0; i < size; ++i)
      if (lattice.sides[points[i]] == side) mask |= std::uint64_t{1} << i;
    return mask;
  }

  /// True if the points of the mask are some and hang together.
  bool one_piece(std::uint64_t mask) const {
    if (mask == 0) return false;
    std::uint64_t reached = mask & (~mask + 1), frontier = reached;
    while (frontier) {
      const int i = std::countr_zero(frontier);
      frontier &= frontier - 1;
      const std::uint64_t fresh = neighbours[i] & mask & ~reached;
      reached |= fresh;
      frontier |= fresh;
    }
    return reached == mask;
  }
};

/// One piece of each side around `u`; `dropped` counts as on the interface.
bool regular(const LabelledLattice& lattice, const StarMap& stars, Index u, Index dropped) {
  const Link link(lattice, stars, u);
  if (link.overflow) return false;
  std::uint64_t keep = ~std::uint64_t{0};
  for (int i = 0; i < link.size; ++i)
    if (link.points[i] == dropped) keep &= ~(std::uint64_t{1} << i);
  return link.one_piece(link.of_side(lattice, Side::inside) & keep) &&
         link.one_piece(link.of_side(lattice, Side::outside) & keep);
}

}  // namespace

bool may_move_onto_interface(const LabelledLattice& lattice, const StarMap& stars, Index point) {
  const Link link(lattice, stars, point);
  if (link.overflow) return false;
  const std::uint64_t on = link.of_side(lattice, Side::on);
  const std::uint64_t inside = link.of_side(lattice, Side::inside);
  const std::uint64_t outside = link.of_side(lattice, Side::outside);
  if (!link.one_piece(inside) || !link.one_piece(outside)) return false;
  if (on == 0) return true;

  const Side side = lattice.sides[point];
  const std::uint64_t own = side == Side::inside ? inside : outside;
  for (std::uint64_t rest = on; rest; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    const Index u = link.points[i];
    const std::uint64_t around_edge = link.neighbours[i];
    const bool same_origin = lattice.first_side(u) == side;
    if (same_origin && !(around_edge & own)) return false;
    // Triangles of the point, u and w, all on the interface then. Two tets hold each, and their tips are the
    // common neighbours of u and w in the link (others than those two are rare and only make us more
    // careful).
    for (std::uint64_t more = around_edge & on; more; more &= more - 1) {
      const int j = std::countr_zero(more);
      const std::uint64_t tips = around_edge & link.neighbours[j];
      if (tips & on) return false;
      if (same_origin && lattice.first_side(link.points[j]) == side && !(tips & own)) return false;
    }
    if (!regular(lattice, stars, u, point)) return false;
  }
  return true;
}

}  // namespace tetwright
