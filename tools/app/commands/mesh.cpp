// SPDX-License-Identifier: Apache-2.0
#include "simplify/simplify.h"
#include "tools/app/commands/commands.h"
#include "tools/app/commands/report_file.h"
#include "tools/app/commands/scan_input.h"
#include "tools/app/commands/second_order.h"

namespace tetwright {

CommandResult run_mesh(CommandRun& run) {
  DenseMesh dense = make_dense_mesh(read_scan(run), run);
  if (run.report.tolerance > 0) {
    run.progress.begin_stage("compare");
    run.report.deviation = deviation(dense.mesh, *dense.surface, &run.progress);
  }
  if (dense.reference) make_second_order(dense.mesh, follow(*dense.reference), run);
  if (dense.surface) measure_distances(dense.mesh, *dense.surface, "the input", run);
  dense.reference.reset();  // memory that writing the mesh needs
  return {std::move(dense.mesh), std::move(dense.field)};
}

}  // namespace tetwright
