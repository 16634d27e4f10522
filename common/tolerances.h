// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Numbers that allow for rounding, or below which something counts as zero. What can be decided exactly has
/// none: orientations and intersections are exact predicates (common/geometry/predicates.h). Parameters of a
/// method, such as the sizes of steps and shares of edges, are where they are used.
namespace tetwright::tolerance {

// Files.

/// Directions of a volume count as coplanar if the parallelepiped of their unit vectors has less than this
/// volume: far flatter than the gantry tilt of any scanner makes it, far above the rounding of directions
/// stored as floats.
inline constexpr double coplanar_directions = 1e-5;
/// A NIfTI quaternion whose vector part has a squared length above 1 minus this (the rounding of three
/// floats) is a half turn: its real part is 0, and the vector is normalised.
inline constexpr double unit_quaternion = 1e-7;
/// Distances written to .vdb are cut off at the band in floats; within this share of it they count as cut
/// off.
inline constexpr float band_share = 1e-5F;

// Shapes.

/// Twice the area of a triangle, squared and relative to the product of two edges' squares, above which its
/// corners are surely not on one line: rounding leaves less than 1e-28. Below it an exact predicate decides.
inline constexpr double collinear_squared = 1e-24;
/// Volume or area, squared and relative to the edges' product, squared too, below which a tet or triangle
/// counts as flat where fields are interpolated: the rounding of orient3d_value is about 1e-15, and below it
/// weights would be noise.
inline constexpr double flat_squared = 1e-28;
/// Subtracted from the quality of a tet that is flat or inverted (its volume over its longest edge cubed), so
/// that a tet that is exactly flat is below 0, worse than any positive one.
inline constexpr double inverted_quality = 1e-9;

// Distances, in voxels of the grid unless another unit is given.

/// Distances of grid points from a surface are at least this, so that every grid point has a sign.
inline constexpr double smallest_distance = 1e-6;
/// In lattice units: the distance of a point's own region is at least this much below all others, so that the
/// region is the nearest by value too.
inline constexpr float smallest_lead = 1e-6F;
/// Grid points count as if they lay this much to one side, all the same way, when solid angles are summed: on
/// a surface the rounding of several could add up to anything. Three different numbers, so that no point
/// stays on a plane along the axes or their diagonals.
inline constexpr double aside[3] = {1.1e-5, 1.9e-5, 2.7e-5};
/// Grid points farther than this from the projection of a triangle are surely not covered by it: the
/// coordinates of its crossings are rounded.
inline constexpr double projected_triangle = 1e-3;
/// The radius of the search for the distance of a box's middle is lengthened by this, so that rounding does
/// not cut off a distance that is needed.
inline constexpr double box_distance = 1e-6;
/// Cells and voxels that differ by less than this coincide, or only touch.
inline constexpr double coinciding_cells = 1e-6;

/// In diagonals of a mesh: a place this near to its tets counts as in them, since the boundary of another
/// mesh of the same body is rounded.
inline constexpr double within_mesh = 1e-6;

/// In working coordinates of the simplifier, where points are on a lattice of 2^-30: this far from a plane
/// they are on it.
inline constexpr double flat_patch = 0x1p-28;

// Steps and iterations.

/// A point is on an interface if it is this near, in voxels: far below the accuracy of the distances.
inline constexpr double on_interface = 1e-3;
/// The same in lattice units, where cells are far smaller than voxels.
inline constexpr double on_interface_of_cell = 1e-2;
/// Below this squared slope of a distance (1 far from ridges) steps along it are not scaled up further.
inline constexpr double min_squared_slope = 1e-3;
/// The shortest vector of a convex hull is found if the next step is less than this share of the way.
inline constexpr double hull_step = 1e-6;
/// A position is optimal if, over its shortest edge, the worst quality would rise by no more than this share
/// of itself plus ascent_rounding.
inline constexpr double ascent_share = 1e-3;
inline constexpr double ascent_rounding = 1e-9;
/// A mesh that is at its target counts as larger by this share, so that the schedule's logarithm is not 0.
inline constexpr double at_target = 1e-9;
/// Bounds of a SurfaceDeviation are this near to each other, in diagonals, where 1 % of it would be less.
inline constexpr double deviation_share = 1e-6;

}  // namespace tetwright::tolerance
