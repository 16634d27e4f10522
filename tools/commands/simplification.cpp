#include "tools/commands/simplification.h"

#include <utility>

namespace tetwright {

TetMesh simplify_to_target(TetMesh mesh, const ReferenceSurface* surface, CommandRun& run) {
  SimplifyOptions options;
  options.target_tets = run.line.target_tets;
  options.min_solid_angle = run.line.min_solid_angle;
  options.beta = run.line.beta;
  options.gamma = run.line.gamma;
  options.max_iterations = run.line.max_iterations;
  options.schedule = run.line.schedule;
  options.objective = run.line.objective;
  options.reference = surface;
  options.fix_boundary = run.line.fix_boundary;
  options.seed = run.line.seed;
  options.name = run.report.inputs.front();
  run.report.simplify.emplace();
  return simplify(std::move(mesh), options, &*run.report.simplify, &run.progress);
}

}  // namespace tetwright
