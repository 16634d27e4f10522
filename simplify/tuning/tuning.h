// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace tetwright {

/// The tuned constants of simplify/, a group for each stage, in the order of the folders. Each comment gives
/// the unit and the source: a paper, a measurement, or else the trade-off. "The paper" is Cutler, Dorsey &
/// McMillan 2004; README means simplify/README.md. Ratios have no unit unless one is named. "Edges" as a unit
/// are edges of a regular mesh of the target count (TetQuality::ideal_edge) unless stated otherwise.
///
/// Changing a constant changes the bytes of the output, except for Memory and the chunks of Batches.
/// Tolerances for rounding that several libraries share are in common/tolerances.h; sizes of tables are next
/// to their tables.
struct SimplifyTuning {
  /// Items that a parallel loop hands out at a time: enough to outweigh the handing out, few enough to keep
  /// all threads busy to the end. Sums over slots are added up in these blocks, which decides their rounding.
  struct Grains {
    static constexpr std::size_t slots = 8192;              ///< slots of tets or points
    static constexpr std::size_t surface_triangles = 4096;  ///< records of the grid, faces of a projection
    static constexpr std::size_t samples = 1024;            ///< each needs a query of a tree
    static constexpr std::size_t transferred_tets = 64;     ///< each is intersected with many others
  };

  /// Memory estimates, bytes. Work that would not fit is refused before it begins.
  struct Memory {
    /// Peak of the process: its libraries, and for each input tet the editable mesh together with the input
    /// from which it is made. README, Memory, compares both with measurements.
    static constexpr double program_bytes = 40e6;
    static constexpr double bytes_per_tet = 105;
    /// Per sample, with all associated data: 190 measured for 7 million samples on a cube.
    static constexpr double bytes_per_sample = 200;
  };

  /// Slots of the mesh's arrays. Free slots cost memory; without them arrays must grow, which copies them.
  struct Slots {
    /// Fraction of dead slots among used ones above which the mesh is compacted: trades the time of
    /// compaction for dense memory.
    static constexpr double compact_above = 0.3;
    /// Free slots left for operations that add elements: the inverse of their ratio to live slots, and their
    /// min number.
    static constexpr std::size_t spare_inverse = 16, min_spare = 4096;
    /// Initial free slots of a Remesher, likewise. Beyond them its arrays grow in place.
    static constexpr std::size_t remesher_spare_inverse = 64, remesher_min_spare = 4096;
    /// Min slots by which arrays grow: more than a batch needs, but negligible relative to large meshes.
    static constexpr std::size_t growth = 4096;
  };

  /// Local copies of stars.
  struct Stars {
    /// Max number of link points: larger stars are not worth the time.
    static constexpr std::size_t max_points = 500;
    /// Max number of tets that the link condition visits in the target's star, likewise.
    static constexpr std::size_t max_walk = 2000;
  };

  /// Bounds of edge lengths, as ratios of length to target length.
  struct EdgeLengths {
    /// Edges between these are left unchanged. Halving an edge above the upper one makes none below the lower
    /// one, as in Botsch & Kobbelt 2004. Their 4/5 and 4/3 are narrower than the factor of 1.5 that is
    /// required (README, Edge lengths).
    static constexpr double short_edge = 0.7, long_edge = 1.48;
    /// Fraction of the min length that new edges may have if the proposal removes an edge that is too long:
    /// halving an edge of flat tets makes short edges, and no other operation shortens it.
    static constexpr double short_share_beside_long = 0.5;
    /// Ratio of a well-shaped mesh's edges to the cube root of its mean tet volume. Measured on meshes made
    /// for target lengths: with this value the median edge has the target length.
    static constexpr double edge_to_ideal = 2.1;
  };

  /// Volumes of materials.
  struct Volumes {
    /// Max relative change of a material's volume (README, Invariants): 1 % is guaranteed.
    static constexpr double max_change = 0.008;
  };

  /// The grid of surface triangles.
  struct Grid {
    /// Max ratio of the surface's size to that of triangles, as a power of 2: smaller ones count as being of
    /// this size, so that a few tiny ones add no levels.
    static constexpr int max_ratio = 16;
    /// Cells of the lowest level, in the smallest triangles. Half as many mean more levels and 5 % more time.
    static constexpr double smallest_cell = 8;
    /// Two triangles count as nearly folded together if the cosine of the angle between them at their common
    /// edge exceeds this. Its 120 degrees are wide enough that no operation passes undetected, and most edges
    /// are flatter.
    static constexpr double min_narrow_cosine = -0.5;
    /// Degrees: dihedral angles around an edge that add up to more than this overlap. The excess allows for
    /// rounding.
    static constexpr double full_turn = 360.001;
  };

