#pragma once

#include <cstdint>
#include <vector>

#include "common/types.h"
#include "mesher/lattice.h"

namespace tetwright {

/// On which side of the interface a lattice point is.
enum class Side : std::int8_t { inside = -1, on = 0, outside = 1 };

/// The tets of the lattice that matter, with the side of every point: what is moved, then cut.
struct LabelledLattice {
  std::vector<Vec3> positions;   ///< grid coordinates
  std::vector<float> distances;  ///< finest cells, negative inside; of a point on the interface: as it was
  std::vector<std::uint8_t>
      is_centre;  ///< 1 for centres of leaves: long edges join alike points, short ones unlike
  std::vector<Side> sides;
  std::vector<Tet> tets;           ///< positive
  std::vector<Index> near_points;  ///< ascending: the points of tets with both sides

  /// The side a point had before it was moved onto the interface.
  Side first_side(Index p) const { return distances[p] < 0 ? Side::inside : Side::outside; }
};

/// Takes the points and tets over and drops tets outside that have no point next to the interface.
LabelledLattice label_lattice(LatticePoints points, std::vector<float> distances, std::vector<Tet> tets);

/// Gives single points that have no neighbour on their own side the side of all their neighbours, cavities
/// first, and returns how many there were. Such specks are smaller than a cell: they come from cracks and
/// self-intersections that the grid hits by chance, and would each become a component or a cavity.
std::size_t remove_specks(LabelledLattice& lattice);

/// For some points the tets they belong to.
class StarMap {
 public:
  /// For the points that `near_points` of the lattice lists.
  explicit StarMap(const LabelledLattice& lattice);

  bool lists(Index point) const { return slots_[point] != no_index; }
  /// The numbers of the tets around a listed point.
  const Index* begin(Index point) const { return tets_.data() + starts_[slots_[point]]; }
  const Index* end(Index point) const { return tets_.data() + starts_[slots_[point] + 1]; }

 private:
  std::vector<Index> slots_;  ///< place in near_points, for each point of the lattice
  std::vector<Index> starts_;
  std::vector<Index> tets_;
};

}  // namespace tetwright
