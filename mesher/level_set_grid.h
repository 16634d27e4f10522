#pragma once

// OpenVDB as the level sets use it. Only for the .cpp files that know OpenVDB: no other header includes this.
#include <openvdb/openvdb.h>

#include <array>
#include <span>

#include "common/progress.h"
#include "common/triangle_mesh.h"
#include "common/types.h"
#include "mesher/level_set.h"

namespace tetwright {

using DistanceGrid = openvdb::FloatGrid;
using DistanceTree = DistanceGrid::TreeType;
using DistanceLeaf = DistanceTree::LeafNodeType;
/// Not registered with the tree: cheap to make, for trees that do not change any more.
using DistanceAccessor = openvdb::tree::ValueAccessor<const DistanceTree, false>;

static_assert(leaf_side == DistanceLeaf::DIM && leaf_points == DistanceLeaf::SIZE);

/// Distances below this (finest cells) count as this, so that every grid point has a sign.
inline constexpr double smallest_distance = 1e-6;

struct LevelSet::Impl {
  DistanceGrid::Ptr grid;  ///< in grid coordinates; voxels are active within the band
  TriangleMesh caps;       ///< what closes the surface's holes, in grid coordinates
  std::array<int, 3> cells;
};

/// To be called before anything else of OpenVDB; any number of times.
void initialise_openvdb();

/// How far the grid points are from the triangles (in grid coordinates): voxels nearer than the band are
/// active, all others have the band's width. Throws Interrupted.
DistanceGrid::Ptr unsigned_distances(std::span<const Vec3> points, std::span<const Triangle> triangles,
                                     Progress* progress);

/// Gives all voxels and tiles that are not active the band's size and the sign of the active ones beside
/// them.
void fill_beyond_band(DistanceGrid& grid);

/// Gives tiles alone the size `band` and the sign of the voxels beside them, active or not.
void fill_tiles_beyond_band(DistanceGrid& grid, float band);

}  // namespace tetwright
