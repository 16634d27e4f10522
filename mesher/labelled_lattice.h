#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/types.h"
#include "mesher/lattice.h"
#include "mesher/material_field.h"
#include "mesher/regions.h"
#include "mesher/star_map.h"
#include "mesher/tet_list.h"

namespace tetwright {

/// The tets of the lattice that matter and the region of every point: what is moved, then cut.
///
/// A point near an interface knows the signed distances of the regions in its closed star, which is all that
/// cuts of its edges depend on. The region of a pure point is the one of the smallest distance.
class LabelledLattice {
 public:
  std::vector<Vec3> positions;  ///< lattice units
  std::vector<std::uint8_t>
      is_centre;  ///< 1 for centres of leaves: long edges join alike points, short ones unlike
  std::vector<RegionIndex> first_region;  ///< of each point before it was moved onto an interface
  std::vector<std::uint8_t> is_on;        ///< 1 for points that were
  TetList tets;                           ///< positive
  StarMap stars;                          ///< of the points of tets with more than one region
  bool keep_outside = false;

  /// The region of a point now, or on_interface.
  RegionIndex region(Index p) const { return is_on[p] ? on_interface : first_region[p]; }

  /// The regions of the closed star of a point near an interface as the lattice was laid out, ascending, and
  /// their signed distances, in the same order.
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
  /// How much nearer region a is than region b at a point near an interface; both are in its star.
  float gap(Index p, RegionIndex a, RegionIndex b) const;
  /// Where on the edge from p (region a) to q (region b) the two are equally near, as a share of the edge.
  double cut_share(Index p, RegionIndex a, Index q, RegionIndex b) const {
    const double at_p = gap(p, a, b), at_q = gap(q, b, a);
    return at_p + at_q > 0 ? at_p / (at_p + at_q) : 0.5;
  }
  /// By how much the region of a point near an interface wins over the others of its star.
  float margin(Index p) const;

  /// Lists the regions of all stars; values are 0 then.
  void list_star_regions(std::size_t region_count);
  /// Gives the memory of the stars, their regions and values back; none is to be asked for any more.
  void forget_stars();

 private:
  std::vector<std::size_t> starts_;  ///< by slot
  std::vector<RegionIndex> regions_;
  std::vector<float> values_;
};

/// Takes points and tets over, drops tets outside that have no point next to an interface (with
/// `keep_outside` none), and gives single points without a neighbour of their own region the region most of
/// their neighbours have, those outside first; `specks` (may be null) is how many there were. They are
/// smaller than a cell: cracks and self-intersections that the grid hits by chance, and each would become a
/// component or a cavity. `nearest` is the region of each point, of `region_count` in all.
LabelledLattice label_lattice(LatticePoints points, std::vector<NearestRegion> nearest, TetList tets,
                              std::size_t region_count, bool keep_outside, std::size_t* specks);

/// Reads the signed distances of all stars. Where the field does not give a point its own region (specks,
/// ties), that is made the nearest by a hair, so that no cut is undefined.
void read_star_values(LabelledLattice& lattice, const MaterialField& field);

}  // namespace tetwright
