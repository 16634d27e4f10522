// SPDX-License-Identifier: Apache-2.0
#include "tools/app/commands/simplification.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "common/error.h"
#include "common/geometry/box_tree.h"
#include "common/tolerances.h"

namespace tetwright {

namespace {

/// Of the diagonal: a hundred times what distances are exact to, and what floats hold.
constexpr double min_tolerance_share = 100 * tolerance::deviation_share;

}  // namespace

double diagonal_of(const TetMesh& mesh) {
  Box3 box;
  for (const Vec3& p : mesh.points) box.add(p);
  return (box.high - box.low).norm();
}

double tolerance_of(const CommandLine& line, double diagonal) {
  const double value = line.tolerance.in_input_units(diagonal);
  const double smallest = min_tolerance_share * diagonal;
  if (value < smallest) {
    char text[160];
    std::snprintf(
        text, sizeof text,
        "--tolerance %.6g is below what coordinates and distances are worth here; give %.6g or more", value,
        smallest);
    throw UsageError(text);
  }
  return value;
}

TetMesh simplify_to_target(TetMesh mesh, const ReferenceSurface* reference, const TriangleMesh* surface,
                           CommandRun& run) {
  SimplifyOptions options;
  options.target_tets = run.line.target_tets;
  // Fewer tets than fill thin walls would be flat.
  if (run.report.mesher && options.target_tets > 0)
    options.target_tets =
        std::max(options.target_tets, std::min(run.report.mesher->filling_tets, mesh.tets.size()));
  options.min_solid_angle = run.line.min_solid_angle;
  options.beta = run.line.beta;
  options.gamma = run.line.gamma;
  options.max_iterations = run.line.max_iterations;
  options.schedule = run.line.schedule;
  options.objective = run.line.objective;
  options.reference = reference;
  options.surface = surface;
  options.tolerance = run.report.tolerance;
  const RequestedSizes& sizes = run.report.sizes;
  options.sizes = sizes.target_length.get();
  options.min_edge = sizes.limits.min_edge;
  options.max_edge = sizes.limits.max_edge;
  options.fix_boundary = run.line.fix_boundary;
  options.seed = run.line.seed;
  options.name = run.report.inputs.front();
  run.report.simplify.emplace();
  TetMesh result = simplify(std::move(mesh), options, &*run.report.simplify, &run.progress);
  // What follows belongs to this mesh.
  run.progress.set_deadline(Progress::no_deadline);
  run.report.deviation = run.report.simplify->deviation;
  return result;
}

}  // namespace tetwright
