// SPDX-License-Identifier: Apache-2.0
#include "tools/compare/check_report.h"

namespace tetwright {

namespace {

/// Diagnostic code of a fault; codes and faults are in the same order.
DiagnosticCode code_of(MeshFault fault) {
  const auto first = static_cast<int>(DiagnosticCode::materials_missing);
  return static_cast<DiagnosticCode>(first + static_cast<int>(fault) -
                                     static_cast<int>(MeshFault::materials_missing));
}

}  // namespace

std::vector<Diagnostic> diagnostics_of(const CheckReport& check) {
  std::vector<Diagnostic> all;
  for (const MeshFinding& f : check.findings) {
    all.push_back({.code = code_of(f.fault), .what = mesh_finding_line(f)});
    for (const MeshPlace& place : f.places)
      if (place.at) all.back().places.push_back(*place.at);
  }
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
