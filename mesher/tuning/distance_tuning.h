// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace tetwright {

/// Items that a parallel loop hands out at a time: enough to outweigh the handing out, few enough to keep
/// all threads busy to the end. Areas of thin walls are added up in these blocks, which decides their
/// rounding.
struct DistanceGrains {
  static constexpr std::size_t elements = 4096;          ///< points and triangles, some nanoseconds each
  static constexpr std::size_t sampled_voxels = 512;     ///< a microsecond or more each
  static constexpr std::size_t sheet_points = 1024;      ///< mostly far from all sheets
  static constexpr std::size_t cells_of_regions = 1024;  ///< whose regions are looked up
  static constexpr std::size_t marched_voxels = 2048;    ///< of an expected solid
  static constexpr std::size_t cap_cells = 256;          ///< with their corners and edges
  static constexpr std::size_t measured_voxels = 256;    ///< each shrinks balls
  static constexpr std::size_t crease_segments = 256;    ///< each needs queries of trees
  static constexpr std::size_t band_leaves = 16;         ///< 512 grid points each
  static constexpr std::size_t leaves = 64;              ///< or grid points that need a few reads each
  static constexpr std::size_t depth_boxes = 64;         ///< split further
  static constexpr std::size_t depth_leaves = 16;        ///< with exact distances
  static constexpr std::size_t sided_components = 64;    ///< two winding numbers each
};

/// Signed distances of surfaces and their thin parts; mesher/README.md, Tuned numbers, explains the terms.
struct DistanceTuning {
  /// Projection onto the points where regions meet, by Newton steps.
  struct Projection {
    /// Max steps: trades time for points near kinks of the distance.
    static constexpr int steps = 8;
    /// Min squared slope, as a share of the expected one's square. Below this the point is near a ridge of
    /// the distance.
    static constexpr double min_slope_share = 0.1;
    /// Damping (Levenberg 1944), as a share of the same square: on one side of a junction curve two of the
    /// distances may be the same function, so their difference has no slope there and must not contribute.
    static constexpr double damping_share = 0.01;
  };

  /// Sheets between surfaces of several bodies.
  struct Sheets {
    /// Cells. A sheet at least this thick never tears: wherever it lies, a lattice point is inside (the
    /// guide, Regions).
    static constexpr double min_cells = 1.5;
    /// Cosine between the surfaces' gradients below which the region between them is a sheet. Otherwise it is
    /// a wedge, which is thin at its edge in cells of any size.
    static constexpr double max_cosine = -0.95;
    /// Cosine above which a wedge between materials gets no smaller cells at its edge: its angle is larger
    /// than 37 degrees. Corners and interfaces of eight sectors are right without them, in less than half of
    /// the time.
    static constexpr double max_wedge_cosine = -0.8;
    /// Thinner sheets (voxels) are gaps between two faces meant to coincide.
    static constexpr double min_thickness = 0.1;
    /// Surfaces of two bodies that face each other (cosine below `contact_cosine`) and are closer than this
    /// (voxels) count as one (the guide, Regions). Common faces of bodies are accurate to a few hundredths of
    /// a voxel, near sharp edges to a few tenths, so slivers of another region between them would be noise.
    static constexpr double contact = 0.4, contact_cosine = -0.7;
    /// Depth below a surface at which the region behind it is looked up, voxels: far below `min_thickness`.
    static constexpr double depth = 1e-3;
  };

  /// Parts reported as too thin.
  struct ThinParts {
    /// Distances from an interface, voxels, at which the region is identified and to which it must extend.
    static constexpr double identified_at = 0.25, thick_at = 2;
    /// Max cosine between the normals of two interfaces that face each other. Otherwise they form a wedge,
    /// which is thin at its edge in cells of any size.
    static constexpr double max_cosine = -0.5;
  };

  /// Holes of surfaces and the caps that close them.
  struct Caps {
    /// Area of caps, as a share of the surface's, above which they are no walls. Caps of a box without its
    /// lid and a side have .35, and need cells of their own where they meet it at sharp angles; those of a
    /// rough terrain have .57, and are so near all of it that this takes ten times the cells.
    static constexpr double max_wall_share = 0.5;
    /// Points with at least this generalised winding number are inside: one half plus more than the rounding
    /// error, so that the back of a flat sheet is consistently outside.
    static constexpr double inside_winding = 0.5001;
    /// Triangles at least this far from all caps, voxels, do not meet the surface where winding numbers cross
    /// 1/2, which caps follow to a fraction of a voxel.
    static constexpr double clear_distance = 1;
    /// Error of distances near the surface, voxels (the guide, Signed distances).
    static constexpr double distance_error = 0.02;
    /// Min distance of a crossing from both ends of its edge, as a share of the edge, so that no cap triangle
    /// has zero area.
    static constexpr double min_share = 0.02;
    /// Max rounds. Each cap is followed to its end, so later rounds cap only where the band of a cap extends
    /// into another inside region.
    static constexpr int rounds = 4;
  };

