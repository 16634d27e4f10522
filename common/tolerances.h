#pragma once

/// Every number that allows for rounding, or below which something counts as zero. What can be decided
/// exactly has none: orientations and intersections are exact predicates (common/geometry/predicates.h).
/// Parameters of the method, such as the sizes of steps and shares of edges, are where they are used.
namespace tetwright::tolerance {

// Files.

/// Directions of a volume count as coplanar if the parallelepiped of their unit vectors has less than this
/// volume: far flatter than the gantry tilt of any scanner makes it, far above the rounding of directions
/// stored as floats.
inline constexpr double coplanar_directions = 1e-5;
/// The squared length of a NIfTI quaternion's vector part may exceed 1 by the rounding of three floats.
inline constexpr double unit_quaternion = 1e-7;
/// Distances written to .vdb are cut off at the band in floats; within this share of it they count as cut
/// off.
inline constexpr float band_share = 1e-5F;

// Shapes.

/// Twice the area of a triangle, squared and relative to the squares of two edges, above which it is surely
/// no line: rounding leaves less than 1e-28. Below it an exact predicate decides.
inline constexpr double collinear_squared = 1e-24;
/// Volume or area, squared and relative to the edges' product, below which a tet or triangle counts as flat
/// in the transfer of fields: the rounding of orient3d_value is about 1e-15, and below it weights would be
/// noise.
inline constexpr double flat_squared = 1e-28;
/// By so much the quality of an inverted or flat tet lies below 0, as a share of its longest edge cubed: a
/// tet that is exactly flat must count as worse than any that is not.
inline constexpr double inverted_quality = 1e-9;

// Distances, in finest cells (voxels).

/// Surfaces smaller than this are not looked at: nothing of them could be meshed.
inline constexpr double min_surface_size = 1e-6;
/// Distances of grid points from a surface are at least this, so that every grid point has a sign.
inline constexpr double smallest_distance = 1e-6;
/// By so much a point's own distance leads where two are equal, so that its region is the nearest by value
/// too.
inline constexpr float smallest_lead = 1e-6F;
/// A grid point on a surface counts as if it lay this much aside, when solid angles are summed: the rounding
/// of several could add up to anything. Three different numbers, so that the point does not move along a face
/// or an edge of the grid.
inline constexpr double aside[3] = {1.1e-5, 1.9e-5, 2.7e-5};
/// Grid points farther than this from the projection of a triangle are surely not covered by it: the
/// coordinates of its crossings are rounded.
inline constexpr double projected_triangle = 1e-3;
/// Distances of boxes' middles are rounded by less than this; a box is ruled out only by more.
inline constexpr double box_distance = 1e-6;
/// Two cells and voxels coincide, or only touch, if they do within this.
inline constexpr double coinciding_cells = 1e-6;

// Where an iteration ends.

/// A point is on an interface if it is this near, finest cells: far below the accuracy of the distances.
inline constexpr double on_interface = 1e-3;
/// Below this squared slope of a distance (1 far from ridges) steps along it are not scaled up further.
inline constexpr double min_squared_slope = 1e-3;
/// The shortest vector of a convex hull is found if the next step is less than this share of the way.
inline constexpr double hull_step = 1e-6;
/// A position is optimal if the worst quality would rise by less than this share of itself over a whole edge,
/// or by less than rounding makes of it.
inline constexpr double ascent_share = 1e-3;
inline constexpr double ascent_rounding = 1e-9;
/// A mesh that is at its target counts as larger by this share, so that the schedule's logarithm is not 0.
inline constexpr double at_target = 1e-9;

}  // namespace tetwright::tolerance
