// SPDX-License-Identifier: Apache-2.0
#include "tetwright/prepare_steps.h"

#include "tetwright/mesh_quality.h"
#include "tools/compare/input_limited.h"
#include "tools/prepare/input_changes.h"
#include "tools/prepare/request_shortfalls.h"

namespace tetwright {

void assess(const TetMesh& mesh, PrepareRun& run) {
  PrepareReport& report = run.report;
  report.material_names = mesh.material_names;
  report.seconds_total = run.since_start.seconds();
  report.loops_total = run.since_start.loops();
  if (report.simplify) {
    report.result = mesh_statistics(mesh, run.options.shapes.bound());
    report.input_limited = input_limited_tets(mesh, report.creases, run.options.shapes.bound());
  } else {
    report.result = report.dense;  // the dense mesh is the result
  }
  find_request_shortfalls(mesh, run);
  find_input_changes(mesh, run);
  decide_severities(run.options.acceptance, report);
  report.seconds_total = run.since_start.seconds();
  report.loops_total = run.since_start.loops();
}

}  // namespace tetwright
