// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <utility>

#include "common/message_text.h"
#include "mesher/tuning/input_tuning.h"
#include "tetwright/error.h"
#include "tetwright/label_masks.h"

namespace tetwright {

namespace {

std::string text_of(const std::array<int, 3>& size) {
  return std::to_string(size[0]) + " x " + std::to_string(size[1]) + " x " + std::to_string(size[2]);
}

/// Size, origin and steps of a grid for messages.
std::string grid_text(const LabelGrid& grid) {
  const Eigen::Matrix3d& d = grid.directions;
  return text_of(grid.size) + " voxels from " + place_text(grid.origin) + " in steps of " +
         place_text(d.col(0)) + ", " + place_text(d.col(1)) + ", " + place_text(d.col(2));
}

}  // namespace

void CommonGrid::add(LabelGrid& grid, const std::string& file) {
  if (!grid_) {
    first_file_ = file;
    grid_ = grid;
    return;
  }
  const std::string before = grid.space;
  if (change_space(grid, grid_->space))
    ++converted_[before];
  else if (before != grid_->space)
    ++unknown_[before.empty() ? "unknown" : before];
  bool same = grid.size == grid_->size;
  const double allowed = InputTuning::Masks::same_grid * grid_->directions.colwise().norm().minCoeff();
  for (int corner = 0; corner < 8 && same; ++corner) {
    Vec3 index;
    for (int a = 0; a < 3; ++a) index[a] = (corner >> a & 1) ? grid.size[a] - 1 : 0;
    same = (grid.to_input(index) - grid_->to_input(index)).norm() <= allowed;
  }
  if (!same)
    throw InputError(file, 0,
                     "its grid, " + grid_text(grid) + ", is not that of " + first_file_ + ", " +
                         grid_text(*grid_) + "; resample one of them to the grid of the other");
}

std::vector<Diagnostic> CommonGrid::findings() const {
  std::vector<Diagnostic> findings;
  const auto add = [&](DiagnosticCode code, const std::map<std::string, std::size_t>& spaces,
                       const std::string& done) {
    for (const auto& [space, count] : spaces)
      findings.push_back(
          {.code = code,
           .file = first_file_,
           .what = (count == 1 ? "input" : "inputs") + std::string(" in another space, ") + space,
           .count = count,
           .done = done});
  };
  add(DiagnosticCode::space_converted, converted_, "brought into that of the first one, " + grid_->space);
  add(DiagnosticCode::space_unknown, unknown_,
      "taken as they are, since it cannot be compared with that of the first one, " +
          (grid_->space.empty() ? std::string("unknown") : grid_->space));
  return findings;
}

}  // namespace tetwright