  /// Samples of the input's surface.
  struct Samples {
    /// Samples for each equilateral triangle with the target edge. The simplified mesh's triangles are about
    /// twice as large. More than 12 samples each do not improve the result; 8 make it 5 % worse.
    static constexpr double per_triangle = 6;
    /// Distance, in mean edges of the input mesh's surface, within which the mesh and the given surface
    /// correspond. Smaller values miss parts of the surface; larger ones mistake caps of holes for it.
    static constexpr double correspondence_edges = 2;
  };

  /// Feature edges and corners between patches.
  struct Features {
    /// Max distance of a feature segment from the input's feature edges, as a share of the mesh's diagonal
    /// (README, Invariants). Smaller values preserve more segments.
    static constexpr double max_segment_share = 0.001;
    /// Parameters along a segment at which its distance from the feature edges is sampled. Each costs a tree
    /// query.
    static constexpr double segment_parameters[] = {0.25, 0.5, 0.75};
    /// Max width of a strip between a crease of a body and a curve between labels that is closed, as a share
    /// of the curve's edges: a wider one has well-shaped triangles.
    static constexpr double max_strip_width = 0.5;
    /// Min quality of tets, for any objective, when points are fitted to feature edges. Shapes are improved
    /// later.
    static constexpr float fitting_floor = 1e-4f;
    /// Sweeps of fit_to_crease() before the final improvement. Once a point has reached its feature edge, its
    /// neighbours may have more room.
    static constexpr int closing_sweeps = 3;
    /// Cosine of the turn, 45 degrees, above which a point of a sheet's border or of a curve in which sheets
    /// meet is a corner: the turn that makes corners of creases (SurfaceCreases).
    static constexpr double sheet_corner_cosine = 0.70710678118654752;
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
    /// Max targets that are tried, in ascending order of weight: trades time for collapses that only a later
    /// target allows (README, The tuned schedule).
    static constexpr std::size_t max_targets = 4;
    /// Likewise in improvement, which works on few tets: covers all neighbours of nearly every point.
    static constexpr std::size_t relaxed_max_targets = 30;
    /// Relaxed bound E of collapses and edge removals in improvement, and max distance by which they move the
    /// surface away from the reference; both in typical edges. Larger values free more tets and move the
    /// surface farther.
    static constexpr double relaxed_error_edges = 12;
    static constexpr double relaxed_distance_edges = 0.3;
  };

  /// Insertion of points.
  struct Insertion {
    /// Min factor on the worst quality for a new point, since it costs tets.
    static constexpr float min_gain = 1.05f;
    /// Max number of tets that a cavity gains by growing (Klingner & Shewchuk 2007, section 3.3): bounds the
    /// time and the write set of one insertion.
    static constexpr std::size_t max_grown = 24;
  };

  /// Moves of a point to better shapes.
  struct Smoothing {
    static constexpr int steps = 3;  ///< whole, half and quarter step towards the neighbours' centroid

    // Ascent of the worst quality. Larger limits find slightly better positions in more time.
    static constexpr int max_ascents = 8;      ///< max steps uphill
    static constexpr int max_backsteps = 4;    ///< max halvings of a failed step
    static constexpr double first_step = 0.3;  ///< in shortest edges
    /// Step of the finite differences, in shortest edges: shorter ones trade truncation error for rounding
    /// error.
    static constexpr double difference_step = 1e-5;
    /// Factor on the worst quality up to which a tet's gradient counts, and max number of such gradients.
    static constexpr float active_within = 1.15f;
    static constexpr std::size_t max_active = 8;
    /// Max iterations for the shortest vector of the gradients' hull (Gilbert 1966).
    static constexpr int hull_steps = 12;
    /// Relative gain of the worst quality below which the ascent ends.
    static constexpr float min_step_gain = 1e-3f;
    /// Min factor on the worst quality for which a move is accepted.
    static constexpr float min_gain = 1.01f;
    /// Max distance from which a point is projected back onto its surface, in shortest edges: from farther
    /// away it might reach another part.
    static constexpr double projection_reach = 0.5;
  };

