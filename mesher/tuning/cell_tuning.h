// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace tetwright {

/// Items that a parallel loop hands out at a time: enough to outweigh the handing out, few enough to keep
/// all threads busy to the end.
struct CellGrains {
  static constexpr std::size_t elements = 1 << 14;     ///< of the mesh, copied into input units
  static constexpr std::size_t tets = 1 << 13;         ///< whose orientation is tested
  static constexpr std::size_t compared_points = 256;  ///< each needs a query of a tree
};

/// The choice of cells, and what cells can resolve; mesher/README.md, Tuned numbers, explains the terms.
struct CellTuning {
  /// Cells for a target number of tets.
  struct TargetCount {
    /// Dense tets per target tet: fewer leave the simplifier no choice, more take time. With 28 instead of
    /// 40, six scans at 10,000 tets (three seeds each) take 0.89 of the time at 0.99 of the rms distance, but
    /// one gets a handle where its parts are near each other, and a knot of 3,000 tets loses 1.1 % of its
    /// volume. With 20, four of the scans are 3 to 10 % further from the surface.
    static constexpr double surface_dense_per_target = 40, label_dense_per_target = 5;
    /// Likewise for surfaces with creases. Their patches may be narrower than a cell, and features that cells
    /// do not resolve are lost. Nine parts were meshed at 10,000 tets: with 100 instead of 40, the two with
    /// strips of half a cell have half and a third of the distance from creases (99th percentile), and lose
    /// no corners (Measurements, Creases).
    static constexpr double creased_dense_per_target = 100;
    static constexpr double max_dense_tets = 20e6;  ///< bounds time and memory
    static constexpr int min_resolution = 32;       ///< trades time for details
    /// Max lattice tets along the surface per target dense tet: flat bodies have few dense ones.
    static constexpr double max_lattice_per_dense = 4;
    /// Smallest cells used for thin layers, in cells: DomainTuning::Refinement::max_levels halvings.
    static constexpr double min_refined = 0.125;
  };

  /// Bricks of a volume.
  struct Bricks {
    /// Voxels around a brick whose points are moved with its own. Moves farther away rarely affect it.
    static constexpr int halo = 8;
  };

  /// Cells of labels for a target number of tets.
  struct LabelCells {
    /// Dense tets per face between two materials, as large as a squared cell; half as many per face to the
    /// outside. Fitted to volumes.
    static constexpr double tets_per_face = 45;
    /// Finer cells resolve no more of the voxels.
    static constexpr int max_per_voxel = 4;
    /// Cells larger than a voxel, in voxels, largest first: powers of two, so that halved ones align with
    /// voxels. Larger ones, halved three times, would not resolve a single voxel.
    static constexpr std::array<int, 2> large_cells{4, 2};
    /// Largest cells beside bodies in a volume, voxels: implants are often as thin as a few voxels.
    static constexpr double max_with_bodies = 2;
    /// Dense tets per target tet with cells this large. They are used only if they give at most this fraction
    /// of the dense tets of voxel-sized cells: where labels are thin, cells are halved anyway, and too little
    /// would be saved (Measurements, Cells of labels).
    static constexpr double large_cells_dense_per_target = 20, max_share_of_voxel_cells = 0.5;
    /// A ball of this many large cells loses 1 % of its volume to chords: measured, 0.27 (cell / radius)^2.
    /// Labels of few voxels change more by smoothing.
    static constexpr double min_cells_of_part = 590, few_voxels = 1000;
    /// Whole cells fill the volume along each axis, so cells larger than this multiple of its shortest side
    /// would be flat. They shrink to that, but not below this fraction of the size required.
    static constexpr double max_side_share = 1.5, min_share_of_wanted = 0.25;
  };

  /// Cells for target edge lengths.
  struct TargetLengths {
    /// Size of dense cells per target edge length: 1 / 2.5, so that the simplifier has a choice.
    static constexpr double cell_per_edge = 0.4;
    /// Max size of interior cells per target edge length. Cells are halved until they are within it, so their
    /// mean is about half of it.
    static constexpr double inner_cell_per_edge = 0.8;
    /// Max cells along the longest side. Where smaller cells are required, cells are halved and edges split.
    static constexpr double max_resolution = 256;
    /// Number of points on each surface at which sizes are evaluated: more take longer and find smaller spots
    /// of short target lengths.
    static constexpr double samples = 20000;
  };

