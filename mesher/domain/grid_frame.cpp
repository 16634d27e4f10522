// SPDX-License-Identifier: Apache-2.0
#include "mesher/domain/grid_frame.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesher/tuning/domain_tuning.h"

namespace tetwright {

namespace {

/// Chooses the root cells, and rounds the numbers of cells up to whole ones.
void take_cells(GridFrame& frame, const std::array<int, 3>& needed, int max_root_level) {
  const int longest = *std::max_element(needed.begin(), needed.end());
  while (frame.root_level < max_root_level && (8 << frame.root_level) < longest) ++frame.root_level;
  const int root = 1 << frame.root_level;
  for (int a = 0; a < 3; ++a) frame.cells[a] = (needed[a] + root - 1) / root * root;
}

}  // namespace

GridFrame make_grid_frame(const Vec3& low, const Vec3& high, double cell_size, bool uniform, bool centred) {
  GridFrame frame;
  frame.cell_size = cell_size;
  frame.origin = low - Vec3::Constant(DomainTuning::Frames::margin * cell_size);
  std::array<int, 3> needed;
  for (int a = 0; a < 3; ++a)
    needed[a] =
        static_cast<int>(std::ceil((high[a] - low[a]) / cell_size)) + 2 * DomainTuning::Frames::margin;
  take_cells(frame, needed, uniform ? 0 : std::numeric_limits<int>::max());
  frame.box = frame.cells;
  if (centred)
    for (int a = 0; a < 3; ++a) {
      const int before = (frame.cells[a] - needed[a]) / 2;
      frame.origin[a] -= before * cell_size;
    }
  return frame;
}

GridFrame make_box_frame(const Vec3& corner, const Eigen::Matrix3d& edges, double cell_size, bool uniform) {
  GridFrame frame;
  frame.cell_size = cell_size;
  frame.origin = corner;
  for (int a = 0; a < 3; ++a) {
    frame.box[a] = std::max(1, static_cast<int>(std::round(edges.col(a).norm() / cell_size)));
    frame.axes.col(a) = edges.col(a) / (frame.box[a] * cell_size);
  }
  take_cells(frame, frame.box, uniform ? 0 : DomainTuning::Frames::max_volume_root);
  return frame;
}

GridFrame continued_frame(GridFrame frame, const std::array<int, 3>& before,
                          const std::array<int, 3>& after) {
  const int root = 1 << frame.root_level;
  const auto whole_roots = [&](int cells) { return (cells + root - 1) / root * root; };
  for (int a = 0; a < 3; ++a) {
    const int low = whole_roots(before[a]);
    frame.border.low[a] = low;
    frame.border.high[a] = low + frame.box[a];
    frame.origin -= frame.cell_size * low * frame.axes.col(a);
    frame.box[a] += low + whole_roots(after[a]);
    frame.cells[a] = whole_roots(frame.box[a]);
  }
  return frame;
}

GridFrame refined_frame(GridFrame frame, int levels) {
  frame.cell_size = std::ldexp(frame.cell_size, -levels);
  for (int& c : frame.cells) c <<= levels;
  for (auto* counts : {&frame.box, &frame.border.low, &frame.border.high})
    for (int& c : *counts) c <<= levels;
  frame.root_level += levels;
  return frame;
}

}  // namespace tetwright