  /// Junction curves of the mesh and of a reference surface.
  struct Projection {
    /// A junction edge of the mesh follows a curve of the reference surface if that is this close to its
    /// middle, edges: half an edge, since other curves are at least a cell away.
    static constexpr double same_curve_share = 0.5;
    /// Faces whose edges are sorted at a time, with about 200 bytes for each.
    static constexpr std::size_t faces_at_once = std::size_t{1} << 21;
  };

  /// Moves of a point that fit its triangles to their samples.
  struct Fitting {
    static constexpr double reach = 1;  ///< max step, in shortest edges
    static constexpr int steps = 3;     ///< whole, half and quarter step
    /// Regularisation: fraction of the trace of the normal equations' matrix that is added to its diagonal.
    /// Smaller values let points slide along flat parts, larger ones shorten their steps.
    static constexpr double flat_share = 0.01;
    /// Min step, in edges: shorter steps are not worth the tests.
    static constexpr double min_step = 0.01;
    /// Fraction of the worst quality that a move must keep if it is already below the floor.
    static constexpr float kept_quality = 0.999f;
  };

  /// Batches of the block runner. README, Batches, has the conflicts by spacing and by size.
  struct Batches {
    /// M: a batch contains one of that many neighbouring items. A larger M causes fewer conflicts, but a
    /// batch then spans more memory: 24 times a batch of points still fits into a core's cache. For tets,
    /// conflicts cost more than cache misses: there are five times as many tets, an operation on one changes
    /// those around its four points, and tets around an edge are neighbours in the list.
    static constexpr std::size_t point_spacing = 24, tet_spacing = 256;
    /// Items of a batch: enough to keep several threads busy, few enough for the cache. Blocks that exceed
    /// the cache anyway get larger batches.
    static constexpr std::size_t min_size = 256, max_size = 1024, batches_of_large_blocks = 1024;
    /// Items of a batch in the given order, where each item takes ten times as long and earlier failures are
    /// retried.
    static constexpr std::size_t min_ordered_size = 16, max_ordered_size = 1024, ordered_batches = 16;
    /// Fraction of a batch's proposals that may lose: above it the next batch is smaller, below half of it
    /// larger. Losers are decided twice. In a mesh of few points, or around points of many tets, large
    /// batches have hardly any winners.
    static constexpr double max_lost_share = 0.3;
    /// Min size of a reduced batch.
    static constexpr std::size_t min_shrunk_size = 16;
    /// Items that a thread decides, and winners that it commits, at a time: some ten microseconds, so that
    /// the smallest batch has work for 64 threads. Results do not depend on these.
    static constexpr std::size_t chunk_in_order = 2, chunk_shuffled = 4, commit_chunk = 4;
    /// Min number of items or winners that is worth waking other threads.
    static constexpr std::size_t min_parallel_in_order = 5, min_parallel_shuffled = 33;
  };

  /// The block iteration of both schedules: values from the paper, and for details that it leaves open.
  struct Schedules {
    /// Increment of the share of bad tets in each iteration, percent: the paper, Figure 3.
    static constexpr double percent_step = 10;
    /// Initial probability of accepting an operation that leaves a worse tet, which the paper allows "early
    /// in computation": p0 in p0 ln(n/N) / ln(n0/N). The paper gives no value; larger values trade shapes for
    /// fewer iterations.
    static constexpr double first_annealing = 0.3;
    /// Upper limit of E for gamma 10, in working coordinates, which are below 2 in magnitude: a larger E
    /// refuses nothing.
    static constexpr double max_useful_error = 200;
    /// Max consecutive iterations that each remove less than this fraction of the tets: trades the last tets
    /// for time.
    static constexpr int max_idle_iterations = 3;
    static constexpr double idle_below = 0.003;
  };

  /// The paper's schedule.
  struct PaperSchedule {
    /// Relative half-width of the band around the target once it is reached: operations that leave the band
    /// are refused. Keeps the count within 1 %.
    static constexpr double count_slack = 0.005;
  };

