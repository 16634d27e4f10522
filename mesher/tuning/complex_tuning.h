// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace tetwright {

/// Items that a parallel loop hands out at a time: enough to outweigh the handing out, few enough to keep
/// all threads busy to the end.
struct ComplexGrains {
  static constexpr std::size_t pairs = 2048;  ///< of triangles, compared with each other
  static constexpr std::size_t divided = 64;  ///< triangles divided into parts
};

/// Surfaces that meet; mesher/README.md, Tuned numbers, explains the terms.
struct ComplexTuning {
  struct Contact {
    /// Bodies must be larger than this, in tolerances, or little would be left of them.
    static constexpr double min_body = 10;
    /// Volume that moves within the tolerance may change, in tolerances times the area of a body's contacts,
    /// and of all of it: triangles beside contacts tilt when their points move.
    static constexpr double moved_contact = 1.1, moved_area = 0.2;
    /// Gaps and overlaps below this, in tolerances, are rounding.
    static constexpr double min_gap = 1e-6;
  };

  struct Imprint {
    /// Boxes of triangles grow by this, in tolerances: points move by up to one in each round.
    static constexpr double box_margin = 2;
    /// Rounds until two surfaces have only points and edges in common: two to four in general, more where a
    /// tolerance is near the size of facets, and never ending where it is above it.
    static constexpr int max_rounds = 16;
    /// Further rounds, in which only triangles go that are flat or turned over: one after the other where
    /// they form a fan.
    static constexpr int max_clean_rounds = 16;
    /// Round from which triangles flatter than the tolerance go first: without them it needs two to four.
    static constexpr int first_round_of_slivers = 4;
    /// Limits of new points: in any case, and for each pair of triangles whose boxes meet at first. Crossing
    /// surfaces need about two for each pair that crosses. A tolerance near the size of facets makes their
    /// number grow sixfold in a round, without end.
    static constexpr double max_new_points = 2000, points_per_pair = 8;
    /// Pairs of triangles found between two looks at memory and cancellation: some milliseconds of work.
    static constexpr std::size_t pairs_between_checks = 1 << 17;
    /// Bytes at the peak for each pair of triangles, and for each point that a round puts on an edge or into
    /// a triangle, with all that follows from it: one and a half times what 300 to 20,000 crossing triangles
    /// at random took.
    static constexpr double bytes_per_pair = 60, bytes_per_event = 1000;
    /// Bytes at the peak for each triangle, met or not.
    static constexpr double bytes_per_triangle = 200;
    /// Squared distance, in squared tolerances, beyond which a point that another step of the same round has
    /// moved is no longer put on an edge.
    static constexpr double moved_away = 4;
    /// Squared sine of the angle between segments below which they count as parallel: rounding alone gives
    /// 1e-16.
    static constexpr double parallel = 1e-12;
    /// A triangle whose height is below this, in tolerances, is flat: its sides could not be told apart. With
    /// the default tolerance 1e-9 diagonals, far above rounding.
    static constexpr double flat_share = 1e-4;
    /// Height up to which a triangle that moves of points have turned over is removed, tolerances: a point
    /// may move by one, and an edge beside it, too.
    static constexpr double fold_reach = 2;
    /// Common points of two triangles lie on the line in which their planes cross within this, in tolerances.
    static constexpr double line_reach = 3;
  };

  /// Contacts for which a body adopts triangles of an earlier one.
  struct Adoption {
    /// Distances of what is laid on a surface or adopted, tolerances: all of it is within one, and the ends
    /// of segments move by up to one along the surface.
    static constexpr double reach = 3;
    /// Least area of a contact, squared tolerances: smaller ones are left to the imprint.
    static constexpr double min_area = 16;
    /// Distance within which what is laid on a surface joins its points and edges, tolerances: smaller ones
    /// make thinner triangles, larger ones kinks in the border of a contact.
    static constexpr double snap = 0.25;
    /// A segment runs through points of the surface within this distance, unless thin triangles lie between;
    /// then within this share of it, and so on.
    static constexpr double snap_step = 0.25;
    static constexpr int snap_steps = 4;
    /// Least distance between points on an edge, as a share of it: twice what their division can tell apart
    /// (TriangleSubdivision::add_on_edge()).
    static constexpr double min_share = 2e-12;
  };

  struct Cells {
    /// Bytes at the peak for each triangle while cells are found and labelled, with what imprinting leaves.
    static constexpr double bytes_per_triangle = 600;
    static constexpr std::size_t leaf_size = 4;  ///< of the tree of triangles
    /// A cell joins a neighbour if its volume is below this, in tolerances times the area around it: a slab
    /// of half the tolerance, whose area counts twice.
    static constexpr double thin_share = 0.25;
  };

  /// Where regions are decided by the triangles.
  struct Zone {
    /// Triangles in a leaf of the tree. Among equally near triangles some results depend on the order of the
    /// tree.
    static constexpr std::size_t leaf_size = 4;
    /// Distance from contacts and junctions, voxels: the band of the level sets, within which distances are
    /// interpolated.
    static constexpr double reach = 3;
    /// Squared distances that differ by less than this share are equal: rounding of the nearest points of two
    /// triangles with a common edge.
    static constexpr double tie = 1e-9;
    /// Points closer to a sheet than this, voxels, are on it: rounding of coordinates of up to some thousand
    /// voxels.
    static constexpr double on_sheet = 1e-9;
    /// Voxels. A region between two others that is thinner gives way to one of them: one that is thicker has
    /// a lattice point wherever it lies (as DistanceTuning::Walls::min_shown_cells). Cells are smaller where
    /// materials are thin, down to an eighth (DomainTuning::Refinement::max_levels).
    static constexpr double min_thickness = 1.25, min_refined_thickness = min_thickness / 8;
    /// Thickness below which the outside gives way at a line in which bodies touch, voxels; it falls to
    /// nothing at `reach`. Between faces at right angles the bodies are then joined over 1.5 voxels on either
    /// side: over less the strip tears.
    static constexpr double touching_thickness = 2.8;
    /// Distance over which narrow parts are looked for, voxels: that of sheets that need smaller cells
    /// (DistanceTuning::Sheets::min_cells).
    static constexpr double widest_narrow = 1.5;
    /// By how much a region gives way for each voxel that its thickness lacks: steeper rims tear less but
    /// give more volume away; at parallel faces a region is gone at 80 % of the thickness at which it begins
    /// to give way.
    static constexpr double slope = 4;
    /// Cosines between gradients. Regions give way between surfaces that face each other at less than 45
    /// degrees, entirely at less than 37 degrees.
    static constexpr double facing = -0.7, facing_entirely = -0.8;
  };

  /// Where points have a side of a sheet.
  struct Sheets {
    /// Voxels this far from a sheet, voxels, are cells of their own: all edges that cross the sheet then join
    /// points of such cells.
    static constexpr double fine_cells = 0.75;
    /// Distance from a sheet up to which points have a side, voxels: both ends of an edge of such cells that
    /// crosses the sheet, also where they have moved.
    static constexpr double reach = 1.75;
    /// Length of the strips that continue sheets beyond their borders, voxels: the reach, also at corners
    /// where the gap between two strips is filled by chords.
    static constexpr double continued = 2 * reach;
    /// Beyond the end of a curve in which sheets meet by more than this, voxels, there is no curve: half the
    /// distance of points on it.
    static constexpr double beyond_curve = 0.25;
  };
};

}  // namespace tetwright
