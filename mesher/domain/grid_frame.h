// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>

#include <Eigen/Dense>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// A box of cells of a lattice: from `low` up to `high`, exclusive.
struct CellBox {
  std::array<int, 3> low{}, high{};

  bool contains(const std::array<int, 3>& cell) const {
    for (int a = 0; a < 3; ++a)
      if (cell[a] < low[a] || cell[a] >= high[a]) return false;
    return true;
  }
  bool operator==(const CellBox&) const = default;
};

/// The cells of an octree's level, with edges of 2^level finest cells, that overlap a box of finest cells.
inline CellBox at_level(const CellBox& finest, int level) {
  CellBox cells;
  for (int a = 0; a < 3; ++a) {
    cells.low[a] = finest.low[a] >> level;
    cells.high[a] = (finest.high[a] + (1 << level) - 1) >> level;
  }
  return cells;
}

/// Position and size of the grid of finest cells.
///
/// All of mesher/ works in *grid coordinates*: the unit is one finest cell, signed distances and corners of
/// the octree are at integers, and the box of the octree is [0, cells[0]] x [0, cells[1]] x [0, cells[2]].
/// Only the finished mesh is transformed back to input units.
struct GridFrame {
  Vec3 origin = Vec3::Zero();         ///< position of grid point (0, 0, 0), input units
  double cell_size = 1;               ///< edge of a finest cell, input units
  std::array<int, 3> cells{1, 1, 1};  ///< finest cells along each side of the box, a multiple of 2^root_level
  /// The part of `cells` that the lattice fills: all of it for surfaces, up to the border for a volume.
  std::array<int, 3> box{1, 1, 1};
  /// The border of a volume if bodies need the lattice to continue beyond it, as a box of finest cells; low
  /// and high are equal if the lattice ends at the border. No tet crosses the planes of its sides.
  CellBox border{};
  int root_level = 0;  ///< the octree's largest cells have 2^root_level finest cells to an edge
  /// Edges of a finest cell in multiples of cell_size, input space, right-handed. For surfaces they are
  /// perpendicular and of length 1.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();

  bool continues() const { return border != CellBox{}; }
  /// The box of a volume, finest cells.
  CellBox volume() const { return continues() ? border : CellBox{{0, 0, 0}, box}; }
  Vec3 to_grid(const Vec3& input) const { return axes.inverse() * (input - origin) / cell_size; }
  Vec3 to_input(const Vec3& grid) const { return origin + cell_size * (axes * grid); }
};

/// The faces of the box [0, box] that a point is on, grid coordinates: bit 2 * axis for the lower one, 2 *
/// axis + 1 for the upper one. Exact, since lattice points on the box never leave its faces.
inline unsigned box_faces(const Vec3& place, const std::array<int, 3>& box) {
  unsigned faces = 0;
  for (int a = 0; a < 3; ++a) {
    if (place[a] == 0) faces |= 1u << 2 * a;
    if (place[a] == box[a]) faces |= 2u << 2 * a;
  }
  return faces;
}

/// The planes of the sides of a box that a point is on, within them or beyond their rims; bits as for
/// box_faces().
inline unsigned side_planes(const Vec3& place, const CellBox& box, double slack = 0) {
  unsigned planes = 0;
  for (int a = 0; a < 3; ++a) {
    if (std::abs(place[a] - box.low[a]) <= slack) planes |= 1u << 2 * a;
    if (std::abs(place[a] - box.high[a]) <= slack) planes |= 2u << 2 * a;
  }
  return planes;
}

/// The sides of a box beyond which a point is; bits as for box_faces().
inline unsigned sides_beyond(const Vec3& place, const CellBox& box) {
  unsigned sides = 0;
  for (int a = 0; a < 3; ++a) {
    if (place[a] < box.low[a]) sides |= 1u << 2 * a;
    if (place[a] > box.high[a]) sides |= 2u << 2 * a;
  }
  return sides;
}

/// A frame whose box contains [low, high] (input units) and a margin (DomainTuning::Frames), rounded up to
/// whole root cells.
/// \param uniform root cells are finest cells; otherwise the longest side has about four to eight root cells
/// \param centred the excess of rounding up is even on both sides; otherwise it is above `high`
/// \pre `cell_size` > 0, and at most 2^18 cells along each side
GridFrame make_grid_frame(const Vec3& low, const Vec3& high, double cell_size, bool uniform,
                          bool centred = false);

/// A frame that fills a parallelepiped with whole cells, as close to `cell_size` along each axis as that
/// permits. Root cells have a bounded size (DomainTuning::Frames::max_volume_root), so that a part of the
/// volume determines the octree in it. \param edges of the parallelepiped, as columns, right-handed; input
/// units
GridFrame make_box_frame(const Vec3& corner, const Eigen::Matrix3d& edges, double cell_size, bool uniform);

/// A frame of a volume that continues beyond its border. Cells within are those of the given frame.
/// \param before, after cells to be added along each axis; rounded up to whole root cells
GridFrame continued_frame(GridFrame frame, const std::array<int, 3>& before, const std::array<int, 3>& after);

/// A frame of the same box, refined: cells of 1/2^levels the size, root cells of the same size.
GridFrame refined_frame(GridFrame frame, int levels);

}  // namespace tetwright
