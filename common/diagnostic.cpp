// SPDX-License-Identifier: Apache-2.0
#include "tetwright/diagnostic.h"

#include "common/diagnostics/kinds.h"
#include "tetwright/error.h"

namespace tetwright {

std::span<const DiagnosticKind> diagnostic_kinds() {
  static const std::vector<DiagnosticKind> all = [] {
    std::vector<DiagnosticKind> kinds;
    for (const auto part : {request_kinds(), input_kinds(), failure_kinds()})
      for (const DiagnosticKind& kind : part) {
        TETWRIGHT_CHECK(static_cast<std::size_t>(kind.code) == kinds.size());
        kinds.push_back(kind);
      }
    return kinds;
  }();
  return all;
}

const DiagnosticKind& kind_of(DiagnosticCode code) {
  return diagnostic_kinds()[static_cast<std::size_t>(code)];
}

const char* name_of(Severity severity) {
  switch (severity) {
    case Severity::note:
      return "note";
    case Severity::shortfall:
      return "shortfall";
    case Severity::warning:
      return "warning";
    case Severity::error:
      return "error";
  }
  return "";
}

std::string diagnostic_text(const Diagnostic& d) {
  std::string text = d.count > 0 ? std::to_string(d.count) + " " + d.what : d.what;
  if (!d.done.empty()) text += " (" + d.done + ")";
  if (d.severity == Severity::shortfall && !d.remedy.empty()) text += "; " + d.remedy;
  return text;
}

}  // namespace tetwright