  /// The loop of the tuned schedule (README, The tuned schedule).
  struct TunedLoop {
    static constexpr double first_error_edges = 4;  ///< initial E, in edges
    /// Factor on E after an iteration that removed too little, and the fraction of the tets that defines too
    /// little. With the paper's cube root of the remaining reduction, E explodes.
    static constexpr double error_growth = 1.3, min_removed = 0.15;
    /// Inverse of the fraction of collapses refused because of E above which a larger E is worth another
    /// iteration.
    static constexpr std::size_t error_refusals_inverse = 10;
    /// Max percentage of tets on which flips and smoothing work, and multiple of the target above which they
    /// are wasted. Working on all bad tets from 10 times the target on doubles the time of the last
    /// iterations for the same result after improvement.
    static constexpr double flip_percent = 40, flips_below = 2;
    /// Fraction of the tets that a stalled iteration must remove to be repeated with larger bounds alone,
    /// above `flips_below`. With 1 (flips of all bad tets whenever collapses stall) 60 % of a loop went into
    /// flips where thin labels stall it from 9 times the target on; with 0.02 its result is the same.
    static constexpr double bounds_remove = 0.02;
    /// Fraction of the worst Quality^3 that annealing must keep. With smaller values (0: any positive
    /// quality) the loop ends with 5-10 % of the tets below 0.1 sr instead of 2-3 %. Larger values need a
    /// larger E to reach the target, at the expense of surface and volume accuracy.
    static constexpr float annealing_floor = 0.1f;
    /// TetQuality::needle_angle, steradians: without it, thin layers of tiny tets end as needles with tiny
    /// solid angles.
    static constexpr double needle_angle = 0.02;
    /// Ratio of E to the max distance by which a collapse may move the surface at the removed point. On five
    /// scans (10,000 tets) the final max distance was 1.3-2.2 % of the diagonal without this bound and
    /// 1.0-1.7 % with it; larger values increase E instead.
    static constexpr double distance_weight = 50;
    /// Multiple of the target below which triangles own samples of the input's surface. Above it E keeps
    /// surfaces near enough, and samples from the start would take twice the time without benefit.
    static constexpr double samples_below = 8;
    /// Initial DeviationBound::max, in edges, and its factor after an iteration that removed too little. For
    /// bunny and armadillo at 10,000 tets, the mean of the max distances in both directions, in percent of
    /// the diagonal, is 0.38 with these values, 0.43 with 0.2 and 1.1, and 0.33 with 0.18 and 1.05, which
    /// takes longer and leaves less room for shapes.
    static constexpr double first_deviation = 0.2, deviation_growth = 1.05;
    /// Multiple of the target below which every iteration fits surfaces. Fitting from 4 times the target on
    /// does not improve the result; no fitting in the loop makes it 10 % worse.
    static constexpr double fits_below = 2;
    /// VolumeLedger::utilization() above which the loop fits surfaces, before a material's bound is used up.
    static constexpr double fit_above_utilization = 0.6;
  };

  /// The tuned schedule with a tolerance (SimplifyOptions::tolerance), or without a count.
  struct Tolerance {
    /// Fraction of the tolerance allowed at samples in the loop, and in the final improvement, which needs
    /// room for shapes. Between samples surfaces may be farther apart, on scans by up to 15 %.
    static constexpr double loop_share = 0.8, closing_share = 0.87;
    /// Max tolerance, as a fraction of the diagonal: larger ones bound nothing, and would give too few
    /// samples for fitting.
    static constexpr double max_diagonal_share = 0.1;
    /// In units of the tolerance at samples: max edge length of the triangles that determine the sample
    /// density, and distance between tested points of triangles. With 4 and 1, distances between these points
    /// exceed the bound by up to 4.6 % (bunny at 0.5 %), with these values by 1 %.
    static constexpr double to_edge = 2.5, between_places = 0.5;
    /// Without a target count: ratio of successive targets, and the min fraction of the tets that an
    /// iteration over all of them must remove to continue a stage. The last value is for target lengths,
    /// where edge length adaptation follows.
    static constexpr double stage_share = 0.6, stage_min_removed = 0.1, sized_min_removed = 0.01;
    /// Without a target count: fraction of bad tets above which annealing accepts no worse tets. Only the
    /// tolerance ends that loop; without this limit, the bunny at 0.2 % ended with 41 % bad tets and 23 %
    /// fewer tets.
    static constexpr double max_bad_share = 0.25;
  };

  /// Fractions of a time limit, if there is one.
  struct TimeLimit {
    /// Fraction for the loop. The final improvement takes about as long as the last fifth of the loop.
    static constexpr double loop_share = 0.75;
    /// Fraction for loop and final improvement together if the result is compared with a tolerance.
    static constexpr double changing_share = 0.8;
  };

