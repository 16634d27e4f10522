// SPDX-License-Identifier: Apache-2.0
#include "tetwright/prepare_steps.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "common/geometry/box_tree.h"
#include "common/tolerances.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

/// Fraction of the diagonal: a hundred times the accuracy of distances and of single-precision numbers.
constexpr double min_tolerance_share = 100 * tolerance::deviation_share;

}  // namespace

double diagonal_of(const TetMesh& mesh) {
  Box3 box;
  for (const Vec3& p : mesh.points) box.add(p);
  return (box.high - box.low).norm();
}

double tolerance_of(const Length& asked, double diagonal) {
  const double value = asked.in_input_units(diagonal);
  const double smallest = min_tolerance_share * diagonal;
  if (value < smallest) {
    char text[160];
    std::snprintf(text, sizeof text,
                  "--tolerance %.6g is below the accuracy of coordinates and distances; give %.6g or more",
                  value, smallest);
    throw UsageError(text);
  }
  return value;
}

TetMesh simplify_to_target(TetMesh mesh, const ReferenceSurface* reference, const TriangleMesh* surface,
                           PrepareRun& run) {
  SimplifyOptions options;
  const PrepareOptions& asked = run.options;
  options.target_tets = asked.target.tets.value_or(0);
  // Thin walls filled with fewer tets would have flat tets.
  if (run.report.mesher && options.target_tets > 0)
    options.target_tets =
        std::max(options.target_tets, std::min(run.report.mesher->filling_tets, mesh.tets.size()));
  options.min_solid_angle = asked.shapes.bound();
  options.beta = asked.schedule.beta;
  options.gamma = asked.schedule.gamma;
  options.max_iterations = asked.shapes.max_iterations;
  options.schedule = asked.schedule.kind;
  options.objective = asked.shapes.objective;
  options.reference = reference;
  options.surface = surface;
  options.original = run.original ? &*run.original : nullptr;
  options.tolerance = run.report.tolerance;
  const RequestedSizes& sizes = run.report.sizes;
  options.sizes = sizes.target_length.get();
  options.min_edge = sizes.limits.min_edge;
  options.max_edge = sizes.limits.max_edge;
  options.fix_boundary = asked.shapes.fix_boundary;
  options.seed = asked.seed;
  options.name = run.report.inputs.front();
  run.report.simplify.emplace();
  TetMesh result = simplify(std::move(mesh), options, &*run.report.simplify, &run.progress);
  // The deadline applies only to simplification; all later steps finish this mesh.
  run.progress.set_deadline(Progress::no_deadline);
  run.report.deviation = run.report.simplify->deviation;
  return result;
}

}  // namespace tetwright
