#include "mesher/labelled_lattice.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "common/parallel_sort.h"

namespace tetwright {

namespace {

constexpr std::size_t grain = 1 << 14;  // tets or points to a task, some nanoseconds each

}  // namespace

LabelledLattice label_lattice(LatticePoints points, std::vector<float> distances, std::vector<Tet> tets) {
  LabelledLattice lattice;
  lattice.positions = std::move(points.positions);
  lattice.is_centre = std::move(points.is_centre);
  lattice.distances = std::move(distances);
  const std::size_t count = lattice.positions.size();
  lattice.sides.resize(count);
  parallel_for(0, count, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) lattice.sides[i] = lattice.first_side(static_cast<Index>(i));
  });

  const auto inside_count = [&](const Tet& t) {
    int inside = 0;
    for (Index v : t) inside += lattice.sides[v] == Side::inside;
    return inside;
  };
  std::vector<std::uint8_t> near(count, 0);
  parallel_for(0, tets.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const int inside = inside_count(tets[i]);
      if (inside == 0 || inside == 4) continue;
      // Relaxed: all writers write 1, and nobody reads before the loop is over.
      for (Index v : tets[i]) std::atomic_ref<std::uint8_t>(near[v]).store(1, std::memory_order_relaxed);
    }
  });
  for (Index i = 0; i < count; ++i)
    if (near[i]) lattice.near_points.push_back(i);
  lattice.tets = parallel_collect<Tet>(
      0, tets.size(), grain, [&](std::size_t begin, std::size_t end, std::vector<Tet>& out) {
        for (std::size_t i = begin; i < end; ++i) {
          const Tet& t = tets[i];
          if (inside_count(t) || near[t[0]] || near[t[1]] || near[t[2]] || near[t[3]]) out.push_back(t);
        }
      });
  return lattice;
}

std::size_t remove_specks(LabelledLattice& lattice) {
  std::size_t count = 0;
  // One side after the other, so that two specks side by side don't just change places.
  for (Side side : {Side::outside, Side::inside}) {
    std::vector<std::uint8_t> has_company(lattice.positions.size(), 0);
    parallel_for(0, lattice.tets.size(), grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Tet& t = lattice.tets[i];
        int members = 0;
        for (Index v : t) members += lattice.sides[v] == side;
        if (members < 2) continue;
        // Relaxed: as in label_lattice().
        for (Index v : t)
          if (lattice.sides[v] == side)
            std::atomic_ref<std::uint8_t>(has_company[v]).store(1, std::memory_order_relaxed);
      }
    });
    for (Index p : lattice.near_points) {
      if (lattice.sides[p] != side || has_company[p]) continue;
      // Never 0: an outside point at distance 0 would stay outside by its sign.
      constexpr float smallest = 1e-6f;
      const float size = std::max(std::abs(lattice.distances[p]), smallest);
      lattice.distances[p] = side == Side::inside ? size : -size;
      lattice.sides[p] = lattice.first_side(p);
      ++count;
    }
  }
  return count;
}

StarMap::StarMap(const LabelledLattice& lattice) {
  slots_.assign(lattice.positions.size(), no_index);
  for (Index i = 0; i < lattice.near_points.size(); ++i) slots_[lattice.near_points[i]] = i;
  starts_.assign(lattice.near_points.size() + 2, 0);
  // Counted two places on, so that after filling, starts_[i] is where the star of i begins.
  for (const Tet& t : lattice.tets)
    for (Index v : t)
      if (slots_[v] != no_index) ++starts_[slots_[v] + 2];
  for (std::size_t i = 2; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
  tets_.resize(starts_.back());
  for (Index k = 0; k < lattice.tets.size(); ++k)
    for (Index v : lattice.tets[k])
      if (slots_[v] != no_index) tets_[starts_[slots_[v] + 1]++] = k;
}

}  // namespace tetwright
