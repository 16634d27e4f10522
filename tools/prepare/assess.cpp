#include "tools/prepare/assess.h"

#include <algorithm>

#include "common/mesh/mesh_statistics.h"
#include "tools/compare/input_limited.h"
#include "tools/prepare/input_changes.h"
#include "tools/prepare/notes.h"
#include "tools/prepare/request_shortfalls.h"

namespace tetwright {

void conclude(const AcceptanceOptions& acceptance, PrepareReport& report) {
  const char* of_notes = "notes";
  std::erase_if(report.shortfall, [&](const Shortfall& s) { return s.what == of_notes; });
  const std::vector<std::string> notes = notes_of(report);
  if (!acceptance.strict || notes.empty()) return;
  report.shortfall.push_back({of_notes, 0, static_cast<double>(notes.size()), "--strict",
                              "--strict: " + std::to_string(notes.size()) +
                                  (notes.size() == 1 ? " note: " : " notes, the first: ") + notes.front()});
}

void assess(const TetMesh& mesh, PrepareRun& run) {
  PrepareReport& report = run.report;
  report.material_names = mesh.material_names;
  report.seconds_total = run.since_start.seconds();
  if (report.simplify) {
    report.result = mesh_statistics(mesh, run.options.shapes.bound());
    report.input_limited = input_limited_tets(mesh, report.creases, run.options.shapes.bound());
  } else {
    report.result = report.dense;  // the dense mesh is the result
  }
  find_request_shortfalls(mesh, run);
  find_input_changes(mesh, run);
  conclude(run.options.acceptance, report);
  report.seconds_total = run.since_start.seconds();
}

}  // namespace tetwright
