// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace tetwright {

/// The numbers that simplify/ is tuned by, a group for each stage, in the order of the folders. Each says its
/// unit and its source: a paper, a measurement, or else what it trades. "The paper" is Cutler, Dorsey &
/// McMillan 2004; README means simplify/README.md. Ratios have no unit unless one is named. "Edges" as a unit
/// are those of a regular mesh of the target count (TetQuality::ideal_edge) unless others are named.
///
/// Changing one changes the bytes of the output, but for Memory and the chunks of Batches. Tolerances for
/// rounding that several libraries share are in common/tolerances.h; sizes of tables stay beside their
/// tables.
struct SimplifyTuning {
  /// Items that a parallel loop hands out at a time: enough to outweigh the handing out, few enough to keep
  /// all threads busy to the end. Sums over slots are added up in these blocks, which decides their rounding.
  struct Grains {
    static constexpr std::size_t slots = 8192;              ///< slots of tets or points
    static constexpr std::size_t surface_triangles = 4096;  ///< records of the grid, faces of a projection
    static constexpr std::size_t samples = 1024;            ///< each needs a query of a tree
    static constexpr std::size_t transferred_tets = 64;     ///< each is intersected with many others
  };

  /// Estimates of memory, by which work is refused before it begins. Bytes.
  struct Memory {
    /// Peak of the process: its libraries, and for each input tet the editable mesh with the input that it is
    /// made from. README, Memory, compares both with measurements.
    static constexpr double program_bytes = 40e6;
    static constexpr double bytes_per_tet = 105;
    /// A sample with everything that belongs to it: 190 measured for 7 million on a cube.
    static constexpr double bytes_per_sample = 200;
  };

  /// Slots of the mesh's arrays. Free ones cost memory; without them arrays grow, which copies them.
  struct Slots {
    /// Share of dead slots among those used above which the mesh is compacted: trades the time of compaction
    /// for dense memory.
    static constexpr double compact_above = 0.3;
    /// Free slots left for operations that add: the inverse of their share of the live ones, and their min
    /// number.
    static constexpr std::size_t spare_inverse = 16, min_spare = 4096;
    /// Initial free slots of a Remesher, likewise. Beyond them its arrays grow in place.
    static constexpr std::size_t remesher_spare_inverse = 64, remesher_min_spare = 4096;
    /// Min slots by which the arrays grow: more than a batch needs, yet negligible beside a mesh large enough
    /// to count.
    static constexpr std::size_t growth = 4096;
  };

  /// Local copies of stars.
  struct Stars {
    /// Max number of link points: larger stars are not worth the time.
    static constexpr std::size_t max_points = 500;
    /// Max number of tets visited in the target's star by the link condition, likewise.
    static constexpr std::size_t max_walk = 2000;
  };

  /// Bounds of edge lengths, as ratios of length to target length.
  struct EdgeLengths {
    /// Between these an edge is left alone: halving an edge above the upper one makes none below the lower
    /// one, as in Botsch & Kobbelt 2004, whose 4/5 and 4/3 are narrower than what must be reached, a factor
    /// of 1.5 (README, Edge lengths).
    static constexpr double short_edge = 0.7, long_edge = 1.48;
    /// Share of the min length that new edges may have if the proposal removes one that is too long: halving
    /// the edge of flat tets makes short ones, and nothing else shortens it.
    static constexpr double short_share_beside_long = 0.5;
    /// Ratio of a well-shaped mesh's edges to the cube root of its mean tet volume. Measured on meshes made
    /// for target lengths: with it the median edge has the target length.
    static constexpr double edge_to_ideal = 2.1;
  };

  /// Volumes of materials.
  struct Volumes {
    /// Max relative change of a material's volume (README, Invariants): 1 % is promised.
    static constexpr double max_change = 0.008;
  };

  /// The grid of surface triangles.
  struct Grid {
    /// Max cells that the largest triangle spans along an axis: bounds the work of one operation.
    static constexpr double max_cells_across = 24;
    /// Two triangles count as nearly folded together if the cosine of the angle between them at their common
    /// edge exceeds this. Its 120 degrees are wide enough that no operation gets past it unseen, and most
    /// edges are flatter.
    static constexpr double min_narrow_cosine = -0.5;
    /// Degrees: dihedral angles around an edge that add up to more than this overlap. The excess is more than
    /// rounding.
    static constexpr double full_turn = 360.001;
  };

