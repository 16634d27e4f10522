// SPDX-License-Identifier: Apache-2.0
#include "tetwright/prepare_steps.h"

#include <algorithm>

namespace tetwright {

namespace {

/// Reason for which a shortfall becomes a note; null if it does not.
const char* reason_to_accept(const Diagnostic& d, const AcceptanceOptions& acceptance, bool on_purpose) {
  const Yields yields = kind_of(d.code).yields;
  if (yields == Yields::never) return nullptr;
  if (acceptance.accept_changes) return "accepted";
  return yields == Yields::to_acceptance_or_purpose && on_purpose ? "as --min-gap and --min-thickness request"
                                                                  : nullptr;
}

}  // namespace

bool changed_on_purpose(const PrepareReport& report) {
  return report.mesher && std::any_of(report.mesher->closed_gaps.begin(), report.mesher->closed_gaps.end(),
                                      [](const ClosedGapReport& g) { return g.on_purpose; });
}

void decide_severities(const AcceptanceOptions& acceptance, PrepareReport& report) {
  std::erase_if(report.diagnostics,
                [](const Diagnostic& d) { return d.code == DiagnosticCode::notes_not_allowed; });
  const bool on_purpose = changed_on_purpose(report);
  for (Diagnostic& d : report.diagnostics) {
    d.severity = kind_of(d.code).severity;
    const char* reason = reason_to_accept(d, acceptance, on_purpose);
    if (kind_of(d.code).yields != Yields::never) d.done.clear();  // removes the reason of an earlier call
    if (!reason) continue;
    d.severity = Severity::note;
    d.done = reason;
  }
  const std::vector<std::string> notes = notes_of(report, NotesOf::certain);
  if (!acceptance.strict || notes.empty()) return;
  report.diagnostics.push_back({.code = DiagnosticCode::notes_not_allowed,
                                .what = "--strict: " + std::to_string(notes.size()) +
                                        (notes.size() == 1 ? " note: " : " notes, the first: ") +
                                        notes.front(),
                                .asked = 0,
                                .reached = static_cast<double>(notes.size()),
                                .limited_by = "--strict"});
}

}  // namespace tetwright
