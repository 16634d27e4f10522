// SPDX-License-Identifier: Apache-2.0
#include "mesher/lattice/seam.h"

#include <algorithm>
#include <array>

#include "common/parallel/parallel_sort.h"
#include "common/random.h"

namespace tetwright {

namespace {

using Flags = std::vector<std::uint8_t>;

/// Flags the points of each tet i for which `takes(i)` is true.
template <class Takes>
void flag_points(const TetList& tets, Takes&& takes, Flags& flags) {
  for (std::size_t i = 0; i < tets.size(); ++i)
    if (takes(i))
      for (const Index v : tets[i]) flags[v] = 1;
}

}  // namespace

SeamRecorder::SeamRecorder(LabelledLattice& lattice, const CellBox& brick) : lattice_(lattice) {
  inside_.resize(lattice.positions.size());
  const std::vector<Index>& near = lattice.stars.points();
  keys_.resize(inside_.size());
  lattice.histories.resize(near.size());
  for (std::size_t p = 0; p < inside_.size(); ++p) {
    std::array<int, 3> cell;
    // Points on the upper sides of the box belong to the last cell.
    for (int a = 0; a < 3; ++a)
      cell[a] = std::min(static_cast<int>(lattice.positions[p][a]), lattice.box[a] - 1);
    inside_[p] = brick.contains(cell);
    const Vec3 half_cells = 2 * lattice.positions[p];
    keys_[p] = morton_encode(static_cast<int>(half_cells[0]), static_cast<int>(half_cells[1]),
                             static_cast<int>(half_cells[2]));
  }
  for (std::size_t s = 0; s < near.size(); ++s)
    lattice.histories[s] = mixed_bits(1 + std::uint64_t{lattice.first_region[near[s]]});
}

Seam SeamRecorder::finish() {
  const TetList& tets = lattice_.tets;
  const StarMap& stars = lattice_.stars;
  const auto own = [&](Index v) { return inside_[v] != 0; };
  const auto foreign = [&](Index v) { return inside_[v] == 0; };
  const auto near = [&](Index v) { return stars.lists(v); };
  const auto with = [&](const auto& test) {
    return [&, test](std::size_t i) { return std::any_of(tets[i].begin(), tets[i].end(), test); };
  };
  const auto flagged = [](const Flags& flags) { return [&flags](Index v) { return flags[v] != 0; }; };
  const auto spread = [&](Flags& flags) {
    const Flags before = flags;
    flag_points(tets, with(flagged(before)), flags);
  };
  // Two edges from near points, the second one from a near point, too.
  Flags read(inside_.size(), 0);
  flag_points(tets, with([&](Index v) { return own(v) && near(v); }), read);
  const Flags once = read;
  flag_points(tets, with([&](Index v) { return once[v] && near(v); }), read);
  // The points of the brick's tets, and those around them.
  Flags around(inside_.size(), 0);
  flag_points(
      tets, [&](std::size_t i) { return lattice_.owns(i); }, around);
  spread(around);
  // A tet without a point in the brick has one that shares a tet with such a point: three edges include all
  // that other bricks need.
  Flags read_by_others(inside_.size(), 0);
  flag_points(tets, with(foreign), read_by_others);
  spread(read_by_others);
  spread(read_by_others);

  Seam seam;
  const auto add = [&](Index p, std::uint64_t history) {
    const MortonKey key = keys_[p];
    if (own(p)) {
      if (history != SeamPoint::not_near && read_by_others[p]) seam.offered.push_back({key, history});
    } else if (read[p] || around[p]) {
      seam.needed.push_back({key, history});
    }
  };
  for (Index p = 0; p < inside_.size(); ++p)
    add(p, near(p) ? lattice_.histories[stars.slot(p)] : SeamPoint::not_near);
  parallel_sort(seam.offered);
  parallel_sort(seam.needed);
  lattice_.histories = {};
  return seam;
}

}  // namespace tetwright
