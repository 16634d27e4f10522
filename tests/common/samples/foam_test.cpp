// SPDX-License-Identifier: Apache-2.0
#include "common/samples/foam.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <variant>
#include <vector>

#include "common/random.h"
#include "common/samples/samples.h"
#include "tests/common/io/volume_boxes.h"
#include "tests/common/temporary_folder.h"
#include "tetwright/io.h"
#include "tetwright/resources.h"

namespace tetwright::foam_test {
namespace {

/// FNV-1a.
std::string hash_of(const std::string& bytes) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3;
  char text[32];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

/// Bytes of the file of a foam.
std::string written(int voxels, std::uint32_t grains) {
  const TemporaryFolder f;
  const Foam foam(voxels, grains);
  write_label_source(foam, foam.grains(), f / "foam.nrrd");
  return contents(f / "foam.nrrd");
}

/// Voxels of each grain; the first entry is those of other labels.
std::vector<std::size_t> grain_sizes(const LabelVolume& volume, std::uint32_t grains) {
  std::vector<std::size_t> sizes(grains + 1);
  for (const MaterialTag label : volume.labels)
    ++sizes[label >= 1 && label <= static_cast<MaterialTag>(grains) ? static_cast<std::size_t>(label) : 0];
  return sizes;
}

/// Label of the seed nearest to a voxel, found by comparing all. The squares of exact positions are exact.
MaterialTag nearest_grain(const Foam& foam, const Vec3& voxel) {
  MaterialTag nearest = 1;
  for (MaterialTag grain = 2; grain <= foam.grains(); ++grain)
    if ((foam.seed(grain) - voxel).squaredNorm() < (foam.seed(nearest) - voxel).squaredNorm())
      nearest = grain;
  return nearest;
}

TEST(Foam, VoxelsBelongToTheNearestSeed) {
  for (const auto& [voxels, grains] : {std::pair{4, 1u}, {7, 5u}, {18, 91u}, {30, 9u}, {41, 2u}}) {
    const Foam foam(voxels, grains);
    LabelVolume expected;
    static_cast<LabelGrid&>(expected) = foam.grid();
    for (int z = 0; z < voxels; ++z)
      for (int y = 0; y < voxels; ++y)
        for (int x = 0; x < voxels; ++x) expected.labels.push_back(nearest_grain(foam, Vec3(x, y, z)));
    EXPECT_EQ(read_all(foam, "foam").labels, expected.labels) << voxels;
    EXPECT_EQ(wrong_boxes(foam, expected, 1), 0) << voxels;
  }
}

TEST(Foam, OfTheLargestSizeIsRead) {
  const Foam foam(max_foam_voxels, 200);
  Random random(1);
  const VoxelIndex end = foam.grid().size;
  for (int i = 0; i < 200; ++i) {
    // The first box is at the far corner.
    VoxelIndex low;
    for (std::size_t k = 0; k < 3; ++k)
      low[k] = i == 0 ? end[k] - 1 : static_cast<int>(random.below(max_foam_voxels - 40));
    std::vector<MaterialTag> labels(i == 0 ? 1 : 40);
    foam.read(low, {low[0] + static_cast<int>(labels.size()), low[1] + 1, low[2] + 1}, labels);
    EXPECT_EQ(labels.front(), nearest_grain(foam, Vec3(low[0], low[1], low[2])));
    EXPECT_EQ(labels.back(),
              nearest_grain(foam, Vec3(low[0] + static_cast<int>(labels.size()) - 1, low[1], low[2])));
  }
}

TEST(Foam, GrainsVaryInSizeAndNoneIsTiny) {
  for (const auto& [voxels, grains] : {std::pair{64, 20u}, {64, 4096u}, {100, 200u}}) {
    const std::vector<std::size_t> sizes = grain_sizes(read_all(Foam(voxels, grains), "foam"), grains);
    EXPECT_EQ(sizes[0], 0u);
    const auto [min, max] = std::minmax_element(sizes.begin() + 1, sizes.end());
    const std::size_t average = static_cast<std::size_t>(voxels) * voxels * voxels / grains;
    EXPECT_GT(*min, average / 6) << voxels;
    EXPECT_LT(*max, average * 3) << voxels;
    EXPECT_GT(*max, *min * 3) << voxels;
  }
}

TEST(Foam, HasTheSameBytesOnEveryMachineAndForAnyNumberOfThreads) {
  for (const unsigned threads : {1u, 4u}) {
    const ThreadLimit limit(threads);
    EXPECT_EQ(hash_of(written(64, 20)), "4b7ca7c5ae87e225");
    EXPECT_EQ(hash_of(written(65, 300)), "43e2b8adb0b2f4b7");
  }
}

TEST(Foam, FilesHoldTheLabels) {
  const TemporaryFolder f;
  // Larger than a slab of the writer.
  const Foam foam(272, 300);
  write_label_source(foam, foam.grains(), f / "foam.nrrd");
  EXPECT_EQ(read_label_volume(f / "foam.nrrd").labels, read_all(foam, "foam").labels);
  const auto opened = open_label_source(f / "foam.nrrd");
  EXPECT_FALSE(opened->in_memory());
  EXPECT_EQ(opened->grid().directions, Eigen::Matrix3d::Identity());
  EXPECT_EQ(opened->grid().origin, Vec3::Zero());
  EXPECT_FALSE(opened->grid().spacing_assumed);
}

TEST(Foam, TheSampleHasTheDefaults) {
  EXPECT_EQ(std::get<LabelVolume>(make_sample(foam_name)).labels, read_all(Foam(64, 20), "foam").labels);
  EXPECT_EQ(default_foam_grains(64), 20u);
  EXPECT_EQ(default_foam_grains(8), 8u);
  EXPECT_EQ(max_foam_grains(4), 1u);
  EXPECT_EQ(max_foam_grains(4096), 1'000'000u);
}

}  // namespace
}  // namespace tetwright::foam_test
