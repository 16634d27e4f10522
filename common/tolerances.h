// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Tolerances for rounding, and thresholds below which a value counts as zero. Exact decisions need none:
/// orientations and intersections are exact predicates (common/geometry/predicates.h). Parameters of a
/// method, such as step sizes and fractions of edges, are defined where they are used.
namespace tetwright::tolerance {

// Files.

/// Directions of a volume count as coplanar if the parallelepiped of their unit vectors has less than this
/// volume: far flatter than the gantry tilt of any scanner makes it, far above the rounding of directions
/// stored as floats.
inline constexpr double coplanar_directions = 1e-5;
/// A NIfTI quaternion whose vector part has a squared length above 1 minus this (the rounding of three
/// floats) is a half turn: its real part is 0, and the vector is normalised.
inline constexpr double unit_quaternion = 1e-7;
/// Distances written to .vdb are clamped to the band as floats; a value within this fraction of the band
/// counts as clamped.
inline constexpr float band_share = 1e-5F;

// Shapes.

/// Squared double area of a triangle, relative to the product of the squares of two edges, above which its
/// corners are certainly not collinear: rounding leaves less than 1e-28. Below it an exact predicate decides.
inline constexpr double collinear_squared = 1e-24;
/// Squared volume or area, relative to the squared product of the edges, below which a tet or triangle counts
/// as flat when fields are interpolated: orient3d_value rounds by about 1e-15, and the weights would be
/// noise.
inline constexpr double flat_squared = 1e-28;
/// Subtracted from the quality of a flat or inverted tet (its volume over its longest edge cubed), so that an
/// exactly flat tet is below 0, worse than any positive one.
inline constexpr double inverted_quality = 1e-9;

// Distances, in voxels of the grid unless another unit is given.

/// Minimum distance of a grid point from a surface, so that every grid point has a sign.
inline constexpr double smallest_distance = 1e-6;
/// Lattice units: the distance of a point's own region is at least this much below all others, so that the
/// region is the nearest by value, too.
inline constexpr float smallest_lead = 1e-6F;
/// Offset of grid points, always to the same side, when solid angles are summed: on a surface the rounding of
/// several could add up to anything. Three different numbers, so that no point stays on a plane along the
/// axes or their diagonals.
inline constexpr double aside[3] = {1.1e-5, 1.9e-5, 2.7e-5};
/// Grid points farther than this from the projection of a triangle are certainly not covered by it: the
/// coordinates of its crossings are rounded.
inline constexpr double projected_triangle = 1e-3;
/// Added to the search radius for the distance of a box's centre, so that rounding does not cut off a
/// distance that is needed.
inline constexpr double box_distance = 1e-6;
/// Cells and voxels that differ by less than this coincide, or only touch.
inline constexpr double coinciding_cells = 1e-6;

/// Diagonals of a mesh: a point this near to its tets counts as inside, since the boundary of another mesh of
/// the same body is rounded.
inline constexpr double within_mesh = 1e-6;

/// Working coordinates of the simplifier, whose points lie on a lattice of 2^-30: a point this near to a
/// plane is on it.
inline constexpr double flat_patch = 0x1p-28;

// Steps and iterations.

/// Voxels: a point this near to an interface is on it. Far below the accuracy of the distances.
inline constexpr double on_interface = 1e-3;
/// Lattice units: counterpart of on_interface where cells are far smaller than voxels.
inline constexpr double on_interface_of_cell = 1e-2;
/// Lower bound of the squared gradient of a distance (1 far from ridges) that steps are divided by.
inline constexpr double min_squared_slope = 1e-3;
/// Fraction of the segment to a convex hull's next vertex below which a step ends the search for the hull's
/// shortest vector.
inline constexpr double hull_step = 1e-6;
/// A position is optimal if moving it by its shortest edge raises the worst quality by at most this fraction
/// plus ascent_rounding.
inline constexpr double ascent_share = 1e-3;
inline constexpr double ascent_rounding = 1e-9;
/// A mesh at its target counts as larger by this fraction, so that the schedule's logarithm is not 0.
inline constexpr double at_target = 1e-9;
/// Diagonals: gap at which the bounds of a SurfaceDeviation are near enough where 1 % of it would be less.
inline constexpr double deviation_share = 1e-6;

}  // namespace tetwright::tolerance
