// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "common/parallel/parallel_sort.h"
#include "tetwright/image_values.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

constexpr std::size_t rows_grain = 256;

/// Calls `to(voxel, label)` for each voxel of `image` whose centre is in a voxel of `labels`.
template <class To>
void for_each_label(const LabelGrid& image, const LabelVolume& labels, const To& to) {
  const Eigen::Matrix3d inverse = labels.directions.inverse();
  const std::size_t rows = static_cast<std::size_t>(image.size[1]) * static_cast<std::size_t>(image.size[2]);
  const auto row_length = static_cast<std::size_t>(image.size[0]);
  parallel_for(0, rows, rows_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const auto y = static_cast<double>(row % static_cast<std::size_t>(image.size[1]));
      const std::size_t slice = row / static_cast<std::size_t>(image.size[1]);
      const auto z = static_cast<double>(slice);
      for (std::size_t x = 0; x < row_length; ++x) {
        const Vec3 index = inverse * (image.to_input(Vec3(static_cast<double>(x), y, z)) - labels.origin) +
                           Vec3::Constant(0.5);
        std::array<std::size_t, 3> at{};
        bool inside = true;
        for (std::size_t a = 0; a < 3; ++a) {
          const double floor = std::floor(index[static_cast<int>(a)]);
          inside &= floor >= 0 && floor < static_cast<double>(labels.size[a]);
          at[a] = inside ? static_cast<std::size_t>(floor) : 0;
        }
        if (!inside) continue;
        to(row * row_length + x, labels.labels[(at[2] * static_cast<std::size_t>(labels.size[1]) + at[1]) *
                                                   static_cast<std::size_t>(labels.size[0]) +
                                               at[0]]);
      }
    }
  });
}

}  // namespace

ImageMask ImageMask::nonzero(const LabelGrid& image, const LabelVolume& mask) {
  ImageMask result;
  result.groups_.assign(image.voxels(), 0);
  for_each_label(image, mask,
                 [&](std::size_t voxel, MaterialTag label) { result.groups_[voxel] = label != 0 ? 1 : 0; });
  return result;
}

ImageMask ImageMask::own_label(const LabelGrid& image, const LabelVolume& labels) {
  ImageMask result;
  const std::vector<MaterialTag>& all = labels.labels;
  std::vector<MaterialTag> tags =
      parallel_collect<MaterialTag>(0, all.size(), std::size_t{1} << 18,
                                    [&](std::size_t begin, std::size_t end, std::vector<MaterialTag>& out) {
                                      for (std::size_t i = begin; i < end; ++i)
                                        if (out.empty() || out.back() != all[i]) out.push_back(all[i]);
                                      std::sort(out.begin(), out.end());
                                      out.erase(std::unique(out.begin(), out.end()), out.end());
                                    });
  parallel_sort_unique(tags);
  for (const MaterialTag tag : tags)
    result.group_of_.emplace(tag, static_cast<std::uint32_t>(result.group_of_.size() + 1));
  result.groups_.assign(image.voxels(), 0);
  for_each_label(image, labels, [&](std::size_t voxel, MaterialTag label) {
    result.groups_[voxel] = result.group_of_.at(label);
  });
  return result;
}

CountedVoxels counted_voxels(const ImageVolume& image, const ImageMask& mask,
                             const std::vector<MaterialTag>& materials, std::size_t channel) {
  std::vector<std::uint32_t> groups;
  if (mask.depends_on_material())
    for (const MaterialTag material : materials)
      if (const std::uint32_t group = mask.group_for(material); group != 0) groups.push_back(group);
  std::sort(groups.begin(), groups.end());
  const bool any = !mask.depends_on_material() || materials.empty();
  const auto counts = [&](std::size_t voxel) {
    const std::uint32_t group = mask.group(voxel);
    return group != 0 && (any || std::binary_search(groups.begin(), groups.end(), group));
  };
  const std::vector<float>& values = image.channels[channel];
  constexpr std::size_t grain = std::size_t{1} << 18;
  const std::vector<CountedVoxels> parts = parallel_collect<CountedVoxels>(
      0, values.size(), grain, [&](std::size_t begin, std::size_t end, std::vector<CountedVoxels>& out) {
        CountedVoxels part{0, std::numeric_limits<double>::infinity(),
                           -std::numeric_limits<double>::infinity()};
        for (std::size_t i = begin; i < end; ++i) {
          if (!std::isfinite(values[i]) || !counts(i)) continue;
          ++part.count;
          part.lowest = std::min(part.lowest, static_cast<double>(values[i]));
          part.highest = std::max(part.highest, static_cast<double>(values[i]));
        }
        if (part.count > 0) out.push_back(part);
      });
  CountedVoxels all = parts.empty() ? CountedVoxels() : parts.front();
  for (std::size_t i = 1; i < parts.size(); ++i) {
    all.count += parts[i].count;
    all.lowest = std::min(all.lowest, parts[i].lowest);
    all.highest = std::max(all.highest, parts[i].highest);
  }
  return all;
}

}  // namespace tetwright
