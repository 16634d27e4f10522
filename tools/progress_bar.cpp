#include "tools/progress_bar.h"

#include <algorithm>
#include <cstdio>

namespace tetwright {

void ProgressBar::begin_stage(std::string_view name) {
  stage_ = name;
  draw(0);
}

void ProgressBar::update(double fraction) {
  const auto now = std::chrono::steady_clock::now();
  if (now - last_ < std::chrono::milliseconds(100)) return;
  draw(fraction);
}

void ProgressBar::draw(double fraction) {
  if (!visible_) return;
  constexpr int width = 30;
  const int full = static_cast<int>(std::clamp(fraction, 0.0, 1.0) * width);
  std::fprintf(stderr, "\r\x1b[K%-18s [%s%s]", stage_.c_str(), std::string(full, '#').c_str(),
               std::string(width - full, '.').c_str());
  std::fflush(stderr);
  drawn_ = true;
  last_ = std::chrono::steady_clock::now();
}

void ProgressBar::clear() {
  if (!drawn_) return;
  std::fprintf(stderr, "\r\x1b[K");
  std::fflush(stderr);
  drawn_ = false;
}

}  // namespace tetwright
