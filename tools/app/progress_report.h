// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>

#include "tetwright/progress.h"
#include "tools/app/command_line.h"

namespace tetwright {

/// Shows progress on stderr: either a bar on a terminal, redrawn at most ten times a second, or lines of
/// JSON, one for each stage and percent. Logs the stages. The destructor erases the bar.
class ProgressReport : public Progress {
 public:
  /// \param quiet announcements are only logged
  explicit ProgressReport(ProgressStyle style, bool quiet) : style_(style), quiet_(quiet) {}
  ~ProgressReport() override { clear(); }
  /// Prints the line, unless all of stderr is JSON.
  void announce(const std::string& line) override;
  void begin_stage(std::string_view name) override;
  void update(double fraction) override;
  void finish() override;
  std::string stage() const override { return stage_; }

 private:
  using Clock = std::chrono::steady_clock;

  void show(double fraction);
  void draw_bar(double fraction, double seconds);
  void clear();

  ProgressStyle style_;
  bool quiet_;
  std::string stage_;
  Clock::time_point start_ = Clock::now(), stage_start_{}, last_drawn_{};
  int last_percent_ = 0;
  bool drawn_ = false;
};

/// The requested style; the default is a bar if stderr is a terminal.
ProgressStyle progress_style(const CommandLine& line);

}  // namespace tetwright