  /// Cells for a tolerance. Measurements, Tolerance, has the results.
  struct ToleranceCells {
    /// The fraction of a tolerance that a dense mesh may use up: the rest is the simplifier's.
    static constexpr double dense_share = 0.5;
    /// Initial cell size, in tolerances, for smooth surfaces, which it brings within half a tolerance, and
    /// for surfaces with creases, whose flat faces need no smaller cells.
    static constexpr double first_cell = 2, first_cell_of_part = 12;
    static constexpr int min_resolution = 64;  ///< trades time for details
    /// Distance within which surface and mesh correspond: cells, or tolerances if that is more.
    static constexpr double reach_cells = 2, reach_tolerances = 2;
    /// Max rounds that halve cells locally, and max rounds that do not reduce the largest distance.
    static constexpr int max_fine_rounds = 4, max_worse_rounds = 2;
    /// Fraction of the tolerance that is good enough once halving cells locally gains no more: the simplifier
    /// can still keep samples within the tolerance. Otherwise all cells become smaller.
    static constexpr double enough_share = 0.8;
    /// Factor on the resolution where all cells become smaller, and max number of meshes made.
    static constexpr double resolution_growth = 1.5;
    static constexpr int max_attempts = 12;
    /// Smaller cells must reduce the largest distance below this fraction: it does not shrink at the border
    /// of a hole.
    static constexpr double min_level_gain = 0.9;
  };

  /// Thin walls and gaps (the guide, Thin walls, Choose depths).
  struct WallBudget {
    /// Max number of tets that thin walls and gaps may add, or the number of tets without them if that is
    /// larger. A plate a thousandth as thick as wide takes 3.3 to 5.8 million (Measurements, Thin walls).
    static constexpr double max_added_tets = 8e6;
    static constexpr double min_cheap_tets = 1e6;  ///< adding this many tets always counts as cheap
    /// Max MesherOptions::min_gap and min_thickness, cells: closing and omitting measure cell by cell around
    /// each point of the surface.
    static constexpr double max_limit_cells = 16;
    /// Factor on the number of well-shaped tets that fill a thin wall, if its rims stay sharp.
    static constexpr double filling_with_creases = 1.5;
  };

  /// Sheets inside a body that face each other.
  struct NarrowSheets {
    static constexpr double cells_between = 2;  ///< as between the creases of a narrow patch
    static constexpr double max_ratio = 256;    ///< cells are halved at most eight times
    static constexpr double facing = 0.7;       ///< cosine: 45 degrees, as for regions that give way
    /// Samples along a triangle: more are finer than any cells that fit in memory.
    static constexpr double max_samples = 4096;
    static constexpr std::size_t grain = 64;  ///< triangles that a loop hands out at a time
  };

  /// Faces that close holes.
  struct Caps {
    static constexpr double min_area = 8;  ///< squared cells: smaller holes have hardly any faces
    /// Max difference, in diagonals, of the distances from surface and cap at which a face still belongs to
    /// the cap: above rounding, far below the size of faces.
    static constexpr double near = 1e-9;
    /// Likewise where surfaces were joined within the contact tolerance: twice its default.
    static constexpr double near_joined = 2e-5;
    /// Cosine between the normals of a flat cap and its faces: 60 degrees, as the faces of its neighbours may
    /// be as near.
    static constexpr double min_facing = 0.5;
  };

  /// Creases that the mesh cannot have: at closed gaps they would lie inside the solid, and where bodies that
  /// are not joined meet or a surface crosses itself the mesh is accurate to half a cell only.
  struct GivenUp {
    /// Distance, cells, within which creases are given up: half a cell for the position of such a curve, and
    /// room for well-shaped tets between it and a crease that is exact.
    static constexpr double reach = 2;
    /// Further distance, cells, within which creases are not reported nor borders of patches kept: as long as
    /// edges, since an edge from within the reach does not show where it crosses a crease.
    static constexpr double beside = 1.5;
    /// Distance, in longest edges of two triangles, within which a point is on a triangle: above rounding.
    static constexpr double on_triangle = 1e-9;
  };

  /// Resolution of surfaces and their patches.
  struct Patches {
    /// A surface whose points are all within this distance of a plane, in diagonals, encloses nothing in
    /// cells of any size.
    static constexpr double flat_surface = 1e-6;
    static constexpr double min_area = 8;  ///< squared cells: cells do not resolve smaller patches
    /// Squared cells: imprinting leaves smaller parts of patches where curves of several surfaces coincide
    /// within the tolerance. No face shows a part this small, while patches that a thin body deserves are
    /// larger.
    static constexpr double sliver = 0.1;
    /// Cells for the mean thickness of a body in a volume, which is twice its volume by its area: four across
    /// a plate, eight across a rod. With half as many, edges that cross interfaces of labels are not exact.
    static constexpr double cells_of_body = 4;
    /// Likewise for a body without sharp edges, whose points are not fitted to its surface: cells cut 4 % off
    /// a ball of three, and 1 % off one of six.
    static constexpr double cells_of_smooth_body = 8;
    /// Sharp edges turn by more than this, radians; a smooth body has at most this share of its curvature at
    /// them.
    static constexpr double sharp_turn = 0.52, max_sharp_share = 0.05;
    static constexpr double corner_reach = 1;  ///< cells: turns within this distance are not corners
    /// Distance, cells, from a curve where three regions meet within which creases are not reported, and max
    /// distance of a reported crease from a visible surface: such curves are accurate to half a cell only.
    static constexpr double junction_reach = 1.5;
    /// Distance, cells, from open rims within which creases are not reported: caps round them as far as cells
    /// are cut.
    static constexpr double rim_reach = 3;
  };
};

}  // namespace tetwright
