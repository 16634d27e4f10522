// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/quality.h"
#include "common/geometry/surface_deviation.h"
#include "common/reference_surface.h"
#include "common/sizes/size_field.h"
#include "common/triangle_mesh.h"
#include "simplify/mesh/outcome.h"

namespace tetwright {

/// Schedule of the block loop.
enum class Schedule : std::uint8_t {
  tuned,  ///< README.md, The tuned schedule: best in experiments; closes with improvement
  paper   ///< Figure 3 of the paper, with its operations in its order; nothing after it
};

struct SimplifyOptions {
  std::size_t target_tets = 10000;  ///< at least 1; with a tolerance 0: as few as it allows
  double min_solid_angle = 0.1;     ///< steradians; the closing rounds work on tets below it
  double beta = 5;                  ///< the paper's: max edge, in ideal edges, that Quality does not penalise
  double gamma = 10;                ///< the paper's: weight of the volume error against the length of an edge
  int max_iterations = 100;         ///< of the block loop
  Schedule schedule = Schedule::tuned;
  ShapeObjective objective = ShapeObjective::both;  ///< of the closing improvement
  /// Target of the projection of boundary and interface points; null: they stay in planes of constant volume.
  /// Must outlive the call.
  const ReferenceSurface* reference = nullptr;
  /// The given surface (input units), if there is one: the mesh's surface is fitted to it and kept near it.
  /// Null: the input mesh's own surface. Must outlive the call.
  const TriangleMesh* surface = nullptr;
  /// Max distance of any point of the mesh's surface from `surface` and vice versa, input units; without
  /// `surface`, from the input mesh's own surface. 0: only the count bounds it. Parts that start farther away
  /// are not moved nearer for it: SimplifyReport::deviation has the distance reached. Tuned schedule only.
  double tolerance = 0;
  /// Target edge lengths (may be null) and their bounds, input units; tuned schedule only. A target length
  /// decides the number of tets, so target_tets may be 0. `sizes` must outlive the call.
  const SizeField* sizes = nullptr;
  double min_edge = 0, max_edge = std::numeric_limits<double>::infinity();
  std::uint64_t seed = 1;
  /// Max points or tets of a batch (BlockRunner); 0: chosen from the number of items. Results depend on it,
  /// never on the number of threads.
  std::size_t batch_size = 0;
  /// One value for each point of the mesh, nonzero: frozen, never moved nor removed; tets with frozen points
  /// only stay. Empty: none.
  std::vector<std::uint8_t> frozen;
  bool fix_boundary = false;  ///< freezes all points of boundary and interfaces, and so their faces
  std::string name = "mesh";  ///< the mesh's name in messages
};

/// Options of improve(): shapes only; the count stays within 5 % unless it is free.
struct ImproveOptions {
  /// Works only on tets worse, by the objective, than the shape_quality_bound() of this solid angle
  /// (steradians), and on their surroundings. 0: all below 1.5 times min_solid_angle, and by cheap operations
  /// all below 0.2.
  double only_below = 0;
  double min_solid_angle = 0.1;  ///< steradians; the work ends early once all are well above it
  ShapeObjective objective = ShapeObjective::both;
  /// Lets the count follow the shapes' needs: between 0.8 and 4 times the input's.
  bool free_count = false;
  int max_iterations = 100;  ///< rounds
  std::uint64_t seed = 1;
  std::size_t batch_size = 0;  ///< as in SimplifyOptions
  const ReferenceSurface* reference = nullptr;
  std::vector<std::uint8_t> frozen;  ///< as in SimplifyOptions, like fix_boundary
  bool fix_boundary = false;
  std::string name = "mesh";
};

/// Record of one round of the block loop or of the improvement.
struct IterationReport {
  std::string kind;  ///< "simplify", "close" (the end of simplify()) or "improve"
  std::size_t tets_before = 0, tets_after = 0;
  /// Quality(t) below which tets are worked on; in the closing, the solid angle in steradians.
  double cutoff = 0;
  double percent = 0;    ///< percentage of tets worked on
  double max_error = 0;  ///< E, input units
  OperationCounts counts;
  /// Proposals that lost to an earlier one of their batch, and were decided again.
  std::uint64_t conflicts = 0;
  std::uint64_t repeats = 0;  ///< items that were decided again
  std::uint64_t batches = 0;
  double seconds = 0;
};

struct SimplifyReport {
  std::vector<IterationReport> iterations;
  std::size_t touching_points = 0;  ///< points where parts touch without a common face: they stay as they are
  std::vector<std::uint64_t> decided_by_worker;  ///< decided items; the sum does not depend on the threads
  std::optional<DeviationReport> deviation;      ///< with a tolerance
  bool out_of_time = false;                      ///< ended early by the deadline of the Progress
  double seconds_build = 0, seconds_simplify = 0, seconds_close = 0;
};

}  // namespace tetwright