  /// Samples of the input's surface.
  struct Samples {
    /// Samples for each equilateral triangle with the target edge. The simplified mesh's triangles are about
    /// twice as large: more than 12 samples each do not improve the result, 8 make it 5 % worse.
    static constexpr double per_triangle = 6;
    /// Distance, in mean edges of the input mesh's surface, within which the mesh and the given surface
    /// correspond: trades parts of the surface that are lost for caps of holes that are taken for it.
    static constexpr double correspondence_edges = 2;
  };

  /// Feature edges and corners between patches.
  struct Features {
    /// Max distance of a feature segment from the input's feature edges, as a share of the mesh's diagonal
    /// (README, Invariants). Smaller values keep more segments.
    static constexpr double max_segment_share = 0.001;
    /// Parameters along a segment at which its distance from the feature edges is sampled: more cost a query
    /// of a tree each.
    static constexpr double segment_parameters[] = {0.25, 0.5, 0.75};
    /// Min quality of tets, by any objective, when points are fitted to feature edges: shapes recover.
    static constexpr float fitting_floor = 1e-4f;
    /// Sweeps of fit_to_crease() before the closing. After a point has arrived, its neighbours may have more
    /// room.
    static constexpr int closing_sweeps = 3;
  };

  /// Edge and face removals beyond the basic flips of the paper, section 4.
  struct Flips {
    /// Max tets of a ring within one material: the best triangulation takes time cubic in this. Not above
    /// RingTriangulation::max_points - 1.
    static constexpr std::size_t max_ring = 7;
    /// Max faces removed at once: bounds the time and the write set.
    static constexpr std::size_t max_faces = 5;
  };

  /// Collapses.
  struct Collapses {
    /// Max targets that are tried, in the order of their weight: trades time for collapses that only a later
    /// target allows (README, The tuned schedule).
    static constexpr std::size_t max_targets = 4;
    /// Likewise in improvement, where few tets are left: covers all neighbours of nearly every point.
    static constexpr std::size_t relaxed_max_targets = 30;
    /// Relaxed bound E of collapses and edge removals in improvement, and max distance by which they move the
    /// surface away from the reference; both in usual edges. Larger values free more tets and move the
    /// surface farther.
    static constexpr double relaxed_error_edges = 12;
    static constexpr double relaxed_distance_edges = 0.3;
  };

  /// Insertion of points.
  struct Insertion {
    /// Min factor on the worst quality for a new point: it costs tets.
    static constexpr float min_gain = 1.05f;
    /// Max number of tets that a cavity gains by growing (Klingner & Shewchuk 2007, section 3.3): bounds the
    /// time and the write set of one insertion.
    static constexpr std::size_t max_grown = 24;
  };

  /// Moves of a point to better shapes.
  struct Smoothing {
    static constexpr int steps = 3;  ///< whole, half and quarter step towards the neighbours' centroid

    // The ascent of the worst quality. More of each finds slightly better positions in more time.
    static constexpr int max_ascents = 8;      ///< max steps uphill
    static constexpr int max_backsteps = 4;    ///< max halvings of a failed step
    static constexpr double first_step = 0.3;  ///< in shortest edges
    /// Step of the finite differences, in shortest edges: shorter ones trade curvature for rounding.
    static constexpr double difference_step = 1e-5;
    /// Factor on the worst quality up to which a tet's gradient counts, and max number of them.
    static constexpr float active_within = 1.15f;
    static constexpr std::size_t max_active = 8;
    /// Max iterations for the shortest vector of the gradients' hull (Gilbert 1966).
    static constexpr int hull_steps = 12;
    /// Relative gain of the worst quality below which the ascent ends.
    static constexpr float min_step_gain = 1e-3f;
    /// Min factor on the worst quality that is worth another round.
    static constexpr float min_gain = 1.01f;
    /// Max distance from which a point is projected back onto its surface, in shortest edges: from farther it
    /// might reach another part.
    static constexpr double projection_reach = 0.5;
  };

