// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace tetwright {

/// Items that a parallel loop hands out at a time: enough to outweigh the handing out, few enough to keep
/// all threads busy to the end. Sums over triangles are added up in these blocks, which decides their
/// rounding.
struct InputGrains {
  static constexpr std::size_t triangles = 4096;
  static constexpr std::size_t components = 16;    ///< each is compared with others
  static constexpr std::size_t border_edges = 16;  ///< each is compared with all others
  static constexpr std::size_t voxels = 1 << 18;
  static constexpr std::size_t slices = 16;  ///< each is read once, and the first one after them again
};

/// Surfaces and volumes before there is a grid; mesher/README.md, Tuned numbers, explains the terms.
struct InputTuning {
  struct Limits {
    /// Max materials and labels: regions have numbers of 16 bits, a few of them reserved.
    static constexpr std::size_t max_materials = 60'000;
  };

  /// Volumes that are probably no segmentation: with more labels than a table of labels has, in islands of
  /// fewer voxels on average.
  struct GrayValues {
    static constexpr std::size_t min_labels = 256;
    static constexpr double max_island = 3;
  };

  struct ExpectedSolids {
    /// Number of queries of a surface above which a tree pays; each query without one visits every triangle.
    static constexpr std::size_t max_plain_queries = 16;
  };

  struct RegionExtents {
    /// Points of a component at which the bodies around it are looked up: parts of bodies that cross without
    /// being joined are rarely so small that all points miss them.
    static constexpr std::size_t places = 7;
  };

  struct Soups {
    /// Corners of two triangles closer than this, in sizes of a triangle, may be one point that was rounded:
    /// single precision far from the origin.
    static constexpr double close = 1e-2;
  };

  /// Cells between the inner walls of a surface.
  struct Cells {
    /// Smaller cells, as a share of the volume of all, are folds of the surface and join a neighbour: 1 % of
    /// the size of a body is about one cell of a dense mesh.
    static constexpr double min_share = 1e-6;
    /// Relative difference below which volumes are equal, and the step of coordinates, in diagonals, at which
    /// lowest points are compared: the rounding of coordinates written with six digits.
    static constexpr double equal = 1e-6;
    /// Step from the middle of a cell's largest triangle to a point inside, as a share of the triangle's
    /// size: above rounding, below the thickness of cells.
    static constexpr double step_inside = 1e-4;
  };

  /// Walls of zero thickness that are part of a body's surface.
  struct Walls {
    /// Share of a patch that must be inside the body: a plate may reach far beyond it, while a loose piece
    /// that only touches it is no wall.
    static constexpr double inside_share = 0.1;
    /// Smaller pieces, as a share of the body's surface, are dropped: about the size of one face of a mesh of
    /// a million tets.
    static constexpr double min_share = 1e-5;
  };

  /// Open surfaces that close together.
  struct Patches {
    /// Share of a surface's border, by length, that must lie on others: all but what cleaning and rounding
    /// may change.
    static constexpr double border_share = 0.99;
    /// Share from which it is reported that surfaces do not close: more than two bodies with holes have in
    /// common by chance.
    static constexpr double mentioned_share = 0.5;
  };

  /// Holes and their caps.
  struct Holes {
    /// Max distance of a flat rim from its plane, in diagonals: the rounding of coordinates written with six
    /// digits, and of planes that other programs cut along.
    static constexpr double flat = 1e-5;
    /// Holes smaller than this share of the surface get no flat cap: hardly any mesh resolves them.
    static constexpr double min_share = 1e-5;
    /// Rims of smaller caps, as a share of the surface, are no creases on their own: a few cells at the
    /// usual resolutions.
    static constexpr double min_sharp_share = 1e-3;
    /// Largest ratio of a cap to the rest of its component: that of a dome 1/28 as high as wide, below which
    /// a surface may well be a sheet.
    static constexpr double max_ratio = 0.995;
    /// Share of a sharp rim that must turn by more than the feature angle.
    static constexpr double sharp_share = 0.5;
    /// Only the largest flat holes of a file, up to this number, are closed, as they are compared in pairs.
    static constexpr std::size_t max_flat = 2000;
    /// Relative difference below which sizes are equal, and the step of coordinates, as a share of the hole's
    /// size, at which lowest points are compared: the rounding of coordinates written with six digits.
    static constexpr double equal = 1e-6;
    /// Max distance of a point that names a cap, in diagonals: a point read off a picture.
    static constexpr double near = 0.05;
  };

