// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/prepare/options.h"
#include "tools/prepare/report.h"

namespace tetwright {

/// Decides which diagnostics are notes and which are shortfalls: the only place that does. Each begins as its
/// kind says (diagnostic_kinds()); kinds that yield become notes where changes are accepted or were asked
/// for; where notes are not allowed, a shortfall says so. May be called again once more were added.
void decide_severities(const AcceptanceOptions& acceptance, PrepareReport& report);

/// Whether gaps were closed or walls left out because it was asked for.
bool changed_on_purpose(const PrepareReport& report);

}  // namespace tetwright
