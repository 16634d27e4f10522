// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace tetwright {

/// Items that a parallel loop hands out at a time: enough to outweigh the handing out, few enough to keep
/// all threads busy to the end.
struct LabelGrains {
  static constexpr std::size_t tiles = 2;              ///< several milliseconds each where labels meet
  static constexpr std::size_t slices = 8;             ///< each is read with the next one
  static constexpr std::size_t counted_slices = 16;    ///< with a table of all regions
  static constexpr std::size_t voxels = 1 << 18;       ///< mostly skipped
  static constexpr std::size_t thin_voxels = 1 << 16;  ///< with the cells around each, most of them the same
  static constexpr std::size_t films = 64;             ///< triangles, each with points all over it
};

/// Smooth distances of labels between voxel centres; mesher/README.md, Tuned numbers, explains the terms. The
/// guide, Labels, lists the guarantees that depend on these. A share is the fraction of a voxel that a label
/// occupies.
struct LabelTuning {
  /// Areas of regions of voxels.
  struct Extents {
    /// Samples of all directions: the shares of directions are accurate to a percent.
    static constexpr int directions = 10000;
    /// Voxel faces that make a contact of two regions a part of their boundaries; fewer may be noise.
    static constexpr std::size_t min_contact_faces = 16;
    /// Area of voxel faces by the estimated area, along an axis and in the mean of all directions, and the
    /// thickness in voxels from which on oblique sheets are even: a shell of one voxel takes twice the tets
    /// of a flat sheet, one of two voxels as many (benchmarks/README.md, Smallest counts).
    static constexpr double faces_of_flat = 1.08, faces_of_oblique = 1.5, even_voxels = 2;
  };

  /// Distances from smoothed shares with back projection.
  struct Smoothing {
    /// Max labels in a tile: each takes a megabyte.
    static constexpr std::size_t max_labels = 1024;
    /// Samples of shares along each side of a cell; even, for the half cells at the border of the volume.
    static constexpr int samples_along = 4;
    /// Two preserve the volumes of labels; each additional one reaches three voxels farther
    /// (LabelSmoother::reach).
    static constexpr int back_projections = 2;
    /// Fraction of the missing share that one back projection adds: with 1, thin sheets overshoot.
    static constexpr float given_back = 0.7F;
    /// Lead of the largest share over the second largest above which a sample point counts entirely for its
    /// label.
    static constexpr float sure_lead = 0.4F;
    /// Min lead of a voxel's own share at its centre: keeps interfaces an eighth of a voxel away from the
    /// centre.
    static constexpr float min_lead = 0.1F;
    /// Min lead as a distance, voxels: the guaranteed eighth.
    static constexpr float min_distance = 0.125F;
    /// Min lead at the middle of an edge across which two voxels of a label are connected, voxels: half of
    /// that at the centres.
    static constexpr float min_connection = 0.0625F;
    /// Likewise at a corner across which two voxels of a label are connected.
    static constexpr float min_corner_connection = 0.0625F;
    /// Min distance of third labels from the middle of a voxel face shared by two labels, voxels. Otherwise
    /// the contact could shrink so far that no tet fits around it.
    static constexpr float min_contact = 0.25F;
    /// Change of the lead of one share over the other along one voxel across a flat interface: twice the
    /// density of the kernel's normal distribution at 0.
    static constexpr float share_per_voxel = 0.8F;
    /// |2u - 1| is clamped to this, where the distance is LabelSmoother::band.
    static constexpr float max_excess = 0.95F;
    /// Shares that a label lacks in a voxel of its own. Above the first one, the voxel's centre gets a fixed
    /// depth, which grows to `deepest` (voxels) at the second. Such a label is a rod or a single voxel, too
    /// narrow for back projection; the depth puts the interface near the faces of the voxel itself.
    static constexpr float lack_from = 0.3F, lack_to = 0.8F, deepest = 0.8F;
  };

  /// Uniform growth of labels, which corrects their volumes.
  struct Growth {
    /// Max growth and shrinking, voxels: trades volumes of thin labels for their shapes.
    static constexpr float max_growth = 0.7F;
    /// Max rounds; growing a label changes its neighbours.
    static constexpr int max_rounds = 4;
    /// Limits of the ratio of actual to expected volume changes, which is uncertain for labels with few
    /// faces. It differs from 1 because voxel faces have a larger area than the interface and enforced nodes
    /// do not move.
    static constexpr double min_response = 0.25, max_response = 1.25;
    /// Min expected change, as a fraction of the volume, from which the ratio is learnt: noise dominates
    /// smaller ones.
    static constexpr double min_informative = 1e-3;
    /// Labels of at most this many voxels are small: guarantees apply to larger ones.
    static constexpr double small_voxels = 1000;
    /// Max deviations of volumes, relative to the label's voxels. 2 % is guaranteed, except for small labels,
    /// and meshing adds a few tenths of a percent.
    static constexpr double tolerance = 0.004, tolerance_small = 0.02;
    /// Voxels by which small labels may shrink relative to their neighbours. Slanted sheets one voxel thick
    /// become too thick, and would tear if shrunk farther.
    static constexpr double max_small_shrinking = 0.15;
    /// Gauss-Seidel sweeps; the outside and labels of correct volume are not changed.
    static constexpr int sweeps = 30;
  };