  /// Moves of a point to where its triangles' samples are nearest.
  struct Fitting {
    static constexpr double reach = 1;  ///< max step, in shortest edges
    static constexpr int steps = 3;     ///< whole, half and quarter step
    /// Regularisation: share of the trace of the normal equations' matrix that is added to its diagonal. Less
    /// lets points slide along flat parts, more shortens their steps.
    static constexpr double flat_share = 0.01;
    /// Min step, in edges: shorter ones are not worth their tests.
    static constexpr double min_step = 0.01;
    /// Share of its quality that a move must leave to a worst tet that is below the floor already.
    static constexpr float kept_quality = 0.999f;
  };

  /// Batches of the block runner. README, Batches, has the conflicts by spacing and by size.
  struct Batches {
    /// M: a batch has one of that many neighbouring items. A larger M makes fewer conflicts, but the batches
    /// of a block then reach over more memory: 24 times a batch of points still fits into a core's cache. For
    /// tets conflicts cost more than cache misses: there are five times as many tets, an operation on one
    /// changes those around its four points, and tets around an edge are neighbours in the list.
    static constexpr std::size_t point_spacing = 24, tet_spacing = 256;
    /// Items of a batch: enough to keep several threads busy, few enough for the cache. Blocks that exceed
    /// the cache in any case get larger batches.
    static constexpr std::size_t min_size = 256, max_size = 1024, batches_of_large_blocks = 1024;
    /// Items of a batch in the order given, where each item takes ten times as long and earlier failures are
    /// tried again.
    static constexpr std::size_t min_ordered_size = 16, max_ordered_size = 1024, ordered_batches = 16;
    /// Share of a batch's proposals that may lose: above it the next batch is smaller, below half of it
    /// larger. Losers are decided twice, and in a mesh of few points, or around points of many tets, large
    /// batches have hardly any winners.
    static constexpr double max_lost_share = 0.3;
    /// Min size of a reduced batch.
    static constexpr std::size_t min_shrunk_size = 16;
    /// Items that a thread decides, and winners that it commits, at a time. No result depends on them.
    static constexpr std::size_t chunk_in_order = 2, chunk_shuffled = 16, commit_chunk = 16;
    /// Min number of chunks that is worth waking other threads.
    static constexpr std::size_t min_parallel_chunks = 3;
  };

  /// The loop of both schedules, from the paper or for details that it leaves open.
  struct Schedules {
    /// Increment of the share of bad tets in each iteration, percent: the paper, Figure 3.
    static constexpr double percent_step = 10;
    /// Initial probability of an action that leaves a worse tet, where the paper allows such "early in
    /// computation": p0 of p0 ln(n/N) / ln(n0/N). The paper names no number; larger values trade shapes for
    /// fewer iterations.
    static constexpr double first_annealing = 0.3;
    /// Upper limit of E for gamma 10, in working coordinates, in which every coordinate is below 2 in
    /// magnitude: beyond it nothing is refused any more.
    static constexpr double max_useful_error = 200;
    /// Max consecutive iterations that each remove less than this share of the tets: trades the last tets for
    /// time.
    static constexpr int max_idle_iterations = 3;
    static constexpr double idle_below = 0.003;
  };

  /// The paper's schedule.
  struct PaperSchedule {
    /// Half width of the band around the target, once it is reached: actions that leave it are refused. Keeps
    /// the count within 1 %.
    static constexpr double count_slack = 0.005;
  };

