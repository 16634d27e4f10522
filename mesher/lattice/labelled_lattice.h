// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesher/domain/material_field.h"
#include "mesher/lattice/lattice.h"
#include "mesher/lattice/star_map.h"
#include "mesher/lattice/tet_list.h"
#include "mesher/level_sets/sheeted_field.h"
#include "tetwright/mesher_input.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// The lattice whose points are moved and whose tets are cut: the tets that can contribute to the mesh, and
/// the region of every point.
///
/// For each point near an interface, stores the signed distances of the regions in its closed star. The cuts
/// of its edges depend on nothing else. The region of a pure point is the one of the smallest distance.
class LabelledLattice {
 public:
  std::vector<Vec3> positions;  ///< lattice units
  /// 1 for centres of leaves. Long edges join two centres or two corners, short ones a centre and a corner.
  std::vector<std::uint8_t> is_centre;
  std::vector<RegionIndex> first_region;  ///< region of each point before it was moved onto an interface
  /// 1 for points that were moved onto an interface, and for those of mark_rims().
  std::vector<std::uint8_t> is_on;
  TetList tets;   ///< positive
  StarMap stars;  ///< of all points of tets with more than one region
  /// By slot of `stars`: hash of the changes of the point's state so far; empty: not recorded. See SeamPoint.
  std::vector<std::uint64_t> histories;
  /// By tet: 1 for those that belong to the brick to be meshed, see lattice_tets(); empty: all.
  std::vector<std::uint8_t> owned;
  bool keep_outside = false;
  bool has_rims = false;     ///< see mark_rims()
  std::array<int, 3> box{};  ///< lattice units
  CellBox border{};          ///< of a volume, see GridFrame

  /// The faces of the box that a point is on, see tetwright::box_faces().
  unsigned box_faces(Index p) const { return tetwright::box_faces(positions[p], box); }

  /// The planes that a point stays on: bits of box_faces(), and from bit 6 on those of the border of a
  /// volume.
  unsigned held_planes(Index p) const {
    const unsigned faces = box_faces(p);
    return border == CellBox{} ? faces : faces | side_planes(positions[p], border) << 6;
  }

  /// Whether a tet belongs to the brick to be meshed.
  bool owns(std::size_t tet) const { return owned.empty() || owned[tet]; }

  /// The current region of a point, or on_interface.
  RegionIndex region(Index p) const { return is_on[p] ? on_interface : first_region[p]; }

  /// The regions that the closed star of a point near an interface had before any point was moved, ascending.
  /// star_values() are their signed distances at the point, in this order.
  std::span<const RegionIndex> star_regions(Index p) const {
    const Index s = stars.slot(p);
    return {regions_.data() + starts_[s], regions_.data() + starts_[s + 1]};
  }
  std::span<const float> star_values(Index p) const {
    const Index s = stars.slot(p);
    return {values_.data() + starts_[s], values_.data() + starts_[s + 1]};
  }
  std::span<float> star_values(Index p) {
    const Index s = stars.slot(p);
    return {values_.data() + starts_[s], values_.data() + starts_[s + 1]};
  }
  /// The signed distance of region b minus that of region a at a point near an interface.
  /// \pre both regions are in the point's star
  float gap(Index p, RegionIndex a, RegionIndex b) const;
  /// Position of the cut on the edge from p (region a) to q (region b), as a fraction of the edge.
  double cut_share(Index p, RegionIndex a, Index q, RegionIndex b) const {
    const double at_p = gap(p, a, b), at_q = gap(q, b, a);
    return at_p + at_q > 0 ? at_p / (at_p + at_q) : 0.5;
  }
  /// The smallest signed distance of the other regions in the star minus that of the point's own region.
  float margin(Index p) const;

  /// Finds the regions of all stars and sets their values to 0.
  void list_star_regions(std::size_t region_count);
  /// Frees the stars, their regions and values, which must not be used afterwards.
  void free_stars();

 private:
  std::vector<std::size_t> starts_;  ///< by slot
  std::vector<RegionIndex> regions_;
  std::vector<float> values_;
};

/// Makes a labelled lattice.
///
/// Tets outside without a point next to an interface are dropped, unless `keep_outside`. Isolated vertices
/// (points without a neighbour of their own region) get the region that most of their neighbours have,
/// isolated vertices of the outside first. They result from cracks and self-intersections smaller than a
/// cell, and each would become a component or a cavity.
/// \param nearest region of each point
/// \param region_count number of regions
/// \param isolated_vertices receives their number; may be null
/// \param owned LabelledLattice::owned, for `tets`
LabelledLattice label_lattice(LatticePoints points, std::vector<NearestRegion> nearest, TetList tets,
                              std::size_t region_count, bool keep_outside, std::size_t* isolated_vertices,
                              std::vector<std::uint8_t> owned = {});

/// Marks points as if on an interface, so that no cut is made, where parts of a region meet that no sheet
/// separates: at the rims of the zones around sheets. Exempt are points with neighbours from which a sheet or
/// an interface separates them.
void mark_rims(LabelledLattice& lattice, const SheetedField& field);

/// Reads the signed distances of all stars. Where a point's own region is not the nearest in the field
/// (isolated vertices, ties), its distance is lowered just below the others, so that every cut is defined.
void read_star_values(LabelledLattice& lattice, const MaterialField& field);

}  // namespace tetwright
