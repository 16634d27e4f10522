// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tetwright/loop_times.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/progress.h"
#include "tetwright/sizes.h"
#include "tetwright/surface_mesh.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Result of an attempted operation. Only `done` changes the mesh; the statistics count all results.
enum class Outcome : std::uint8_t {
  done,
  conflict,           ///< an earlier winner of the batch claimed part of its read set; retried
  stale,              ///< the element changed since it was listed
  no_candidate,       ///< the element does not admit this operation
  material_rule,      ///< the dimensions of point and edge forbid it (interfaces, junction curves, spanning
                      ///< edges)
  surface_error,      ///< Weight or Error above E
  inverts,            ///< a tet would become flat or negative
  quality,            ///< the worst tet would get worse and annealing did not accept it
  link_condition,     ///< the topology would change
  self_intersection,  ///< a boundary or interface triangle would intersect another
  no_room,            ///< never returned, since arrays grow; kept because the statistics' keys are fixed
  count,              ///< the number of tets would leave CountBounds
  too_large,          ///< the star or ring is too large to be worth the time
  volume,             ///< a material's volume would leave its bounds (VolumeLedger)
  edge_length,        ///< an edge would leave its bounds (EdgeSizes)
};
inline constexpr std::size_t outcome_count = 15;

/// Keys of the statistics: fixed.
inline constexpr std::array<std::string_view, outcome_count> outcome_names{
    "done",          "lock_taken", "stale",     "no_candidate",   "material_rule",
    "surface_error", "inverts",    "quality",   "link_condition", "self_intersection",
    "no_room",       "count",      "too_large", "volume",         "edge_length"};

/// The kinds of operation that are counted.
enum class Operation : std::uint8_t {
  flip23,
  flip32,
  flip22,
  flip44,
  collapse,
  smooth,
  insert_in_tet,
  insert_in_face,
  insert_in_edge,
  optimise,
  edge_removal,
  face_removal,
  fit
};
inline constexpr std::size_t operation_count = 13;
inline constexpr std::array<std::string_view, operation_count> operation_names{
    "flip23",         "flip32",         "flip22",   "flip44",       "collapse",     "smooth", "insert_in_tet",
    "insert_in_face", "insert_in_edge", "optimise", "edge_removal", "face_removal", "fit"};

/// How often each operation had each outcome.
struct OperationCounts {
  std::array<std::array<std::uint64_t, outcome_count>, operation_count> counts{};

  void add(Operation operation, Outcome outcome) {
    ++counts[static_cast<std::size_t>(operation)][static_cast<std::size_t>(outcome)];
  }
  std::uint64_t of(Operation operation, Outcome outcome) const {
    return counts[static_cast<std::size_t>(operation)][static_cast<std::size_t>(outcome)];
  }
  std::uint64_t tried(Operation operation) const {
    std::uint64_t sum = 0;
    for (std::uint64_t n : counts[static_cast<std::size_t>(operation)]) sum += n;
    return sum;
  }
  void add(const OperationCounts& other) {
    for (std::size_t i = 0; i < operation_count; ++i)
      for (std::size_t j = 0; j < outcome_count; ++j) counts[i][j] += other.counts[i][j];
  }
};

/// Schedule of the block iteration.
enum class Schedule : std::uint8_t {
  tuned,  ///< README.md, The tuned schedule: best in experiments; ends with improvement
  paper   ///< Figure 3 of the paper with its operations in its order; no improvement afterwards
};

/// A dense mesh, as far as the mesh of the parts that coarsen() made of it no longer shows it.
struct OriginalMesh {
  TetMesh surface;                        ///< its boundary and interfaces with their patches; no tets
  std::map<MaterialTag, double> volumes;  ///< of all materials, input units cubed
  std::size_t tets = 0;
};

