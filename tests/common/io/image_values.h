// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "tetwright/image_volume.h"
#include "tetwright/label_source.h"

namespace tetwright {

/// Fractional value of a voxel that differs from those of its neighbours and of other channels.
inline float image_value(int x, int y, int z, int channel) {
  return static_cast<float>(x) + 0.25f * static_cast<float>(y) - 20 * static_cast<float>(z) +
         500 * static_cast<float>(channel);
}

/// Numbers in the order of a file: the axis of channels varies faster than the spatial axes from `position`
/// on.
template <class Number>
std::vector<Number> image_numbers(const VoxelIndex& size, int channels, std::size_t position) {
  std::vector<int> counts(size.begin(), size.end());
  counts.insert(counts.begin() + static_cast<std::ptrdiff_t>(position), channels);
  std::vector<Number> out;
  for (int d = 0; d < counts[3]; ++d)
    for (int c = 0; c < counts[2]; ++c)
      for (int b = 0; b < counts[1]; ++b)
        for (int a = 0; a < counts[0]; ++a) {
          std::vector<int> at{a, b, c, d};
          const int channel = at[position];
          at.erase(at.begin() + static_cast<std::ptrdiff_t>(position));
          out.push_back(static_cast<Number>(image_value(at[0], at[1], at[2], channel)));
        }
  return out;
}

/// Expects the values of image_value().
inline void expect_image(const ImageVolume& image, const VoxelIndex& size, int channels) {
  ASSERT_EQ(image.size, size);
  ASSERT_EQ(image.channels.size(), static_cast<std::size_t>(channels));
  for (int c = 0; c < channels; ++c) {
    std::vector<float> expected;
    for (int z = 0; z < size[2]; ++z)
      for (int y = 0; y < size[1]; ++y)
        for (int x = 0; x < size[0]; ++x) expected.push_back(image_value(x, y, z, c));
    EXPECT_EQ(image.channels[static_cast<std::size_t>(c)], expected) << "channel " << c;
  }
}

}  // namespace tetwright
