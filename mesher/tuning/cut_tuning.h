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
  static constexpr std::size_t stars = 1 << 12;       ///< tets examined with their pieces
  static constexpr std::size_t moves = 1024;          ///< each needs a distance query or a few additions
  static constexpr std::size_t searches = 512;        ///< for the nearest position on surfaces
};

/// Moves of points to interfaces and creases, and cutting; mesher/README.md, Tuned numbers, explains the
/// terms.
struct CutTuning {
  struct Shapes {
    /// min_solid_angle_tangent() of a solid angle of 0.1 sr: the tangent of half the angle. No move may leave
    /// a worse tet. This controls the min dihedral angle of the result: 0.06 sr gives 6 degrees, 0.1 sr gives
    /// 11, 0.14 sr gives 13. Larger values refuse more moves.
    static constexpr double tangent_of_bad_tet = 0.05004170837553879;
  };

  /// Lattice points that move onto interfaces.
  struct Snapping {
    /// A cut closer to an end of its edge than this fraction of the edge is too close. Long edges join two
    /// corners or two centres of cells, short ones a corner and a centre. Tuned on scans: with the 0.25 and
    /// 0.41 of Labelle & Shewchuk 2007, points snap onto flat patches from both sides and tets would be
    /// inverted.
    static constexpr double near_long = 0.35, near_short = 0.49;
    /// A point in the border of a volume with a cut this close, likewise, is on the interface: rounding.
    static constexpr double is_there = 1e-3;
    /// Number of steps per edge in which distances are compared, because all points along a flat face have
    /// nearly the same distance. Must fit in a byte.
    static constexpr double distance_steps = 32;
    /// Side of the blocks whose points one thread processes consecutively, voxels: some 16 points.
    static constexpr double block_side = 2;
    /// Sweeps that improve stars. The first one improves most; later ones improve stars whose neighbours had
    /// to move first.
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
    /// Min number of groups in a round, and number of rounds aimed at: enough groups to be worth a parallel
    /// loop, few enough that most of them do not share points.
    static constexpr std::size_t min_groups = 128, wanted = 48;
    static constexpr std::size_t grain = 4;  ///< groups that a thread processes at a time
    /// Entries of the table that drops repeated points of a group: twice as many as a group has, as a rule.
    static constexpr std::size_t seen_slots = 1024;
  };

  /// Min distances of cuts from corners, so that pieces are well shaped: larger ones give better shapes and
  /// move interfaces farther. They matter only at points that could not be moved onto the interface.
  struct Cuts {
    static constexpr double min_edge_share = 0.25;  ///< from the ends of an edge, in edges
    static constexpr double min_face_share = 0.15;  ///< min barycentric coordinates of the point in a face
    static constexpr double min_tet_share = 0.2;    ///< min barycentric coordinates of the point in a tet
  };

  /// Moves of many points at once.
  struct Displacement {
    /// A move that would spoil a tet is halved up to this many times, then dropped.
    static constexpr std::uint8_t max_halvings = 4;
  };

  /// Moving thickened walls back (the guide, Thin walls, Move back).
  struct WallRecovery {
    /// A wall counts as recovered within this fraction of its thickness.
    static constexpr double recovered_share = 0.1;
    /// Remaining moves are tried again in another pass, since their neighbours have moved too.
    static constexpr int passes = 3;
    /// Max step, lattice units: half of the largest thickening, and as much again for a point that has moved
    /// since.
    static constexpr double max_step = 1.25;
  };