struct SimplifyOptions {
  std::size_t target_tets = 10000;  ///< at least 1; 0 with a tolerance: as few tets as that allows
  double min_solid_angle = 0.1;     ///< steradians; the final improvement works on tets below it
  double beta = 5;                  ///< the paper: max edge, in ideal edges, that Quality does not penalise
  double gamma = 10;                ///< the paper: weight of the volume error relative to the edge length
  int max_iterations = 100;         ///< of the block iteration
  Schedule schedule = Schedule::tuned;
  ShapeObjective objective = ShapeObjective::both;  ///< of the final improvement
  /// Surface onto which boundary and interface points are projected; null: they stay in planes of constant
  /// volume. Must outlive the call.
  const ReferenceSurface* reference = nullptr;
  /// The surface (input units) to which the mesh's surface is fitted and near which it is kept; null: the
  /// input mesh's own surface. Must outlive the call.
  const TriangleMesh* surface = nullptr;
  /// The mesh from which coarsen() made this one: its surface and volumes are kept instead of those of the
  /// coarser mesh. Null: the mesh itself. Not together with `surface`. Must outlive the call, which moves the
  /// surface out of it: it may take gigabytes.
  OriginalMesh* original = nullptr;
  /// Max two-sided distance between the mesh's surface and `surface` or, without one, the input mesh's own
  /// surface; input units. 0: no bound. Parts that start farther away are not moved nearer:
  /// SimplifyReport::deviation has the distance reached. Tuned schedule only.
  double tolerance = 0;
  /// Target edge lengths (may be null) and bounds on edge lengths, input units; tuned schedule only. A target
  /// length determines the number of tets, so target_tets may be 0. `sizes` must outlive the call.
  const SizeField* sizes = nullptr;
  double min_edge = 0, max_edge = std::numeric_limits<double>::infinity();
  std::uint64_t seed = 1;
  /// Max points or tets of a batch (BlockRunner); 0: chosen from the number of items. Results depend on it,
  /// never on the number of threads.
  std::size_t batch_size = 0;
  /// One value for each point of the mesh, nonzero if frozen: a frozen point is never moved or removed, and
  /// tets with only frozen points are kept. Empty: none.
  std::vector<std::uint8_t> frozen;
  bool fix_boundary = false;  ///< freezes all points of boundary and interfaces, and so their faces
  std::string name = "mesh";  ///< the mesh's name in messages
};

/// Options of improve(), which changes shapes only. The count stays within 5 % unless free_count is set.
struct ImproveOptions {
  /// Works only on tets whose shape, as rated by the objective, is worse than the shape_quality_bound() of
  /// this solid angle (steradians), and on their surroundings. 0: works on all tets below 1.5 times
  /// min_solid_angle, and with cheap operations on all below 0.2.
  double only_below = 0;
  double min_solid_angle = 0.1;  ///< steradians; improvement ends early once all tets are well above it
  ShapeObjective objective = ShapeObjective::both;
  /// Lets the count vary as shapes require, between 0.8 and 4 times the input's; while tets are still below
  /// min_solid_angle at the end, down to 0.5 times unless only_below is given.
  bool free_count = false;
  int max_iterations = 100;  ///< rounds
  std::uint64_t seed = 1;
  std::size_t batch_size = 0;  ///< as in SimplifyOptions
  const ReferenceSurface* reference = nullptr;
  std::vector<std::uint8_t> frozen;  ///< as in SimplifyOptions, like fix_boundary
  bool fix_boundary = false;
  std::string name = "mesh";
};

/// Record of one round of the block iteration or of the improvement.
struct IterationReport {
  std::string kind;  ///< "simplify", "close" (the end of simplify()) or "improve"
  std::size_t tets_before = 0, tets_after = 0;
  /// Number of tets before the iteration by Quality(t), worst first, in equal bins from 0 to 1; all 0 unless
  /// the kind is "simplify".
  std::array<std::size_t, 8> tets_by_quality{};
  /// Quality(t) below which tets are worked on; in improvement, the solid angle in steradians.
  double cutoff = 0;
  double percent = 0;    ///< percentage of tets worked on
  double max_error = 0;  ///< E, input units
  OperationCounts counts;
  /// Proposals that lost to an earlier one of their batch and were decided again.
  std::uint64_t conflicts = 0;
  std::uint64_t repeats = 0;  ///< items that were decided again
  std::uint64_t batches = 0;
  double seconds = 0;
};

