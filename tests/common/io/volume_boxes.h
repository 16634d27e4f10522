// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <thread>
#include <vector>

#include "common/random.h"
#include "tests/common/io/memory_files.h"
#include "tests/common/io/volume_bytes.h"
#include "tetwright/label_source.h"

namespace tetwright {

/// A volume whose labels all differ from their neighbours, so that no axis can be mistaken for another.
inline LabelVolume numbered_volume(const VoxelIndex& size) {
  LabelVolume volume;
  volume.size = size;
  for (int z = 0; z < size[2]; ++z)
    for (int y = 0; y < size[1]; ++y)
      for (int x = 0; x < size[0]; ++x) volume.labels.push_back((x + 3 * y + 19 * z) % 127);
  return volume;
}

/// Labels of a box of a volume in memory.
inline std::vector<MaterialTag> box_of(const LabelVolume& volume, const VoxelIndex& low,
                                       const VoxelIndex& high) {
  std::vector<MaterialTag> out;
  for (int z = low[2]; z < high[2]; ++z)
    for (int y = low[1]; y < high[1]; ++y)
      for (int x = low[0]; x < high[0]; ++x)
        out.push_back(volume.labels[(static_cast<std::size_t>(z) * volume.size[1] + y) * volume.size[0] + x]);
  return out;
}

/// Reads boxes at random positions and compares them.
/// \return the number of boxes that differ
inline int wrong_boxes(const LabelSource& source, const LabelVolume& expected, std::uint64_t seed) {
  constexpr int boxes = 60;
  Random random(seed);
  int wrong = 0;
  for (int i = 0; i < boxes; ++i) {
    VoxelIndex low, high;
    std::size_t n = 1;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto size = static_cast<std::uint64_t>(expected.size[k]);
      const auto a = static_cast<int>(random.next() % size), b = static_cast<int>(random.next() % size);
      low[k] = std::min(a, b);
      high[k] = std::max(a, b) + 1;
      n *= static_cast<std::size_t>(high[k] - low[k]);
    }
    std::vector<MaterialTag> labels(n, -1);
    source.read(low, high, labels);
    wrong += labels != box_of(expected, low, high);
  }
  return wrong;
}

/// Expects that a source has the labels, as a whole, and in boxes read by several threads at a time.
inline void expect_labels(const LabelSource& source, const LabelVolume& expected) {
  ASSERT_EQ(source.grid().size, expected.size);
  EXPECT_EQ(read_all(source, "f").labels, expected.labels);
  constexpr std::size_t threads = 3;
  std::array<int, threads> wrong{};
  std::vector<std::thread> readers;
  for (std::size_t t = 0; t < threads; ++t)
    readers.emplace_back([&, t] { wrong[t] = wrong_boxes(source, expected, t + 1); });
  for (std::thread& reader : readers) reader.join();
  for (const int n : wrong) EXPECT_EQ(n, 0);
}

}  // namespace tetwright
