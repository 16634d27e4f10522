// SPDX-License-Identifier: Apache-2.0
#include "simplify/schedule/round_recorder.h"

#include <algorithm>

namespace tetwright {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

RoundRecorder::Round::Round(RoundRecorder& recorder, const char* kind, double max_error)
    : recorder_(recorder) {
  report_.kind = kind;
  report_.tets_before = recorder.mesh_.live_tets();
  report_.max_error = max_error / recorder.mesh_.space().scale();
}

void RoundRecorder::Round::finish() {
  const BlockRunner::Totals totals = recorder_.runner_.take_totals();
  report_.counts = totals.counts;
  report_.conflicts = totals.conflicts;
  report_.repeats = totals.repeats;
  report_.batches = totals.batches;
  report_.tets_after = recorder_.mesh_.live_tets();
  report_.seconds = seconds_since(start_);
  if (!recorder_.report_) return;
  recorder_.report_->iterations.push_back(report_);
  std::vector<std::uint64_t>& decided = recorder_.report_->decided_by_worker;
  decided.resize(std::max(decided.size(), totals.decided.size()), 0);
  for (std::size_t w = 0; w < totals.decided.size(); ++w) decided[w] += totals.decided[w];
}

void RoundRecorder::begin_stage(const char* name) {
  if (!progress_) return;
  // If the deadline has passed, let the first batch of the stage throw, so that the current mesh can be kept.
  if (progress_->cancelled()) throw Interrupted();
  progress_->begin_stage(name);
}

}  // namespace tetwright