  /// Which patch, crease or corner a boundary point represents (the guide, Fitting creases).
  struct Labelling {
    /// Cosine between normals below which a triangle faces the other way.
    static constexpr double min_facing = -0.5;
    /// Max distance of a boundary point from the surface, cells.
    static constexpr double surface_reach = 2;
    /// Max distance of a corner from the point that represents it, cells.
    static constexpr double corner_reach = 1.5;
    /// Max distance of a corner where sheets meet from the vertex that represents it, cells: where surfaces
    /// meet at a small angle, the mesh's junction is that far away.
    static constexpr double junction_reach = 3;
    /// A patch is flat if its points lie in a plane to this share of its diagonal: rounding of single
    /// precision coordinates in files.
    static constexpr double flat_share = 1e-5;
    /// Points closer than this to the border of a sheet, cells, are on it.
    static constexpr double border_reach = 0.05;
    /// Creases this close to each other, cells, are parts of one curve: rounding of nearest points.
    static constexpr double same_curve = 1e-6;
    /// Max distance of a crease from an edge that crosses it, in edge lengths: the tip of a wedge of 30
    /// degrees is two edges from its chamfer.
    static constexpr double crease_reach = 2.5;
    /// Iterations that find a crossing by alternating between the nearest points on the edge and on the
    /// crease. It need not be exact.
    static constexpr int crossing_steps = 3;
    /// Snap an endpoint to the crease if the crossing lies within this fraction of the edge.
    static constexpr double max_snap = 0.5;
    /// New points keep at least this fraction of the edge from its ends.
    static constexpr double min_split = 0.2;
    /// Max distance, cells, of the patch beyond the creases at which a point that has only crease points
    /// around it is assigned to that patch: the accuracy of a level set near creases.
    static constexpr double island_reach = 0.35;
    /// Creases separated only by patches narrower than this, cells, are merged.
    static constexpr double narrow_reach = 0.3;
    /// Max rounds of snapping and splitting: each round may create edges that cross another crease.
    static constexpr int max_rounds = 4;
  };

  /// Strips between regions that face each other across a curve.
  struct Strips {
    /// Sheets at a curve from which on the lattice leaves strips: up to three are cut as they are.
    static constexpr std::size_t min_sheets = 4;
    /// Max distance of a strip's faces from the curve, cells.
    static constexpr double curve_reach = 3;
    /// Faces farther than this from a sheet between their regions, cells, are strips.
    static constexpr double sheet_reach = 1.5;
  };

  /// Tubes around curves in which four or more sheets meet, which are meshed anew.
  struct Tubes {
    /// Max distance of a tube's points from the curve, and of those whose edges determine its size, cells.
    static constexpr double reach = 8, sized_reach = 3;
    /// Distance of the chain's vertices, in the longest edges there: no edge may pass over two vertices.
    static constexpr double spacing = 1.2;
    /// Step along a curve in which the spacing is read, cells.
    static constexpr double spacing_step = 0.25;
    /// First radii of a tube, likewise, in the order in which they are tried. Sectors must be wider than an
    /// edge there, and faces visible from the chain's vertices; both is easier farther away, but other parts
    /// of the surface may be there.
    static constexpr double radii[] = {1.65, 1.4, 1.8, 1.2, 1};
    /// Radius of the ball around a point where three or more curves meet, in that of the tubes, since the
    /// faces between two tubes must be visible from it; and the part of it that is mapped to the point, in
    /// the longest edges.
    static constexpr double node_radius = 1.5, node_share = 1.2;
    /// Max distance of a tube's points, in the longest edges.
    static constexpr double max_growth = 4;
    /// Rounds of growth, and passes over the points of a tube in each of them.
    static constexpr int max_rounds = 30, max_passes = 20;
    /// Steps along a chain within which the radius changes where a tube fails: the tets of a vertex reach to
    /// those next to it, and the radius may not jump there.
    static constexpr int steps_of_change = 2;
    /// Max number of points of poor faces that make room together: larger groups need another tube.
    static constexpr std::size_t max_group = 60;
    /// Steps along a chain within which points of an edge are brought together, and in which the boundary is
    /// reached.
    static constexpr int max_steps = 8, max_steps_to_boundary = 3;
    /// Solid angles that new tets must have, and below which better ones are sought, sr.
    static constexpr double min_solid_angle = 1e-3, good_solid_angle = 0.1;
    /// Shape of tets that will be flat: better than all that are not positive.
    static constexpr double shape_in_sheet = -1e-9;
  };

