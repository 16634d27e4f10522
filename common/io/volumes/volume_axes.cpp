// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/volume_axes.h"

#include <algorithm>
#include <numeric>

#include "common/message_text.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

std::string axis_text(std::span<const std::string> names, std::size_t axis) {
  return "axis " +
         (axis < names.size() && !names[axis].empty() ? in_quotes(names[axis]) : std::to_string(axis));
}

/// Axes that are called x, y and z, or none if one is missing.
std::vector<std::size_t> axes_by_name(std::span<const std::string> names) {
  std::vector<std::size_t> axes;
  for (const char* name : {"x", "y", "z"}) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) return {};
    axes.push_back(static_cast<std::size_t>(found - names.begin()));
  }
  return axes;
}

/// The last axes; those of one item are left out first, from the first axis on.
std::vector<std::size_t> last_axes(std::span<const std::int64_t> shape) {
  std::vector<std::size_t> kept = row_major_order(shape.size());
  for (std::size_t k = 0; k < kept.size() && kept.size() > 3;)
    if (shape[kept[k]] == 1)
      kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(k));
    else
      ++k;
  if (kept.size() > 3) kept.erase(kept.begin(), kept.end() - 3);
  std::reverse(kept.begin(), kept.end());
  return kept;
}

}  // namespace

VolumeAxes volume_axes(std::span<const std::int64_t> shape, std::span<const std::string> names, VoxelUse use,
                       const std::string& file) {
  if (shape.size() < 3)
    throw InputError(file, 0,
                     std::to_string(shape.size()) + " axes; " + name_of_use(use) + " has 3" +
                         (use == VoxelUse::image ? ", and one of channels if there are several" : ""));
  std::vector<std::size_t> axes;
  const bool named = names.size() == shape.size();
  if (named) axes = axes_by_name(names);
  if (axes.empty()) axes = last_axes(shape);
  VolumeAxes out{{axes[0], axes[1], axes[2]}, std::nullopt};
  for (std::size_t k = 0; k < shape.size(); ++k) {
    if (shape[k] == 1 || std::find(axes.begin(), axes.end(), k) != axes.end()) continue;
    if (use == VoxelUse::labels)
      throw InputError(file, 0,
                       axis_text(names, k) + " has " + std::to_string(shape[k]) +
                           " items, and each voxel needs one label; save one of them (one time, one channel) "
                           "as an array of three axes");
    if (out.channel || (named && !names[k].empty() && names[k] != "c" && names[k] != "channel"))
      throw InputError(file, 0,
                       axis_text(names, k) + " has " + std::to_string(shape[k]) +
                           " items beside three spatial axes" +
                           (out.channel ? " and " + axis_text(names, *out.channel) : "") +
                           ", and only one of channels (\"c\") is read; save one of its items");
    out.channel = k;
  }
  return out;
}

std::vector<std::size_t> strides_of(std::span<const std::int64_t> shape, std::span<const std::size_t> order) {
  std::vector<std::size_t> strides(shape.size());
  std::size_t stride = 1;
  for (std::size_t k = order.size(); k-- > 0;) {
    strides[order[k]] = stride;
    stride *= static_cast<std::size_t>(shape[order[k]]);
  }
  return strides;
}

std::vector<std::size_t> row_major_order(std::size_t axes) {
  std::vector<std::size_t> order(axes);
  std::iota(order.begin(), order.end(), std::size_t{0});
  return order;
}

}  // namespace tetwright
