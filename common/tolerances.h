// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Tolerances for rounding, and thresholds below which a value counts as zero. Exact decisions need none:
/// orientations and intersections are exact predicates (common/geometry/predicates.h). Parameters of a
/// method, such as step sizes and fractions of edges, are defined where they are used.
namespace tetwright::tolerance {

// Files.

/// Directions of a volume count as coplanar if the parallelepiped of their unit vectors has a volume below
/// this: far flatter than any scanner's gantry tilt makes it, but far above the rounding of directions stored
/// as floats.
inline constexpr double coplanar_directions = 1e-5;
/// A NIfTI quaternion whose vector part has a squared length above 1 minus this (the rounding of three
/// floats) is treated as a half turn: its real part is 0, and the vector is normalised.
inline constexpr double unit_quaternion = 1e-7;
/// Distances written to .vdb are clamped to the band as floats; a value within this fraction of the band
/// counts as clamped.
inline constexpr float band_share = 1e-5F;

// Shapes.

/// Minimum of the square of a triangle's doubled area, relative to the product of the squares of two edges,
/// for its corners to be certainly not collinear: rounding alone gives less than 1e-28. Below it an exact
/// predicate decides.
inline constexpr double collinear_squared = 1e-24;
/// Squared volume or area, relative to the squared product of the edges, below which a tet or triangle counts
/// as flat when fields are interpolated. orient3d_value rounds by about 1e-15, so the weights would be mostly
/// rounding error.
inline constexpr double flat_squared = 1e-28;
/// Subtracted from the quality of a flat or inverted tet (its volume divided by its longest edge cubed), so
/// that an exactly flat tet is below 0 and worse than any positive one.
inline constexpr double inverted_quality = 1e-9;

// Distances, in voxels of the grid unless another unit is given.

/// Minimum distance of a grid point from a surface, so that every grid point has a sign.
inline constexpr double smallest_distance = 1e-6;
/// Lattice units: minimum difference between the distance of a point's own region and all other distances, so
/// that its own region is also the nearest by value.
inline constexpr float min_region_gap = 1e-6F;
/// Offset of grid points, always in the same direction, when solid angles are summed: on a surface, rounding
/// of several angles could add up to any value. The three components differ, so that no point stays on a
/// plane along the axes or their diagonals.
inline constexpr double winding_offset[3] = {1.1e-5, 1.9e-5, 2.7e-5};
/// Grid points farther than this from the projection of a triangle are certainly outside it: the coordinates
/// of its crossings are rounded.
inline constexpr double projected_triangle = 1e-3;
/// Added to the search radius for the distance of a box's centre, so that rounding does not exclude a
/// required distance.
inline constexpr double box_distance = 1e-6;
/// Cells and voxels count as coinciding, or as only touching, if they differ by less than this.
inline constexpr double coinciding_cells = 1e-6;

/// Diagonals of a mesh: a point this close to its tets counts as inside, since the boundary of another mesh
/// of the same body is rounded.
inline constexpr double within_mesh = 1e-6;

/// Working coordinates of the simplifier, whose points lie on a lattice of spacing 2^-30: a point this close
/// to a plane counts as lying on it.
inline constexpr double flat_patch = 0x1p-28;

// Steps and iterations.

/// Voxels: a point this close to an interface counts as lying on it. Far below the accuracy of the distances.
inline constexpr double on_interface = 1e-3;
/// Lattice units: counterpart of on_interface for cells far smaller than voxels.
inline constexpr double on_interface_of_cell = 1e-2;
/// Lower bound of the squared gradient of a distance (1 far from ridges) when a step is divided by it.
inline constexpr double min_squared_slope = 1e-3;
/// Search for the shortest vector of a convex hull: fraction of the segment to the next vertex below which a
/// step ends the search.
inline constexpr double hull_step = 1e-6;
/// A position is optimal if moving it by its shortest edge would raise the worst quality by at most this
/// fraction plus ascent_rounding.
inline constexpr double ascent_share = 1e-3;
inline constexpr double ascent_rounding = 1e-9;
/// A mesh that has its target number of tets counts as larger by this fraction, so that the schedule's
/// logarithm is not 0.
inline constexpr double at_target = 1e-9;
/// Diagonals: minimum gap between the bounds of a SurfaceDeviation; it applies if
/// relative_deviation_accuracy, 1 %, would ask for less.
inline constexpr double deviation_share = 1e-6;

}  // namespace tetwright::tolerance
