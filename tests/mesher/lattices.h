// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "mesher/lattice/labelled_lattice.h"

namespace tetwright {

/// A lattice of 6 x 6 x 6 equal cells with regions as a function of the position. The distance of a point's
/// own region is -1, that of all others 1.
inline LabelledLattice make_lattice(const std::function<RegionIndex(const Vec3&)>& region,
                                    std::size_t* isolated_vertices = nullptr) {
  const Octree octree =
      build_octree({6, 6, 6}, 0, [](int, const std::vector<MortonKey>&) { return std::vector<MortonKey>(); });
  LatticePoints points = lattice_points(octree);
  std::vector<NearestRegion> nearest;
  RegionIndex max_region = 1;
  for (const Vec3& p : points.positions) {
    nearest.push_back({region(p), 1});
    max_region = std::max(max_region, nearest.back().region);
  }
  TetList tets = lattice_tets(octree, points);
  LabelledLattice lattice = label_lattice(std::move(points), std::move(nearest), std::move(tets),
                                          max_region + 1u, false, isolated_vertices);
  for (Index p : lattice.stars.points())
    for (std::size_t i = 0; i < lattice.star_regions(p).size(); ++i)
      lattice.star_values(p)[i] = lattice.star_regions(p)[i] == lattice.first_region[p] ? -1.0f : 1.0f;
  return lattice;
}

inline Index point_at(const LabelledLattice& lattice, const Vec3& p) {
  for (Index i = 0; i < lattice.positions.size(); ++i)
    if (lattice.positions[i] == p) return i;
  return no_index;
}

}  // namespace tetwright