  /// The loop of the tuned schedule (README, The tuned schedule).
  struct TunedLoop {
    static constexpr double first_error_edges = 4;  ///< initial E, in edges
    /// E's factor after an iteration that removed too little, and the share of the tets below which that is
    /// so. The paper's cube root of the remaining reduction lets E explode.
    static constexpr double error_growth = 1.3, min_removed = 0.15;
    /// Inverse of the share of collapses refused for E above which a larger E is worth another iteration.
    static constexpr std::size_t error_refusals_inverse = 10;
    /// Max percentage of tets that flips and smoothing work on, and multiple of the target above which they
    /// are wasted. From 10 times the target and of all bad tets: twice the time of the last iterations for
    /// the same result after improvement.
    static constexpr double flip_percent = 40, flips_below = 2;
    /// Share of the worst Quality^3 that annealing must leave. Below this value (0: anything positive) the
    /// loop ends with 5-10 % of tets under 0.1 sr instead of 2-3 %; larger values need a larger E to reach
    /// the target, which costs surface and volume.
    static constexpr float annealing_floor = 0.1f;
    /// TetQuality::needle_angle, steradians: without it thin layers of tiny tets end as needles with hardly
    /// any angle.
    static constexpr double needle_angle = 0.02;
    /// E over the max distance by which a collapse may move the surface at the removed point. On five scans
    /// (10,000 tets) the max distance ended at 1.3-2.2 % of the diagonal without it, at 1.0-1.7 % with it;
    /// larger values drive E up instead.
    static constexpr double distance_weight = 50;
    /// Multiple of the target below which triangles own samples of the input's surface: until then E keeps
    /// surfaces near enough, and samples from the start would take twice the time for nothing.
    static constexpr double samples_below = 8;
    /// Initial DeviationBound::max, in edges, and its factor after an iteration that removed too
    /// little. Bunny and armadillo to 10K, mean of the max distances both ways in percent of the diagonal:
    /// 0.38 with these values, 0.43 with 0.2 and 1.1, 0.33 with 0.18 and 1.05, which takes longer and leaves
    /// less room for shapes.
    static constexpr double first_deviation = 0.2, deviation_growth = 1.05;
    /// Multiple of the target below which every iteration fits surfaces: fitting from 4 times the target on
    /// makes the result no better, no fitting in the loop makes it 10 % worse.
    static constexpr double fits_below = 2;
    /// VolumeLedger::utilization() above which the loop fits surfaces: before a material's bound is used up.
    static constexpr double fit_above_utilization = 0.6;
  };

  /// The tuned schedule with a tolerance (SimplifyOptions::tolerance), or without a count.
  struct Tolerance {
    /// Share of the tolerance that samples may be off in the loop, and in the closing, which needs room for
    /// shapes: between samples surfaces may be farther, on scans by up to 15 %.
    static constexpr double loop_share = 0.8, closing_share = 0.87;
    /// Max tolerance, as a share of the diagonal: larger ones bound nothing, and their samples would be too
    /// few to fit to.
    static constexpr double max_diagonal_share = 0.1;
    /// Max edge, in sampled tolerances, whose triangles set the density of samples, and distance between the
    /// tested points of triangles. With 4 and 1 the bunny at 0.5 % is up to 4.6 % farther between them, with
    /// these values 1 %.
    static constexpr double to_edge = 2.5, between_places = 0.5;
    /// Without a count: ratio of successive targets, and the share of the tets below which an iteration over
    /// all of them ends a stage. The last value is for target lengths: rounds of edge length adaptation do
    /// the rest.
    static constexpr double stage_share = 0.6, stage_min_removed = 0.1, sized_min_removed = 0.01;
    /// Share of bad tets above which annealing accepts no worse ones, without a count: only the tolerance
    /// ends that loop, and on the way to where it refuses everything, the bunny at 0.2 % had 41 % of bad
    /// tets, for 23 % fewer tets.
    static constexpr double max_bad_share = 0.25;
  };

  /// Shares of a time limit, if there is one.
  struct TimeLimit {
    /// Share of the loop. The closing takes about as long as the last fifth of the loop.
    static constexpr double loop_share = 0.75;
    /// Share of loop and closing together if the result is compared with a tolerance.
    static constexpr double changing_share = 0.8;
  };

