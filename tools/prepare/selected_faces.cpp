// SPDX-License-Identifier: Apache-2.0
#include "tools/prepare/selected_faces.h"

#include <string>

#include "common/message_text.h"

namespace tetwright {

namespace {

void report_empty(const SelectedFaces& selected, PrepareReport& report) {
  Diagnostic d{.code = DiagnosticCode::selection_empty,
               .what = "--select " + selected.name + ": no face; " + selected.nearest};
  if (selected.nearest_place) {
    d.what += " at " + place_text(*selected.nearest_place);
    d.places.push_back(*selected.nearest_place);
  }
  report.diagnostics.push_back(std::move(d));
}

void report_taken(const SelectedFaces& selected, PrepareReport& report) {
  for (const auto& [group, faces] : selected.taken)
    report.diagnostics.push_back({.code = DiagnosticCode::faces_regrouped,
                                  .what = "faces of the group " + in_quotes(group),
                                  .count = faces,
                                  .done = "now in " + in_quotes(selected.name)});
  if (selected.in_earlier > 0 && selected.faces > 0)
    report.diagnostics.push_back({.code = DiagnosticCode::faces_regrouped,
                                  .what = "faces of --select " + selected.name,
                                  .count = selected.in_earlier,
                                  .done = "left to an earlier --select"});
}

void report_far_points(const SelectedFaces& selected, PrepareReport& report) {
  for (const auto& [rule, distance] : selected.far_points)
    report.diagnostics.push_back({.code = DiagnosticCode::point_off_patch,
                                  .what = "--select " + selected.name + ": the point of " + in_quotes(rule) +
                                          " is " + short_number(distance) + " from the nearest face",
                                  .remedy = "check its coordinates and units"});
}

}  // namespace

void select_faces_of(Prepared& result, PrepareRun& run) {
  if (run.options.selections.empty()) return;
  PrepareReport& report = run.report;
  report.selected = select_faces(result.mesh, run.options.selections);
  for (const SelectedFaces& selected : report.selected) {
    if (selected.faces == 0) report_empty(selected, report);
    report_taken(selected, report);
    report_far_points(selected, report);
  }
  decide_severities(run.options.acceptance, report);
}

}  // namespace tetwright
