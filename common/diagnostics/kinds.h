// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "tetwright/diagnostic.h"

namespace tetwright {

// The table of all kinds, in three parts, which follow each other in the order of DiagnosticCode.

/// Requests that were not met, and properties of the result.
std::span<const DiagnosticKind> request_kinds();
/// Repairs of the input, and content that was left out.
std::span<const DiagnosticKind> input_kinds();
/// Findings of `check`, and errors that end a run.
std::span<const DiagnosticKind> failure_kinds();

}  // namespace tetwright
