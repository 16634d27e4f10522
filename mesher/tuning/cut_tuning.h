// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace tetwright {

/// Items that a parallel loop hands out at a time: enough to outweigh the handing out, few enough to keep
/// all threads busy to the end.
struct CutGrains {
  static constexpr std::size_t tets = 1 << 13;        ///< some ten nanoseconds each
  static constexpr std::size_t candidates = 1 << 13;  ///< points that may move
  static constexpr std::size_t stars = 1 << 12;       ///< tets that are looked at with their pieces
  static constexpr std::size_t moves = 1024;          ///< each needs a distance or a few additions
  static constexpr std::size_t searches = 512;        ///< of a nearest position on surfaces
};

/// Moves of points to interfaces and creases, and cutting; mesher/README.md, Tuned numbers, explains the
/// terms.
struct CutTuning {
  struct Shapes {
    /// min_solid_angle_tangent() of a solid angle of 0.1 sr: the tangent of half the angle. No move may leave
    /// a worse tet. This controls the min dihedral angle of the result: 0.06 sr gives 6 degrees, 0.1 sr gives
    /// 11, 0.14 sr gives 13, but more moves are refused.
    static constexpr double tangent_of_bad_tet = 0.05004170837553879;
  };

  /// Lattice points that move onto interfaces.
  struct Snapping {
    /// A cut is too close to an end of its edge below this fraction of the edge. Long edges join two corners
    /// or two centres of cells, short ones a corner and a centre. Tuned on scans: with the 0.25 and 0.41 of
    /// Labelle & Shewchuk 2007, points snap onto flat patches from both sides and tets would be inverted.
    static constexpr double near_long = 0.35, near_short = 0.49;
    /// Distances are compared in steps of this fraction of an edge, because all points along a flat face have
    /// nearly the same distance. A byte holds it.
    static constexpr double distance_steps = 32;
    /// Number of points that one thread processes consecutively.
    static constexpr std::size_t group_size = 16;
    /// Sweeps that improve stars. The first one improves most; later ones improve those whose neighbours had
    /// to be moved first.
    static constexpr int sweeps = 4;
    /// Steps tried in a sweep, as fractions of the way from a point on an interface to the middle of its
    /// star.
    static constexpr double steps_on_interface[] = {0.25, 0.5, 1.0};
    /// Steps tried along the slope, as fractions of the distance from the nearest other region, so that the
    /// point keeps its side for any cell size; and to the middle of its star.
    static constexpr double steps_off_interface[] = {-0.4, -0.2, 0.3, 0.6}, step_to_middle = 0.5;
  };

  /// Rounds of groups of points that share no star.
  struct Rounds {
    /// Groups of a round, at least, and rounds for all: enough groups to be worth a parallel loop, few enough
    /// that most of them do not share points.
    static constexpr std::size_t min_groups = 128, wanted = 48;
    static constexpr std::size_t grain = 4;  ///< groups that a thread processes at a time
  };

  /// Cuts of tets, which keep these distances so that pieces are well shaped: larger ones keep better shapes
  /// and move interfaces farther. Only edges of points that could not be moved would be cut closer.
  struct Cuts {
    static constexpr double min_edge_share = 0.25;  ///< from the ends of an edge, in edges
    static constexpr double min_face_share = 0.15;  ///< min barycentric coordinates of the point in a face
    static constexpr double min_tet_share = 0.2;    ///< and in a tet
  };

  /// Moves of many points at once.
  struct Displacement {
    /// A move that would spoil a tet is halved up to this many times, then dropped.
    static constexpr std::uint8_t max_halvings = 4;
  };

  /// Walls that were thickened and move back (the guide, Thin walls, Move back).
  struct WallRecovery {
    /// A wall counts as recovered within this fraction of its thickness.
    static constexpr double recovered_share = 0.1;
    /// Remaining moves are tried again in another pass, since their neighbours have moved too.
    static constexpr int passes = 3;
    /// Lattice units: half of the largest thickening, and as much again for a point that has moved on from
    /// there.
    static constexpr double max_step = 1.25;
  };

  /// Which patch, crease or corner a boundary point represents (the guide, Fitting creases).
  struct Labelling {
    /// Cosine below which a triangle's normal faces the other way.
    static constexpr double min_facing = -0.5;
    /// Max distance of a boundary point from the surface, cells.
    static constexpr double surface_reach = 2;
    /// Max distance of a corner from the point that represents it, cells.
    static constexpr double corner_reach = 1.5;
    /// Max distance of a crease from an edge that crosses it, in edge lengths: the tip of a wedge of 30
    /// degrees is two edges from its chamfer.
    static constexpr double crease_reach = 2.5;
    /// Iterations for the crossing: the point of the edge next to that of the crease, and back. It need not
    /// be exact.
    static constexpr int crossing_steps = 3;
    /// Snap an endpoint to the crease if the crossing lies within this fraction of the edge.
    static constexpr double max_snap = 0.5;
    /// New points keep at least this fraction of the edge from its ends.
    static constexpr double min_split = 0.2;
    /// A point with only crease points around it gets the patch on their other side if that is closer than
    /// this, cells: the accuracy of a level set near creases.
    static constexpr double island_reach = 0.35;
    /// Creases separated only by patches narrower than this, cells, are merged.
    static constexpr double narrow_reach = 0.3;
    /// Max rounds of snapping and splitting: each may make edges that cross another crease.
    static constexpr int max_rounds = 4;
  };

  /// Moves of boundary points to their patch, crease or corner (the guide, Fitting creases, step 5).
  struct Fitting {
    /// Max distance of a point from its target, cells.
    static constexpr double target_reach = 4;
    /// Quality that tets must keep in each pass, in multiples of tangent_of_bad_tet: shapes first, then exact
    /// creases.
    static constexpr double pass_floors[] = {1, 1, 0.5, 0.5, 0.2, 0.2, 0.05, 0.05};
    /// Walls that cells have thickened move back as long as tets keep this quality, 0.02 sr; otherwise they
    /// are reported.
    static constexpr double wall_floor = 0.2;
    /// Steps tried to make room, in multiples of the mean edge at the point, and sweeps over all points.
    static constexpr double room_steps[] = {0.4, 0.2, 0.1, 0.05};
    static constexpr int room_sweeps = 2;
    /// Points closer to their target than this have arrived, in cells: rounding.
    static constexpr double arrived = 1e-12;
  };
};

}  // namespace tetwright
