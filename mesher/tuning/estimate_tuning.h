// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace tetwright {

/// Predicted tets and memory; mesher/README.md, Tuned numbers, explains the terms. All were fitted to scans,
/// parts and volumes like those in Measurements, Estimates of memory, which compares predictions with
/// measurements. Areas are squared cells, volumes are cells. Sides of an interface count where they are
/// meshed.
struct EstimateTuning {
  /// Bytes.
  struct Memory {
    static constexpr double program = 38e6;  ///< the program and its libraries
    /// Peak per leaf of an octree including its lattice points, before any tet exists.
    static constexpr double per_leaf = 150;
    /// Peak per lattice tet while points are moved and tets cut.
    static constexpr double per_surface_lattice_tet = 40, per_label_lattice_tet = 33;
    /// Peak with uniform cells. It occurs while the lattice is built, as most leaves are far from interfaces.
    static constexpr double per_uniform_lattice_tet = 19, per_uniform_leaf = 124;
    /// Distances of labels per face between voxels of two regions: 43 to 60 measured.
    static constexpr double per_label_face = 60;
    /// Per triangle while signed distances are computed; open parts also need a tree.
    static constexpr double per_triangle = 150, per_open_triangle = 300;
    /// Factor for cells so small that they resolve the input's facets: 1.8 measured for a bunny at 780 cells
    /// along its longest side.
    static constexpr double faceted_factor = 2.5;
  };

  /// Adaptive cells.
  struct Adaptivity {
    /// Dense tets per area, as a share of the number with finest cells, where the interface is flat enough
    /// for cells of twice and of four times the size.
    static constexpr double tets_at_coarse = 0.15, tets_at_coarsest = 0.08;
    /// Largest cells, in voxels, with which part of the interface of labels gets cells of twice and of four
    /// times the size: it curves on the scale of voxels.
    static constexpr double largest_with_coarse = 0.1, largest_with_coarsest = 0.025;
  };

  /// Uniform cells.
  struct Uniform {
    /// Dense tets per cell: a body-centred cubic lattice has 12.
    static constexpr double tets_per_cell = 12;
  };

  /// Surfaces.
  struct Surfaces {
    /// Dense tets of adaptive cells per area and side: the first value where the material is thick, half of
    /// it where the material's volume per area is the second value, cells. Within 10 % on scans at 32 to 256
    /// cells; up to a factor of two too high for flat ones.
    static constexpr double tets_per_area = 29, half_full_thickness = 1.6;
    /// Lattice tets per area on a side that is not meshed, for adaptive and for uniform cells.
    static constexpr double outside_tets_per_area = 14, outside_tets_per_area_uniform = 15.5;
    /// Dense tets of uniform cells per area, in addition to those per cell, and the same with the outside
    /// kept.
    static constexpr double cut_tets_per_area = 0.7, kept_outside_tets_per_area = 3;
  };

  /// Samples of surfaces, which determine how flat interfaces are and which of their sides are meshed. More
  /// take longer and are more accurate.
  struct Sampling {
    /// Samples of a surface, and of the interior of bodies along each axis.
    static constexpr int surface_samples = 256, volume_samples = 24;
    /// Distances at a surface sample are needed up to this, cells.
    static constexpr double reach = 12;
    /// Max triangles used for distances. For finer surfaces only every second, third, ... triangle is read.
    static constexpr std::size_t max_triangles = 1 << 20;
    /// Cells in front of and behind the plane of a sample, to find the side on which the surface is.
    static constexpr double plane_offset = 0.25;
    /// Cells from a sample to the points that determine the regions on its sides.
    static constexpr double side_offset = 0.1;
  };

  /// Labels. Faces are voxel faces; their number is their area in squared cells.
  struct Labels {
    /// As for surfaces: dense tets per face and side. Voxel faces have about one and a half times the area of
    /// the interface.
    static constexpr double tets_per_face_side = 21.5, half_full_thickness = 0.6;
    /// Lattice tets on a side of a face that is not meshed.
    static constexpr double outside_tets_per_face = 10;
    /// Dense tets of uniform cells per face to the outside, in addition to those per cell.
    static constexpr double tets_per_outer_face = 1;
    /// Tets per cell that is split where labels are thin, by whether its centre is in a label.
    static constexpr double dense_per_thin_cell = 96, lattice_per_thin_cell_outside = 30;
    /// The fraction of the cells of at most a voxel where labels are thin that drop_redundant_cells() keeps:
    /// 0.11 to 0.2 on five volumes, some more where larger cells are halved, too.
    static constexpr double kept_thin_cells = 0.25;
    /// Smoothing reduces the area of interfaces to `smooth_share`; only cells below `small_cell`, voxels,
    /// resolve that.
    static constexpr double small_cell = 0.75, smooth_share = 0.87;
  };

  /// The smallest number of tets of a simulation mesh in good shapes (benchmarks/README.md, Smallest counts).
  struct Filling {
    /// Tets on each side of a part of a boundary. Labels: a closed interface, such as a ball, and the contact
    /// of two of several labels. Surfaces: any part, which may be as simple as a square.
    static constexpr double per_closed_interface = 30, per_contact = 10, per_surface_part = 5;
    /// Cubed area by squared volume of a cube, and by how much more there is a tet. A wall of thickness t
    /// whose sides have the area A takes 4 / 14 A / t^2. Areas of labels are estimated 7 % lower where they
    /// are flat.
    static constexpr double of_cube = 216, surface_per_tet = 14, label_per_tet = 11;
  };

  /// Tets per leaf, by the region at its centre. Fitted to 23 inputs: within 5 % for lattice tets; for dense
  /// tets within 6 % with one material and 16 % with several.
  struct Leaves {
    /// Inside; outside and less than half a leaf from an interface.
    static constexpr double dense_inside = 12.03, dense_near = 6.2;
    /// Inside; outside and less than half a leaf from an interface; outside and less than one leaf from it.
    static constexpr double lattice_inside = 12.16, lattice_near = 24.1, lattice_beside = 5.8;
    /// With the outside, for all leaves: lattice tets of uniform and of adaptive cells, dense tets per
    /// lattice tet.
    static constexpr double kept_uniform = 12.2, kept_adaptive = 13.6, kept_dense = 1.025;
  };
};

}  // namespace tetwright
