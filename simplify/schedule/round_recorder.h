// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "simplify/schedule/block_runner.h"
#include "tetwright/progress.h"
#include "tetwright/simplify.h"

namespace tetwright {

/// Records the rounds of work on a mesh in the report and updates the progress.
class RoundRecorder {
 public:
  /// `report` and `progress` may be null.
  RoundRecorder(const EditableMesh& mesh, BlockRunner& runner, SimplifyReport* report, Progress* progress)
      : mesh_(mesh), runner_(runner), report_(report), progress_(progress) {}

  /// Times a round and records its counts.
  class Round {
   public:
    /// `max_error`: E, working coordinates.
    Round(RoundRecorder& recorder, const char* kind, double max_error);
    IterationReport& report() { return report_; }
    /// Adds the round to the recorder's report.
    void finish();

   private:
    RoundRecorder& recorder_;
    IterationReport report_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  };

  /// Sets the fraction of the stage that is done, 0 to 1.
  void update(double fraction) {
    if (progress_) progress_->update(fraction);
  }
  /// \throws Interrupted, but not OutOfTime: the first batch of the stage throws it.
  void begin_stage(const char* name);

 private:
  const EditableMesh& mesh_;
  BlockRunner& runner_;
  SimplifyReport* report_;
  Progress* progress_;
};

double seconds_since(std::chrono::steady_clock::time_point start);

}  // namespace tetwright
