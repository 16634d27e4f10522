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

/// The order and the schedule of the block loop.
enum class Schedule : std::uint8_t {
  tuned,  ///< README.md, The tuned schedule: found best by experiment; closes with improvement
  paper   ///< Figure 3 of the paper, its operations in its order, nothing after it
};

struct SimplifyOptions {
  std::size_t target_tets = 10000;  ///< at least 1; with a tolerance 0: as few as it holds
  double min_solid_angle = 0.1;     ///< steradians; tets below it are what the closing rounds work on
  double beta = 5;           ///< the paper's: largest edge, in ideal edges, that Quality does not penalise
  double gamma = 10;         ///< the paper's: weight of the volume error against the length of an edge
  int max_iterations = 100;  ///< of the block loop
  Schedule schedule = Schedule::tuned;
  ShapeObjective objective = ShapeObjective::both;  ///< of the closing improvement
  /// What boundary and interface points are projected onto; null: they stay in planes of constant volume.
  /// Must outlive the call.
  const ReferenceSurface* reference = nullptr;
  /// The surface as it was given (input units), where there is one: what the mesh's surface is fitted to and
  /// kept near. Null: the mesh's own surface as it comes. Must outlive the call.
  const TriangleMesh* surface = nullptr;
  /// How far any point of the mesh's surface and of `surface` may be from the other, input units; 0: no
  /// bound but the count. Where `surface` is null, the mesh's own surface as it comes. What is farther from
  /// the start does not come nearer for it: SimplifyReport::deviation says what was reached. The tuned
  /// schedule's.
  double tolerance = 0;
  /// The edge lengths that are wanted, or null, and their bounds, input units; the tuned schedule's. With a
  /// target length it decides the number of tets, and target_tets may be 0. `sizes` must outlive the call.
  const SizeField* sizes = nullptr;
  double min_edge = 0, max_edge = std::numeric_limits<double>::infinity();
  std::uint64_t seed = 1;
  /// Points or tets of a batch (BlockRunner), at most; 0: from the number of items. Results depend on it,
  /// never on the number of threads.
  std::size_t batch_size = 0;
  /// Points that never move nor go, one number for each point of the mesh, not 0 where it is frozen; tets
  /// that have only such points stay. Empty: none.
  std::vector<std::uint8_t> frozen;
  bool fix_boundary = false;  ///< freezes all points of boundary and interfaces, and so their faces
  std::string name = "mesh";  ///< what messages call the mesh
};

/// Shape only; the count stays within 5 % unless it is free.
struct ImproveOptions {
  /// Only tets whose shape is worse, by the objective, than this solid angle (steradians) stands for
  /// (shape_quality_bound()) are worked on, with what stands around them. 0: all below 1.5 times
  /// min_solid_angle, and by the cheap operations all below 0.2.
  double only_below = 0;
  double min_solid_angle = 0.1;  ///< steradians; the work ends early once all are well above it
  ShapeObjective objective = ShapeObjective::both;
  /// The count may be what the shapes need: between 0.8 and 4 times what it was.
  bool free_count = false;
  int max_iterations = 100;  ///< rounds
  std::uint64_t seed = 1;
  std::size_t batch_size = 0;  ///< as in SimplifyOptions
  const ReferenceSurface* reference = nullptr;
  std::vector<std::uint8_t> frozen;  ///< as in SimplifyOptions, like fix_boundary
  bool fix_boundary = false;
  std::string name = "mesh";
};

/// What one round of the block loop, or of the improvement, did.
struct IterationReport {
  std::string kind;  ///< "simplify", "close" (what ends simplify()) or "improve"
  std::size_t tets_before = 0, tets_after = 0;
  double cutoff =
      0;  ///< Quality(t) below which tets were taken up; in the closing, the solid angle in steradians
  double percent = 0;    ///< of the tets that were taken up
  double max_error = 0;  ///< E, input units
  OperationCounts counts;
  std::uint64_t conflicts = 0;  ///< proposals that lost to an earlier one of their batch, and came again
  std::uint64_t repeats = 0;    ///< items that were decided again
  std::uint64_t batches = 0;
  double seconds = 0;
};

struct SimplifyReport {
  std::vector<IterationReport> iterations;
  std::size_t touching_points = 0;  ///< where parts touch without a common face: they stay as they are
  std::vector<std::uint64_t> decided_by_worker;  ///< items of blocks; the sum does not depend on the threads
  std::optional<DeviationReport> deviation;      ///< with a tolerance
  bool out_of_time = false;                      ///< the deadline of the Progress ended it before its end
  double seconds_build = 0, seconds_simplify = 0, seconds_close = 0;
};

}  // namespace tetwright
