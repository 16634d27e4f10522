// SPDX-License-Identifier: Apache-2.0
#include "tools/app/commands/report_file.h"

#include <utility>

#include "tools/report/page/page.h"

namespace tetwright {

void measure_distances(const TetMesh& result, const TriangleMesh& surface, std::string from,
                       CommandRun& run) {
  if (run.line.outputs.report.empty() || surface.triangles.empty()) return;
  run.progress.begin_stage("report");
  run.distances = surface_distances(result, surface, std::move(from));
}

void write_report(const TetMesh& mesh, const CommandRun& run, OutputFiles& files, const CheckReport* check) {
  if (run.line.outputs.report.empty()) return;
  files.write(run.line.outputs.report,
              report_page(run.line, run.report, mesh, run.distances ? &*run.distances : nullptr, check));
}

}  // namespace tetwright
