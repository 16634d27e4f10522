#include "tools/commands/simplification.h"

#include <algorithm>
#include <utility>

namespace tetwright {

TetMesh simplify_to_target(TetMesh mesh, const ReferenceSurface* reference, const TriangleMesh* surface,
                           CommandRun& run) {
  SimplifyOptions options;
  options.target_tets = run.line.target_tets;
  // Fewer tets than fill thin walls would be flat.
  if (run.report.mesher)
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
  options.fix_boundary = run.line.fix_boundary;
  options.seed = run.line.seed;
  options.name = run.report.inputs.front();
  run.report.simplify.emplace();
  return simplify(std::move(mesh), options, &*run.report.simplify, &run.progress);
}

}  // namespace tetwright
