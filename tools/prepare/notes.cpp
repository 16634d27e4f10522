// SPDX-License-Identifier: Apache-2.0
#include "tetwright/prepare_steps.h"

namespace tetwright {

std::vector<std::string> notes_of(const PrepareReport& report, NotesOf which) {
  std::vector<std::string> notes;
  std::string line, file;
  const auto noted = [&](const Diagnostic& d) {
    return d.severity == Severity::note && (which == NotesOf::all || kind_of(d.code).certain);
  };
  for (const Diagnostic& d : report.diagnostics) {
    if (!noted(d) || d.file.empty()) continue;
    line += line.empty() ? "" : "; ";
    if (d.file != file) line += d.file + ": ";
    file = d.file;
    line += diagnostic_text(d);
  }
  if (!line.empty()) notes.push_back(line);
  for (const Diagnostic& d : report.diagnostics)
    if (noted(d) && d.file.empty()) notes.push_back(diagnostic_text(d));
  return notes;
}

std::vector<std::string> shortfalls_of(const PrepareReport& report) {
  std::vector<std::string> lines;
  for (const Diagnostic& d : report.diagnostics)
    if (d.severity == Severity::shortfall) lines.push_back(diagnostic_text(d));
  return lines;
}

}  // namespace tetwright
