#pragma once

// OpenVDB types of level sets. To be included by .cpp files only, so that no other header depends on OpenVDB.
#include <openvdb/openvdb.h>

#include <array>
#include <span>

#include "common/progress.h"
#include "common/triangle_mesh.h"
#include "common/types.h"
#include "mesher/distance/level_set.h"

namespace tetwright {

using DistanceGrid = openvdb::FloatGrid;
using DistanceTree = DistanceGrid::TreeType;
using DistanceLeaf = DistanceTree::LeafNodeType;
/// An accessor that is not registered with its tree: cheap to construct, for trees that do not change any
/// more.
using DistanceAccessor = openvdb::tree::ValueAccessor<const DistanceTree, false>;

static_assert(leaf_side == DistanceLeaf::DIM && leaf_points == DistanceLeaf::SIZE);

/// Smaller distances (voxels) are raised to this, so that every grid point has a sign.
inline constexpr double smallest_distance = 1e-6;

struct LevelSet::Impl {
  DistanceGrid::Ptr grid;  ///< in grid coordinates; voxels are active within the band
  TriangleMesh caps;       ///< what closes the surface's holes, in grid coordinates
  std::array<int, 3> cells;
};

/// Must be called before any other function of OpenVDB; may be called repeatedly and concurrently.
void initialise_openvdb();

/// Unsigned distances of grid points from triangles in grid coordinates: voxels within the band are active,
/// all others have the width of the band. Throws Interrupted.
DistanceGrid::Ptr unsigned_distances(std::span<const Vec3> points, std::span<const Triangle> triangles,
                                     Progress* progress);

/// Sets all inactive voxels and tiles to the width of the band, with the sign of the adjacent active voxels.
void fill_outside_band(DistanceGrid& grid);

/// Sets tiles only to `band`, with the sign of the adjacent voxels, active or not.
void fill_tiles_outside_band(DistanceGrid& grid, float band);

}  // namespace tetwright
