// SPDX-License-Identifier: Apache-2.0
#include "tetwright/prepare_steps.h"

#include <algorithm>
#include <limits>

namespace tetwright {

namespace {

/// Maximum time limit, seconds; larger ones would overflow the clock.
constexpr double max_seconds = 1e9;
/// Minimum fraction of the time limit reserved for comparing and writing the mesh.
constexpr double min_reserve = 0.1;

}  // namespace

const char* name_of(Task task) {
  switch (task) {
    case Task::prepare:
      return "prepare";
    case Task::mesh:
      return "mesh";
    case Task::simplify:
      return "simplify";
    case Task::improve:
      return "improve";
    case Task::values:
      return "values";
  }
  return "";
}

PrepareRun::PrepareRun(Task what, const PrepareOptions& of, Progress& shown, PrepareReport& to)
    : task(what),
      options(of),
      memory_limit(of.limits.memory.value_or(0) * gigabyte),
      progress(shown),
      deadline_before(shown.deadline()),
      report(to) {
  reserve_time(min_reserve * seconds_left());
}

PrepareRun::~PrepareRun() { progress.set_deadline(deadline_before); }

double PrepareRun::seconds_left() const {
  if (!options.limits.seconds) return std::numeric_limits<double>::infinity();
  return std::max(0.0, std::min(*options.limits.seconds, max_seconds) - since_start.seconds());
}

void PrepareRun::reserve_time(double seconds) {
  if (!options.limits.seconds) return;
  const std::chrono::duration<double> left(seconds_left() - seconds);
  const auto end = Progress::Clock::now() + std::chrono::duration_cast<Progress::Clock::duration>(left);
  progress.set_deadline(std::min(progress.deadline(), end));
}

void report_dropped(const std::vector<Dropped>& dropped, const std::string& file, PrepareReport& report,
                    bool with_restored) {
  for (const Dropped& d : dropped)
    if (with_restored || !d.restored)
      report.diagnostics.push_back(
          {.code = d.restored ? DiagnosticCode::input_restored : DiagnosticCode::input_dropped,
           .file = file,
           .what = d.what,
           .count = d.count,
           .done = d.restored ? "restored from the materials" : "dropped"});
}

}  // namespace tetwright
