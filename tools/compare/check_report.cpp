// SPDX-License-Identifier: Apache-2.0
#include "tools/compare/check_report.h"

namespace tetwright {

std::vector<Diagnostic> diagnostics_of(const CheckReport& check) {
  std::vector<Diagnostic> all;
  for (const MeshFinding& f : check.findings) all.push_back(diagnostic_of(f));
  if (check.topology_differences)
    for (const std::string& difference : *check.topology_differences)
      all.push_back({.code = DiagnosticCode::topology_differs, .what = "topology differs: " + difference});
  if (!check.within_tolerance())
    all.push_back({.code = DiagnosticCode::tolerance_exceeded,
                   .what = tolerance_line(*check.surface, check.tolerance),
                   .asked = check.tolerance,
                   .reached = check.surface->upper()});
  return all;
}

}  // namespace tetwright