  /// The final improvement of the tuned schedule.
  struct Closing {
    /// Max relative deviation from the target count. It allows collapses, which alone remove the last slivers
    /// on flat boundaries, and keeps the count well within 1 %.
    static constexpr double slack = 0.006;
    /// Max relative change of the count if there is no target count.
    static constexpr double free_slack = 1;
    static constexpr int max_rounds = 40;
    /// Multiple of the bound below which tets are worked on: dihedral angles up to 25 degrees. With 1.5 (30
    /// degrees) the final improvement takes 1.5 times as long and the surface moves a quarter farther
    /// (README, Improvement).
    static constexpr double margin = 1.27;
    /// Sweeps of fit_to_samples() before and after improvement, which worsens the fit.
    static constexpr int sweeps_before = 1, sweeps_after = 2;
  };

  /// improve().
  struct Improve {
    /// Multiple of the bound below which points may leave the surface for a tet: dihedral angles up to 30
    /// degrees. In the final improvement after simplification, this would move the surface a quarter farther.
    static constexpr double margin = 1.5;
    /// Factor between successive bounds: trades rounds for working on the worst tets first.
    static constexpr double bound_step = 1.18;
    /// Min value of the first bound, steradians, for a --min-solid-angle near 0.
    static constexpr double min_first_bound = 1e-3;
    /// Fraction of bad tets above which it begins with bulk improvement. Scans and results of other programs
    /// initially have up to 32 % of tets below 0.15 sr; on these, improvement without a bulk phase takes half
    /// the time.
    static constexpr double bulk_before = 0.4;
    /// Solid angle, steradians, below which it finally works on all tets, with cheap operations only: the
    /// mean rises by 0.01 sr. To gain that much again, more rounds would take four times as long as all
    /// previous work.
    static constexpr double polish_below = 0.2;
    static constexpr int max_polish_rounds = 3;
    /// Max rounds reserved for this polishing and the rounds after it.
    static constexpr int max_last_rounds = 20;
    /// The Remesher is called again only if the last call left less than this fraction of the bad tets.
    static constexpr double min_call_gain = 0.95;
    /// Min and max factor on the count with ImproveOptions::free_count, so that no detail is lost and no mesh
    /// grows without bound.
    static constexpr double min_free = 0.8, max_free = 4;
    /// Min factor while tets are still below the bound at the end: where most points are random ones between
    /// the faces of a coarse surface, good shapes need far fewer of them.
    static constexpr double min_free_of_bad = 0.5;
    /// Max relative change of the count; 5 % is guaranteed.
    static constexpr double slack = 0.045;
    /// E, in edges of a regular mesh of that count: the paper's initial E.
    static constexpr double error_edges = 1;
  };

  /// The rounds of run_improvement(), worst tets first.
  struct ImprovementRounds {
    /// After a round that leaves more than this fraction of the bad tets, the next one also flips tets around
    /// them at random and moves all points around them, to free tets that are stuck.
    static constexpr double stuck_above = 0.8;
    /// Factor on the target quality for tets left by collapses that make room for insertions. Without it
    /// these would become bad tets next.
    static constexpr float thinning_margin = 1.1f;
    /// Min fraction of the bad tets that a round must fix to count as a gain. All limits on rounds without
    /// gain trade the last bad tets for time.
    static constexpr double min_gain = 0.02;
    /// Fraction of bad tets above which many are bad; min gain and max rounds without gain in that case.
    static constexpr double many_bad = 0.01, min_gain_of_many = 0.05;
    static constexpr int max_idle_of_many = 4;
    /// Max rounds without gain: while tets are below ImprovementPlan::leave_surface_angle, and otherwise.
    static constexpr int max_idle = 8, max_idle_when_good = 2;
    /// Fraction of bad tets below which few are bad, and max rounds without gain in that case, as such rounds
    /// take hardly any time.
    static constexpr double few_bad = 5e-4;
    static constexpr int max_idle_of_few = 30;
    /// Fraction of the target quality that perturbation must keep. It frees twice as many of the last bad
    /// tets as 1 would, and tets below the target are repaired immediately.
    static constexpr float perturbed_share = 0.95f;
    /// Fraction of the allowed decrease of the count that is reserved for the last resort. Otherwise edge
    /// removals would use up all of it, and no collapse could remove the last slivers.
    static constexpr double kept_share = 0.125;
    /// Factor on DeviationBound::max after each last-resort round, and its max total factor, since the last
    /// slivers of fine detail need room. Unlimited growth would double the max distance.
    static constexpr double deviation_growth = 1.25, max_deviation_factor = 3;
  };