  /// Open surfaces that enclose next to nothing, and what is made of open surfaces.
  struct OpenSurfaces {
    /// Area of a hole's projection onto the plane in which it is largest, as a share of its component's area.
    /// Above this a component is a sheet: a dome 1/4 as high as wide.
    static constexpr double max_cap_share = 0.8;
    /// Least area of the projection of all holes of a component, as a share of the largest and of its own
    /// area: below this, holes face each other, as those of a short tube do.
    static constexpr double min_one_sided_share = 0.5;
    /// A surface with more of its area in sheets encloses nothing worth meshing.
    static constexpr double min_sheet_share = 0.5;
    /// Depth of a base below the lowest point, as a share of the longer horizontal side: a block that is no
    /// plate.
    static constexpr double base_depth = 0.1;
    /// Least eigenvalue of the sum of the normals' outer products around a point, as a share of the largest:
    /// an edge that turns by 20 degrees. Below, normals differ by noise.
    static constexpr double min_turn = 0.03;
    /// Least height of a triangle that has a normal, as a share of its longest edge: rounding of coordinates
    /// turns lower ones.
    static constexpr double min_height = 1e-7;
    /// Max length of an offset, in thicknesses: at edges that turn by 150 degrees.
    static constexpr double max_mitre = 4;
    /// Max rounds in which points follow those around them: what still turns over then crosses.
    static constexpr int max_rounds = 50;
  };

  /// Surfaces that divide bodies, continued beyond their borders.
  struct Partitions {
    /// Cosine between the directions of two edges on one side of a corner: 30 degrees, well below the corners
    /// of a rectangle or a hexagon.
    static constexpr double same_side = 0.866;
    /// Smallest cosine between the sides of a corner and its middle for which the strip has its full width:
    /// 60 degrees. Sharper ones would become arbitrarily long spikes. Paths turn together up to this angle.
    static constexpr double min_cosine = 0.5;
    /// Max edges of a border, which are compared with each other: 1e8 pairs take about a second.
    static constexpr std::size_t max_border = 10'000;
    /// Distance from a wall at which the strip turns onto it, as a share of the strip's width: about the size
    /// of a tet where strips are as wide as a quarter of the diagonal and the mesh has a few thousand tets.
    static constexpr double turn_share = 0.1;
    /// By how much later a path turns than those beside it, at most, as a share of the distance between them.
    /// Folds that run at an angle to the wall by which others leave make narrow corners there: with 1 and
    /// with 2 tens of tets below 0.1 sr, with 1.5 a few.
    static constexpr double later = 1.5;
    /// Distance from a wall at which the strip turns, as a share of the distance of the border beside it:
    /// where all of the border is near the wall, the layer between them is thin, and is no wedge.
    static constexpr double share_left = 0.5;
  };

  /// Surfaces that are continued to the walls of bodies.
  struct WallApproach {
    static constexpr std::size_t leaf_size = 4;
    /// Cosines between normals. Angles below 37 degrees are narrow: the path turns closer to the wall the
    /// wider they are, at the full distance below 26 degrees.
    static constexpr double narrow = 0.8, narrowest = 0.9;
    /// Distance from the wall up to which a path turns onto it because one beside it does, in distances at
    /// which paths turn.
    static constexpr double farthest = 3;
    /// Sine and cosine of the angle between wall and path after it has turned: 50 degrees, above the 45 up to
    /// which regions between faces are narrow (ComplexTuning::Zone::facing). Walls at right angles to it, by
    /// which paths beside leave, are met at nearly as much.
    static constexpr double sine = 0.766, cosine = 0.643;
    /// Length of the first part of paths, at least, in distances at which paths turn.
    static constexpr double straight_share = 0.25;
    /// Accuracy of the distance at which a path turns, as a share of it, and steps until then: each is as
    /// long as the path is away from turning, and at least as long as the accuracy.
    static constexpr double precision = 0.01;
    static constexpr int max_steps = 2000;
  };

  /// Volumes with a mask each.
  struct Masks {
    /// Max distance of corresponding voxels of one grid, voxels: above the rounding of headers in single
    /// precision or with six digits.
    static constexpr double same_grid = 1e-3;
  };

  /// Max number of labels named in messages: enough to recognise a table of labels, few enough to read.
  struct Messages {
    static constexpr std::size_t max_listed_labels = 30;  ///< in one message
    static constexpr std::size_t max_named_labels = 20;   ///< with a finding of their own
    static constexpr std::size_t max_named_walls = 12;    ///< in one message
  };
};

}  // namespace tetwright
