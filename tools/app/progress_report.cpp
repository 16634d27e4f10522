// SPDX-License-Identifier: Apache-2.0
#include "tools/app/progress_report.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "tools/app/log_file.h"
#include "tools/app/printed_report.h"

namespace tetwright {

namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

void ProgressReport::announce(const std::string& line) {
  log_line(line);
  if (quiet_ || style_ == ProgressStyle::json) return;
  clear();
  print_line(line);
}

void ProgressReport::begin_stage(std::string_view name) {
  stage_ = name;
  stage_start_ = Clock::now();
  last_percent_ = -1;
  log_line("stage: " + stage_);
  show(0);
}

void ProgressReport::update(double fraction) { show(fraction); }

void ProgressReport::finish() { clear(); }

void ProgressReport::show(double fraction) {
  fraction = std::clamp(fraction, 0.0, 1.0);
  if (style_ == ProgressStyle::bar) {
    constexpr std::chrono::milliseconds between{100};
    if (fraction > 0 && Clock::now() - last_drawn_ < between) return;
    draw_bar(fraction, seconds_since(stage_start_));
  } else if (style_ == ProgressStyle::json) {
    const int percent = static_cast<int>(std::floor(100 * fraction));
    if (percent <= last_percent_) return;
    last_percent_ = percent;
    const nlohmann::json line = {{"stage", stage_},
                                 {"percent", percent},
                                 {"seconds", std::round(1000 * seconds_since(start_)) / 1000}};
    std::fprintf(stderr, "%s\n", line.dump().c_str());
  }
}

void ProgressReport::draw_bar(double fraction, double seconds) {
  constexpr int width = 30;
  // Earlier the remaining time cannot be estimated.
  constexpr double min_fraction = 0.05, min_seconds = 2;
  const int full = static_cast<int>(fraction * width);
  char left[40] = "";
  if (fraction >= min_fraction && seconds >= min_seconds)
    std::snprintf(left, sizeof left, " about %.0f s left", std::ceil(seconds * (1 - fraction) / fraction));
  std::fprintf(stderr, "\r\x1b[K%-18s [%s%s]%s", stage_.c_str(), std::string(full, '#').c_str(),
               std::string(width - full, '.').c_str(), left);
  std::fflush(stderr);
  drawn_ = true;
  last_drawn_ = Clock::now();
}

void ProgressReport::clear() {
  if (!drawn_) return;
  std::fprintf(stderr, "\r\x1b[K");
  std::fflush(stderr);
  drawn_ = false;
}

ProgressStyle progress_style(const CommandLine& line) {
  if (line.console.no_progress) return ProgressStyle::none;
  if (line.console.progress != ProgressStyle::automatic) return line.console.progress;
  return !line.console.quiet && isatty(STDERR_FILENO) ? ProgressStyle::bar : ProgressStyle::none;
}

}  // namespace tetwright