  /// run_bulk_improvement(): all bad tets in random order. README, Improvement, has its effect.
  struct BulkRounds {
    /// Max rounds of each bulk phase.
    static constexpr int max_rounds = 30;
    /// Fraction of tets still below the bound above which the second bulk phase runs.
    static constexpr double again_above = 0.01;
    /// Fraction of bad tets above which tets are also resized; below it only shapes are improved.
    static constexpr double resize_above = 0.01;
    /// A round gains too little if it leaves more than this fraction of the bad tets; max number of such
    /// rounds.
    static constexpr double idle_above = 0.9;
    static constexpr int max_idle = 2;
    /// In edges of the regular tet with the mean volume of the surrounding tets: surface edges longer than
    /// the first are split, and a point with an edge shorter than the second is crowded.
    static constexpr double long_edge = 1.6, short_edge = 0.6;
    /// Fraction of the worst quality that splits and collapses must keep. Halves of a tet are hardly better
    /// than the whole, but flips and smoothing then improve them.
    static constexpr float resize_floor = 0.5f;
  };

  /// Edge length adaptation (README, Edge lengths).
  struct Adaptation {
    /// Edges are halved about twice in three rounds: enough for edges a million times too long.
    static constexpr int max_rounds = 60;
    /// Fraction of the edges, each counted once for each of its tets, that may violate a size field. No edge
    /// may violate a bound.
    static constexpr double max_violating_share = 0.002;
    /// A round gains too little if it leaves more than this fraction of the excess after the best previous
    /// round; max number of such rounds.
    static constexpr double idle_above = 0.97;
    static constexpr int max_idle = 2;
    /// Fraction of the shape bound that collapses and splits must keep. Flips and smoothing repair the
    /// shapes.
    static constexpr float floor = 0.3f;
    static constexpr int shape_rounds = 2;  ///< of flips and smoothing after each round; more take time
  };

  /// Local refinement.
  struct Refinement {
    static constexpr int max_rounds = 8;  ///< README, The tuned schedule: "up to eight times"
    /// Max fraction and max number of tets with far faces, of which the larger applies. Above it, local
    /// refinement does not help.
    static constexpr double max_far_share = 0.02, max_far_tets = 100;
    static constexpr int far_fits = 2;  ///< fitting sweeps after each round
    /// Max rounds without gain: each halves edges in a larger neighbourhood.
    static constexpr int max_idle = 2;
    /// Fraction of the shape bound that halved tets must have. Flips and smoothing improve them.
    static constexpr float split_floor = 0.3f;
  };

  /// Calls of a Remesher.
  struct Remeshing {
    /// Factors on min_solid_angle: tets below the first are improved, as after simplification; for tets below
    /// the second, points may leave the surface slightly.
    static constexpr double bad_margin = 1.27, leave_surface_margin = 1;
    /// Fraction of the shape bound that coarsening and refining must keep if shapes were good.
    static constexpr double floor_share = 0.3;
    /// Factors on the size: shorter edges are collapsed, longer ones halved. Halved edges are not short
    /// enough to be collapsed again (Botsch & Kobbelt 2004, 4/5 and 4/3).
    static constexpr double short_edge = 0.8, long_edge = 4.0 / 3;
    /// Max distance of new triangles from the surface at the start of the call when coarsening, in sizes:
    /// trades surface accuracy for edge length.
    static constexpr double coarsening_distance = 0.1;
    /// Fraction of bad tets above which improvement begins with a bulk phase, as in improve().
    static constexpr double bulk_before = 0.4;
    /// Max rounds, which bound the time of a call if edge lengths are far from the size.
    static constexpr int max_coarsening_rounds = 12, max_refining_rounds = 12;
  };

  /// Fields and points of a Remesher.
  struct Transfer {
    /// Max tets in a leaf of the tree of old tets: trades depth for tests per leaf.
    static constexpr std::size_t leaf_tets = 4;
    /// Passes of the correction: the first leaves errors from rounding the values, the second only those of
    /// the sum.
    static constexpr int correction_passes = 2;
    /// Distances from a plane below this fraction of the largest are rounding errors of coordinates.
    static constexpr double plane_rounding = 1e-13;
    /// Points of a leaf of the point tree: max, max at construction, and max total of two leaves that are
    /// merged. The gaps prevent a leaf from being split and merged alternately.
    static constexpr std::size_t leaf_points = 32, first_leaf_points = 20, joined_points = 12;
  };
};

}  // namespace tetwright
