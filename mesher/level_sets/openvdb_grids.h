// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "mesher/domain/grid_frame.h"
#include "mesher/domain/narrow_band.h"
#include "tetwright/label_volume.h"
#include "tetwright/progress.h"
#include "tetwright/surface_mesh.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

struct VdbGrid;

/// Position of a stored grid: grid point (x, y, z) lies at origin + directions * (x, y, z), input units.
struct GridPlacement {
  Vec3 origin;
  Eigen::Matrix3d directions;
};

// All uses of OpenVDB in the project, without OpenVDB's headers.

/// View of the 8 x 8 x 8 grid points of a leaf of a DistanceGrid. `Value` is float or const float. The grid
/// point at (x, y, z) from the origin has the number (x * leaf_side + y) * leaf_side + z.
template <class Value>
struct GridLeaf {
  using Word = std::conditional_t<std::is_const_v<Value>, const std::uint64_t, std::uint64_t>;
  LeafOrigin origin;
  Value* values;
  Word* active_bits;  ///< leaf_points / 64 words; grid point k is bit k % 64 of word k / 64

  bool active(int k) const { return active_bits[k / 64] >> (k % 64) & 1; }
  void activate(int k, float value) const {
    values[k] = value;
    active_bits[k / 64] |= std::uint64_t{1} << (k % 64);
  }
  int number(int x, int y, int z) const {
    return ((x - origin[0]) * leaf_side + y - origin[1]) * leaf_side + z - origin[2];
  }
  std::array<int, 3> point(int k) const {
    return {origin[0] + k / (leaf_side * leaf_side), origin[1] + k / leaf_side % leaf_side,
            origin[2] + k % leaf_side};
  }
};

/// Distances at grid points, stored as an OpenVDB grid of floats: leaves near the surface, one value for
/// whole tiles elsewhere. The active grid points are those in the narrow band.
///
/// Const functions may be called concurrently, and so may writes to different leaves.
class DistanceGrid {
 public:
  /// All grid points are inactive, with the value `background` (> 0).
  explicit DistanceGrid(double background);
  ~DistanceGrid();
  DistanceGrid(DistanceGrid&&) noexcept;
  DistanceGrid& operator=(DistanceGrid&&) noexcept;

  /// Unsigned distances of grid points from triangles in grid coordinates: active within level_set_band, that
  /// value elsewhere.
  /// \throws Interrupted
  static DistanceGrid unsigned_distances(std::span<const Vec3> points, std::span<const Triangle> triangles,
                                         Progress* progress);
  /// Reads a stored grid of floats or doubles; doubles are rounded to floats.
  /// \param stored must hold its bytes, which are consumed
  /// \throws InputError beginning with `file` if OpenVDB cannot read it
  static DistanceGrid from_vdb(VdbGrid& stored, const std::string& file);

  DistanceGrid copy() const;

  float background() const;
  /// True if there are active values above and below 0.
  bool has_both_signs() const;
  /// The active value of a grid point, or `otherwise`.
  float active_or(int x, int y, int z, float otherwise) const;
  /// Calls f(first, last, value), in OpenVDB's order, for each active grid point (first == last) and each
  /// active tile, which has one value from its first grid point to its last.
  using IndexPlace = std::array<int, 3>;
  void for_each_active(
      const std::function<void(const IndexPlace& first, const IndexPlace& last, float value)>& f) const;
  /// Position of the grid points by the grid's own transform, which must be linear.
  GridPlacement placement() const;
  /// All leaves, in OpenVDB's order.
  std::vector<GridLeaf<const float>> leaves() const;
  std::vector<GridLeaf<float>> leaves();
  /// The leaf at `origin` (multiples of leaf_side), created if missing.
  GridLeaf<float> touch_leaf(const LeafOrigin& origin);

  /// Removes leaves without active grid points.
  void prune_inactive();
  /// Sets all inactive grid points and tiles to level_set_band, with the sign of the adjacent active points.
  void fill_outside_band();
  /// Sets only tiles to `band`, with the sign of the adjacent grid points, active or not.
  void fill_tiles_outside_band(double band);

  /// The zero level in world coordinates, by the grid's own transform, with the negative side inside. Has no
  /// triangles if the values do not cross 0.
  /// \throws std::domain_error if OpenVDB cannot transform it
  TriangleMesh zero_surface() const;

  /// The OpenVDB grid; defined in openvdb_types.h.
  struct Impl;
  const Impl& impl() const { return *impl_; }

 private:
  explicit DistanceGrid(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Reads a DistanceGrid, which must not change while the reader exists. Caches the last leaf read, so
/// consecutive nearby points are fast. Not thread-safe; any number of readers of one grid may be used
/// concurrently.
class DistanceGridReader {
 public:
  explicit DistanceGridReader(const DistanceGrid& grid);
  ~DistanceGridReader();
  DistanceGridReader(DistanceGridReader&&) noexcept;

  float value(int x, int y, int z);
  /// True if the grid point is active; `value` receives its value either way.
  bool active(int x, int y, int z, float& value);
  /// The values of the leaf around a grid point, or null inside a tile.
  const float* leaf_values(int x, int y, int z);
  /// The values at the corners of the voxel with the lowest corner (x, y, z), z fastest.
  void corners(int x, int y, int z, double values[8]);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

struct NamedGrid {
  std::string name;
  DistanceGrid grid;
};

/// The bytes of a .vdb file of level sets whose grid points are positioned by `frame`. OpenVDB gives it a
/// random identifier.
/// \throws std::domain_error if the frame's cells are smaller than OpenVDB's transforms allow
std::string level_sets_to_vdb(std::span<const NamedGrid> grids, const GridFrame& frame);

/// The labels of a stored grid of int32 or int64.
/// \param stored must hold its bytes, which are consumed
/// \throws InputError as read_label_grid()
LabelVolume labels_from_vdb(VdbGrid& stored, std::size_t max_voxels, const std::string& file);

}  // namespace tetwright