  /// Measuring how much of labels bodies take.
  struct Carving {
    /// Samples along each edge of a voxel that a surface passes: errors of single voxels of up to 1/8 are
    /// independent, so that those of volumes are far below the 1 % that is compared.
    static constexpr int samples = 4;
    /// Max length of the parts into which voxels are divided, cells: half the diagonal of a part and the next
    /// number are less than the band, within which distances are known.
    static constexpr double max_part = 1.2;
    /// Distance from a surface, cells, from which on distances tell the side: they round off edges.
    static constexpr double uncertain = 0.75;
    /// Thickness of the layer in which interfaces of labels turn towards bodies: in cells of the coarsest
    /// body, and at most in voxels.
    static constexpr double layer = 1, max_layer = 0.25;
    /// Share of the band from which on a point is far from surfaces.
    static constexpr double far_share = 0.98;
    /// Distances from protected labels, in layers, between which the layer grows from nothing to its
    /// thickness. The second is less than a voxel, since distances of labels are clamped to two, and those
    /// from protected ones to half of it where two others meet.
    static constexpr double without_layer = 1.5, with_layer = 3.5;
    /// Distance from the border of the volume, voxels of the frame, from which on labels beyond it are left
    /// out before points move: more than moves depend on.
    static constexpr double far_beyond = 4;
  };

  /// Labels of which bodies leave a film.
  struct Films {
    /// Cells: thicker films have room for a cell.
    static constexpr double max_thickness = 1;
    /// Min thickness as a share of the layer around bodies, so that no film is left to neither, and where
    /// there is no such layer, cells: thinner films would need more halvings than there are.
    static constexpr double min_share_of_layer = 0.95, min_without_layer = 0.02;
    /// Steps along the normal in which the other side is looked for, and bisections of the one that has it.
    static constexpr int steps = 8, bisections = 6;
    /// Min distance from the interface, as a share of the thickness along the normal: a wedge of more than
    /// some 25 degrees is no film, and smaller cells would only resolve what coarse ones snap.
    static constexpr double min_parallel = 0.9;
    /// Positions along a crease, cells, at which an interface must be near if it runs along the crease.
    static constexpr double beside[] = {-1, 0, 1};
  };

  /// The border of a volume with bodies.
  struct Border {
    /// Cells between bodies and the end of the lattice below which it continues beyond the border, and then
    /// at least: distances from surfaces reach three cells, and so do the faces of continued_beyond() and the
    /// cells on their far side.
    static constexpr double min_room = 4;
    static constexpr int room = 8;
    /// Cells by which bodies with a face in the border continue beyond it: more than distances reach.
    static constexpr double continuation = 5;
    /// Max distance from the border, voxels, of faces that count as lying in it: more than the rounding of
    /// files in single precision, and less than anyone could tell.
    static constexpr double slack = 0.02;
  };

  /// Distances at any point.
  struct Field {
    /// Min cells per voxel edge for which the guarantees hold.
    static constexpr double min_cells_per_voxel = 2;
    /// Share of the band from which a distance counts as clamped: rounding and interpolation give slightly
    /// less than the band.
    static constexpr double clamped_share = 0.98;
    /// Ranges with fewer cells along a side are not tested as a whole, since that does not pay.
    static constexpr int small_range = 8;
    /// Lead of a region at the corners of a cell, in cells, from which on it has the whole cell: far more
    /// than rounding, and than what distances change over tolerance::coinciding_cells.
    static constexpr double min_certain_lead = 1e-4;
  };

  /// Labels thinner than cells resolve.
  struct Thickness {
    /// Thickness that a label must have, cells.
    static constexpr double min_cells = 2;
    /// Max voxels along a side of a box of two cells: its sides are counted in bytes.
    static constexpr int max_side = 200;
    /// Memory of the slices that are searched at a time, with those around them, and of each voxel, bytes.
    static constexpr std::size_t slab_bytes = std::size_t{1} << 28, bytes_per_voxel = 4;
    /// Min number of slices that are searched at a time, sides of a box: two of them more are read around.
    static constexpr int min_slab = 4;
    /// Max voxels of a box for which positions partly outside the volume are tried. Larger boxes belong to
    /// cells much larger than voxels, where gaps this small hardly matter.
    static constexpr int max_tried = 512;
    /// Max distance of interfaces from the centre of a thin voxel, voxels.
    static constexpr double reach = 0.75;
    /// Cells per voxel that suffice for islands hardly larger than a voxel, for which two are too few.
    static constexpr double cells_per_island_voxel = 8;
    /// Islands of fewer voxels are small: two cells per voxel would not resolve their shape.
    static constexpr std::size_t small_island = 8;
    /// Max thin voxels of small islands to be refined. Each takes thousands of tets, so noise is not refined.
    static constexpr std::size_t max_island_voxels = 32;
  };
};

}  // namespace tetwright