  /// The improvement that closes the tuned schedule.
  struct Closing {
    /// Max relative deviation from the target count: collapses are what removes the last slivers on flat
    /// boundaries. Keeps the count well within 1 %.
    static constexpr double slack = 0.006;
    /// Max relative change of the count if none was asked for.
    static constexpr double free_slack = 1;
    static constexpr int max_rounds = 40;
    /// Multiple of the bound below which tets are worked on: dihedral angles up to 25 degrees. With 1.5 (30
    /// degrees) the closing takes half as long again and the surface moves a quarter farther (README,
    /// Improvement).
    static constexpr double margin = 1.27;
    /// Sweeps of fit_to_samples() before improvement and after it: better shapes cost fit.
    static constexpr int sweeps_before = 1, sweeps_after = 2;
  };

  /// improve().
  struct Improve {
    /// Multiple of the bound below which points may leave the surface for a tet: dihedral angles up to 30
    /// degrees. In the closing that would move the surface a quarter farther.
    static constexpr double margin = 1.5;
    /// Factor between successive bounds: trades rounds for working on the worst tets first.
    static constexpr double bound_step = 1.18;
    /// Min value of the first bound, steradians, for a --min-solid-angle of nearly 0.
    static constexpr double min_first_bound = 1e-3;
    /// Share of bad tets above which it begins in bulk. Scans and results of other programs initially have up
    /// to 32 % of tets below 0.15 sr; on these, improvement without bulk takes half the time.
    static constexpr double bulk_before = 0.4;
    /// Solid angle, steradians, below which it finally works on all tets, with cheap operations only: the
    /// mean rises by 0.01 sr. The rounds would take four times as long as everything before to gain that much
    /// again.
    static constexpr double polish_below = 0.2;
    static constexpr int max_polish_rounds = 3;
    /// Max rounds reserved for that and for the rounds after it.
    static constexpr int max_last_rounds = 20;
    /// Another call of the Remesher is made only if the last one left less than this fraction of the bad
    /// tets.
    static constexpr double min_call_gain = 0.95;
    /// Min and max factor on the count with ImproveOptions::free_count, so that no detail is lost on the way
    /// and no mesh grows for ever.
    static constexpr double min_free = 0.8, max_free = 4;
    /// Max relative change of the count; 5 % are promised.
    static constexpr double slack = 0.045;
    /// E, in edges of a regular mesh of that count: the paper's initial E.
    static constexpr double error_edges = 1;
  };

  /// The rounds of run_improvement(), worst tets first.
  struct ImprovementRounds {
    /// After a round that leaves more than this share of the bad tets, the next one also flips tets around
    /// them at random and moves all points around, to free tets that are stuck.
    static constexpr double stuck_above = 0.8;
    /// Factor on the target quality for tets left by collapses that make room for insertions: without it they
    /// would be the next bad ones.
    static constexpr float thinning_margin = 1.1f;
    /// Min share of the bad tets that a round must fix to count as gain. All limits of rounds without gain
    /// trade the last bad tets for time.
    static constexpr double min_gain = 0.02;
    /// Share of bad tets above which many are bad, and then the min gain and the max rounds without gain.
    static constexpr double many_bad = 0.01, min_gain_of_many = 0.05;
    static constexpr int max_idle_of_many = 4;
    /// Max rounds without gain: while tets are below ImprovementPlan::leave_surface_angle, and otherwise.
    static constexpr int max_idle = 8, max_idle_when_good = 2;
    /// Share of bad tets below which few are bad, and then the max rounds without gain: such rounds take
    /// hardly any time.
    static constexpr double few_bad = 5e-4;
    static constexpr int max_idle_of_few = 30;
    /// Share of the target quality that perturbation must leave: it frees twice as many of the last bad tets
    /// as the whole would, and tets below the target are repaired at once.
    static constexpr float perturbed_share = 0.95f;
    /// Share of the allowed decrease of the count that is reserved for the last resort: edge removals would
    /// use up all of it, and no collapse could remove the last slivers.
    static constexpr double kept_share = 0.125;
    /// Growth of DeviationBound::max with each last-resort round, and its max factor: the last slivers
    /// of fine detail need room. Unlimited growth would double the max distance.
    static constexpr double deviation_growth = 1.25, max_deviation_factor = 3;
  };

