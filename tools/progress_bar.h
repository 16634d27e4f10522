#pragma once

#include <chrono>
#include <string>

#include "common/progress.h"

namespace tetwright {

/// Draws the current stage and its progress on one line of stderr, at most ten times a second. Draws nothing
/// unless `visible`. The destructor clears the line.
class ProgressBar : public Progress {
 public:
  explicit ProgressBar(bool visible) : visible_(visible) {}
  ~ProgressBar() override { clear(); }
  void begin_stage(std::string_view name) override;
  void update(double fraction) override;
  void finish() override { clear(); }

 private:
  void draw(double fraction);
  void clear();
  bool visible_;
  bool drawn_ = false;
  std::string stage_;
  std::chrono::steady_clock::time_point last_{};
};

}  // namespace tetwright
