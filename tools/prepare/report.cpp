// SPDX-License-Identifier: Apache-2.0
#include "tetwright/prepare.h"

#include <algorithm>

namespace tetwright {

double PrepareReport::lost_area() const {
  if (!deviation || !mesher || mesher->expected.empty()) return 0;
  if (!mesher->unknown.empty() || !mesher->at_protected.empty()) return 0;
  const bool all_shown = std::all_of(mesher->expected.begin(), mesher->expected.end(),
                                     [](const ExpectedSolid& s) { return s.flaw == SurfaceFlaw::none; });
  return all_shown ? deviation->hidden_area : 0;
}

bool PrepareReport::falls_short() const {
  return std::any_of(diagnostics.begin(), diagnostics.end(),
                     [](const Diagnostic& d) { return d.severity == Severity::shortfall; });
}

}  // namespace tetwright
