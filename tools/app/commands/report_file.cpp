// SPDX-License-Identifier: Apache-2.0
#include "tools/app/commands/report_file.h"

#include <utility>

#include "common/mesh/interfaces.h"
#include "tools/report/page/page.h"

namespace tetwright {

TriangleMesh surface_for_report(const TetMesh& mesh, const CommandRun& run) {
  TriangleMesh surface;
  if (run.line.report.empty()) return surface;
  std::vector<Index> number(mesh.points.size(), no_index);
  for (const InterfaceTriangle& t : mesh.interfaces.empty() ? find_interfaces(mesh) : mesh.interfaces) {
    for (const Index p : t.ids) {
      if (number[p] != no_index) continue;
      number[p] = static_cast<Index>(surface.points.size());
      surface.points.push_back(mesh.points[p]);
    }
    surface.triangles.push_back({number[t.ids[0]], number[t.ids[1]], number[t.ids[2]]});
  }
  return surface;
}

void measure_distances(const TetMesh& result, const TriangleMesh& surface, std::string from,
                       CommandRun& run) {
  if (run.line.report.empty() || surface.triangles.empty()) return;
  run.progress.begin_stage("report");
  run.distances = surface_distances(result, surface, std::move(from));
}

void write_report(const TetMesh& mesh, const CommandRun& run, OutputFiles& files, const CheckReport* check) {
  if (run.line.report.empty()) return;
  files.write(run.line.report,
              report_page(run.line, run.report, mesh, run.distances ? &*run.distances : nullptr, check));
}

}  // namespace tetwright