  /// Moves of a few dozen points until all tets around them are positive.
  struct Untangling {
    /// Rounds, each with a smaller regularisation (Garanzha et al. 2021 use 128 for whole meshes), and steps
    /// of L-BFGS in each, with the number of earlier steps that it remembers.
    static constexpr int max_rounds = 40, max_steps = 60;
    static constexpr std::size_t memory = 6;
    static constexpr int max_halvings = 30;
    /// Length of the first step, in mean edges, and the share of the expected decrease that a step must reach
    /// (Nocedal and Wright 2006, section 3.1).
    static constexpr double first_step = 0.1, sufficient_decrease = 1e-4;
    /// Reduction of the distortion that the regularisation counts with at least, and its min value (both as
    /// Garanzha et al. 2021).
    static constexpr double min_reduction = 0.1, min_epsilon = 1e-10;
    /// Relative gain of a step below which a round ends: later rounds go on from there.
    static constexpr double min_gain = 1e-4;
    /// Volume that is enough, as a share of the mean of all tets: fitting and simplification improve shapes.
    static constexpr double min_determinant = 0.02;
  };

  /// Moves of boundary points to their patch, crease or corner (the guide, Fitting creases, step 5).
  struct Fitting {
    /// Max distance of a point from its target, cells.
    static constexpr double target_reach = 4;
    /// Cosine between normals from which a face and a patch that is not fitted may belong together: 60
    /// degrees.
    static constexpr double alike = 0.5;
    /// Quality that tets must keep in each pass, in multiples of tangent_of_bad_tet: early passes favour
    /// shapes, later ones exact creases.
    static constexpr double pass_floors[] = {1, 1, 0.5, 0.5, 0.2, 0.2, 0.05, 0.05};
    /// Further passes, with the last of these floors, where regions meet: there many points wait for each
    /// other.
    static constexpr std::size_t junction_passes = 4;
    /// Points of a junction whose targets are closer than this share of the distance between their
    /// neighbours' get others, and the max number of rounds over all points.
    static constexpr double min_junction_share = 0.15;
    static constexpr int unfolding_rounds = 20;
    /// Thickened walls move back as long as tets keep this quality (0.02 sr); otherwise they are reported.
    static constexpr double wall_floor = 0.2;
    /// Walls of this many cells are not thickened.
    static constexpr double thick_wall = 2;
    /// Steps tried to make room, in mean edges at the point, and number of sweeps over all points.
    static constexpr double room_steps[] = {0.4, 0.2, 0.1, 0.05};
    static constexpr int room_sweeps = 2;
    /// Steps of points that move on their own are halved at most this often.
    static constexpr int max_own_halvings = 3;
    /// Points within this distance of their target, cells, have arrived: allows for rounding.
    static constexpr double arrived = 1e-12;
    /// Points within this distance of a plane of the border of a volume, cells, are in it: rounding, as
    /// DomainTuning::Frames::share_of_rounding permits it.
    static constexpr double in_border = 0x1p-20;
    /// Such points go to their patch or crease and back into the plane at most this often, until they move
    /// by less than the second distance, cells: enough where both meet at 35 degrees or more.
    static constexpr int border_steps = 60;
    static constexpr double border_arrived = 1e-7;
    /// Max distance of these targets from the patch or crease, cells: LabelTuning::Border::slack in the
    /// smallest cells beside bodies.
    static constexpr double border_slack = 0.05;
  };

  /// Points that hold each other back and are moved to their targets together.
  struct JointFitting {
    /// Points around a group give way up to this many edges away.
    static constexpr int rings = 2;
    /// Max number of points in a group: larger ones have another cause than a few points in the way.
    static constexpr std::size_t max_group = 60;
    /// Solid angle that tets must have, sr: simplification improves them.
    static constexpr double min_solid_angle = 1e-3;
    /// Step by which the direction of a crease is found, cells.
    static constexpr double tangent_step = 0.05;
  };
};

}  // namespace tetwright