  /// Distances and thicknesses by the triangles themselves.
  struct Triangles {
    static constexpr std::size_t leaf_size = 4;  ///< triangles in a leaf of the tree: trades memory for tests
    /// Max steps of a shrinking ball. Shrinking converges quadratically where walls are flat, usually within
    /// three steps.
    static constexpr int max_shrinks = 16;
    /// The ball has stopped shrinking when its radius changes by less than this fraction.
    static constexpr double min_shrink = 1e-6;
    /// Squared distances count as equal within this fraction: differences from rounding of coordinates are
    /// smaller, for distances down to a thousandth of a voxel.
    static constexpr double tie = 1e-9;
    /// Distance in front of and behind a surface point at which its sides are tested, voxels.
    static constexpr double side_distance = 1e-4;
    /// A triangle tells on which side of the surface a point is if it is at least this high, the point is at
    /// least this far away (voxels), and the squared sine of the angle between the triangle's plane and the
    /// direction to the point is at least the last: rounding of coordinates changes all three far less.
    static constexpr double min_height = 1e-6, min_side_distance = 1e-3, min_side_share = 1e-6;
  };

  /// Thin walls and gaps of one surface. The guide, Thin walls, has the method; Measurements, Thin walls, has
  /// the results.
  struct Walls {
    /// Thinnest walls and gaps that a lattice resolves, cells: wherever they lie, a lattice point is inside.
    static constexpr double min_shown_cells = 1.25;
    /// Negated max cosines between the normals of facing walls. The first is for changing distances (wedges
    /// of up to about 70 degrees tear as well), the second for choosing cells, the third for reports and for
    /// cells more than three levels down (within 8 degrees of parallel, since tips of wedges are thin in
    /// cells of any size).
    static constexpr double facing_to_change = 0.3, facing_to_refine = 0.9, facing_to_report = 0.99;
    /// Distances come from the triangles where a wall or gap is thinner than this, voxels: interpolation
    /// between grid points is accurate only if each wall has two voxels of its own, in any direction.
    static constexpr double exact_below = 2.5;
    /// Tolerance, voxels, within which distances on voxels must be as expected to rule out thin walls. Larger
    /// values save measurements but miss walls.
    static constexpr double trusted = 0.3;
    /// Cosine between the direction to the closest point and its normal below which that point is on the rim
    /// of a gap.
    static constexpr double min_alignment = 0.7;
    /// Min negated cosine between the directions from a point to the walls on both sides: within 18 degrees
    /// of opposite (the guide, Thin walls). It is smaller in front of the mouth of a wide gap.
    static constexpr double min_opposition = 0.95;
    /// Max steps from a narrow face to an adjacent wall. The narrow face at a corner of a rim is next to
    /// another narrow face.
    static constexpr int max_steps_beside = 2;
  };

  /// Depths of cells in thin walls and gaps.
  struct WallCells {
    /// Depth to which cells are counted before any decision; deeper ones are extrapolated. Each level takes
    /// four times as long to count.
    static constexpr int counted_depth = 3;
    /// A region with fewer thin voxels than the first value is a fold or a particle smaller than a cell and
    /// is not refined. One with fewer cells too thin for counted_depth than the second is not refined beyond
    /// that depth.
    static constexpr std::size_t min_thin_voxels = 4, min_deep_cells = 64;
    /// A further halving of cells at gaps must leave at most this share of the area closed that was closed
    /// before it: ends of gaps alone open by a few percent at each.
    static constexpr double max_left_closed = 0.75;
    /// Dense tets per finest cell that contains a surface (1.7 cells per squared cell of area). A wall has
    /// such cells on both sides and little else; a gap has a thick part on both sides. Fitted to plates and
    /// gaps.
    static constexpr double tets_per_wall_cell = 8, tets_per_gap_cell = 17;
    /// Number of tets that fill a wall, per squared thickness of its area. A plate of 100 x 100 x 1
    /// simplified to 7,000 tets has 0.5 % of them below 0.1 sr, simplified to 8,000 none (computed areas are
    /// 15 % too large).
    static constexpr double filling_tets_per_area = 0.66;
  };

  /// Cells where creases are close to each other (the guide, Fitting creases).
  struct NarrowPatches {
    /// Cells that should span the width of a patch.
    static constexpr double cells_to_width = 2;
    /// Creases whose distance is below this fraction of their distance from a common corner are narrow;
    /// others merely meet there.
    static constexpr double corner_share = 0.4;
    /// Spacing of the points tested along a crease, voxels: smaller values find narrower patches and take
    /// longer.
    static constexpr double spacing = 0.5;
    /// Approximate number of dense tets for each split cell: half of its eight parts are inside.
    static constexpr double tets_of_split = 42;
  };
};

}  // namespace tetwright