  /// run_bulk_improvement(): all bad tets in random order. README, Improvement, has its effect.
  struct BulkRounds {
    /// Max rounds of each bulk phase.
    static constexpr int max_rounds = 30;
    /// Share of the tets still below the bound above which the second bulk phase runs.
    static constexpr double again_above = 0.01;
    /// Share of bad tets above which sizes are changed; below it only shapes are improved.
    static constexpr double resize_above = 0.01;
    /// A round gains too little if it leaves more than this share of the bad tets; max number of such rounds.
    static constexpr double idle_above = 0.9;
    static constexpr int max_idle = 2;
    /// In edges of the regular tet with the mean volume of the tets around: edges of the surface above the
    /// first are split, and a point with an edge below the second is crowded.
    static constexpr double long_edge = 1.6, short_edge = 0.6;
    /// Share of the worst quality that splits and collapses must leave: halves of a tet are hardly better
    /// than the whole, but flips and smoothing then improve them.
    static constexpr float resize_floor = 0.5f;
  };

  /// Edge length adaptation (README, Edge lengths).
  struct Adaptation {
    /// Edges are halved about twice in three rounds: enough for edges a million times too long.
    static constexpr int max_rounds = 60;
    /// Share of the edges, each counted once for each of its tets, that may violate a size field; none may
    /// violate a bound.
    static constexpr double max_violating_share = 0.002;
    /// A round gains too little if it leaves more than this share of the excess after the best round before;
    /// max number of such rounds.
    static constexpr double idle_above = 0.97;
    static constexpr int max_idle = 2;
    /// Share of the shape bound that collapses and splits must leave. Flips and smoothing repair the shapes.
    static constexpr float floor = 0.3f;
    static constexpr int shape_rounds = 2;  ///< of flips and smoothing after each round: more take time
  };

  /// Local refinement.
  struct Refinement {
    static constexpr int max_rounds = 8;  ///< README, The tuned schedule: "up to eight times"
    /// Max share and max number of tets with far faces (the larger counts): above, local refinement does not
    /// help.
    static constexpr double max_far_share = 0.02, max_far_tets = 100;
    static constexpr int far_fits = 2;  ///< fitting sweeps after each round
    /// Max rounds without gain: each halves edges farther around.
    static constexpr int max_idle = 2;
    /// Share of the shape bound that halved tets must have. Flips and smoothing improve them.
    static constexpr float split_floor = 0.3f;
  };

  /// Calls of a Remesher.
  struct Remeshing {
    /// Factors on min_solid_angle: tets below the first are improved, as in closing, and for tets below the
    /// second points may leave the surface a little.
    static constexpr double bad_margin = 1.27, leave_surface_margin = 1;
    /// Share of the bound that coarsening and refining must leave of shapes that were good.
    static constexpr double floor_share = 0.3;
    /// Factors on the size: shorter edges are collapsed, longer ones halved. Halving makes none that would be
    /// collapsed again (Botsch & Kobbelt 2004, 4/5 and 4/3).
    static constexpr double short_edge = 0.8, long_edge = 4.0 / 3;
    /// Max distance of new triangles from the surface that the call found, in sizes, when coarsening: trades
    /// the surface for the size of its edges.
    static constexpr double coarsening_distance = 0.1;
    /// Share of bad tets above which improvement begins in bulk, as in improve().
    static constexpr double bulk_before = 0.4;
    /// Max rounds: bound the time of a call for lengths far from the size.
    static constexpr int max_coarsening_rounds = 12, max_refining_rounds = 12;
  };

  /// Fields and points of a Remesher.
  struct Transfer {
    /// Max tets of a leaf of the tree of old tets: trades its depth for tests in a leaf.
    static constexpr std::size_t leaf_tets = 4;
    /// Passes of the correction: the first leaves rounding errors of the values, the second those of the sum.
    static constexpr int correction_passes = 2;
    /// Distances from a plane below this share of the largest are rounding errors of coordinates.
    static constexpr double plane_rounding = 1e-13;
    /// Points of a leaf of the tree of points: max, max at first, and max of two leaves that are merged. The
    /// gaps between them keep a leaf from being split and merged by turns.
    static constexpr std::size_t leaf_points = 32, first_leaf_points = 20, joined_points = 12;
  };
};

}  // namespace tetwright