struct SimplifyReport {
  std::vector<IterationReport> iterations;
  std::size_t touching_points = 0;  ///< points where parts touch without a common face; kept unchanged
  std::vector<std::uint64_t> decided_by_worker;  ///< decided items; the sum is independent of the threads
  std::optional<DeviationReport> deviation;      ///< with a tolerance
  bool out_of_time = false;                      ///< the deadline of the Progress ended the call early
  double seconds_build = 0, seconds_simplify = 0, seconds_close = 0;
  LoopTimes loops_build, loops_simplify, loops_close;  ///< loops of these stages, if the thread counts them
};

/// Simplifies a valid mesh to about `target_tets` (within 1 % if topology and shapes allow) and improves its
/// shapes: the block iteration of Cutler, Dorsey & McMillan 2004 with a tuned schedule (README.md), then
/// improvement at that count. A mesh with fewer tets than the target is only improved.
///
/// Preserves every material, component, handle, cavity and interface, creates no self-intersections of the
/// boundary, and keeps all tets positive by exact sign. The result contains its interface triangles. Uses
/// thread_count() threads; the same input, options and seed give the same bytes for any number of them.
///
/// When the deadline of `progress` passes, returns the current mesh, which is valid (the input, possibly
/// renumbered, if nothing has changed yet). The block iteration ends earlier to leave time for improving
/// shapes; with a tolerance, the improvement ends earlier to leave time for measuring distances. The final
/// renumbering and the minimum work that bounds the distances may exceed the deadline.
///
/// \param report receives statistics; may be null.
/// \param progress may be null.
/// \throws InputError if the arrays of the mesh do not fit together (no material for each tet, an index out
///   of range, a field of the wrong size), a coordinate is not finite, a tet repeats a point or a face has
///   more than two tets.
/// \throws OutputError if there is not enough memory.
/// \throws UsageError for invalid options.
/// \throws Interrupted when cancelled.
TetMesh simplify(TetMesh mesh, const SimplifyOptions& options, SimplifyReport* report = nullptr,
                 Progress* progress = nullptr);

struct CoarsenOptions {
  /// Number of tets of the final mesh in the volume of this part, above 0.
  double target_tets = 0;
  /// Tets to leave for each of them, besides those at frozen faces; 0: four. Fewer for a mesh that has been
  /// coarsened before, in other parts.
  double tets_for_final = 0;
  /// One value for each point of the mesh, nonzero if frozen: those shared with other parts.
  std::vector<std::uint8_t> frozen;
  double beta = 5, gamma = 10;  ///< as in SimplifyOptions, like all that follow
  const ReferenceSurface* reference = nullptr;
  int max_iterations = 100;
  std::uint64_t seed = 1;
  std::size_t batch_size = 0;
  std::string name = "mesh";
};

/// Coarsens a part of a mesh to about four times its target (CoarsenOptions::tets_for_final) and two tets
/// more for each frozen boundary face, for simplify() of all parts together. It does not improve shapes,
/// since later collapses would change them again, and nothing in it depends on other parts. Guarantees,
/// parallelism and exceptions are those of simplify(); frozen points keep their coordinates to the last bit.
TetMesh coarsen(TetMesh mesh, const CoarsenOptions& options, SimplifyReport* report = nullptr,
                Progress* progress = nullptr);

/// Two-sided distance between a mesh's surface and the surface from which it was made, with proven bounds.
/// Works on a copy. Parallel; the result does not depend on the number of threads.
///
/// \param surface oriented outwards, input units.
/// \param progress may end the computation early, as in surface_deviation(); may be null.
/// \throws InputError as simplify().
DeviationReport deviation(const TetMesh& mesh, const TriangleMesh& surface,
                          const Progress* progress = nullptr);

/// Improves the shapes of a mesh while roughly keeping its count, as at the end of simplify(). Guarantees,
/// parallelism and exceptions are those of simplify().
TetMesh improve(TetMesh mesh, const ImproveOptions& options, SimplifyReport* report = nullptr,
                Progress* progress = nullptr);

}  // namespace tetwright
