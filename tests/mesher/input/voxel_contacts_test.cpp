// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/voxel_contacts.h"

#include <gtest/gtest.h>

#include <array>
#include <map>

#include "common/random.h"
#include "tests/mesher/label_volumes.h"
#include "tetwright/resources.h"

namespace tetwright::voxel_contacts_test {
namespace {

TEST(VoxelContacts, AsByTheRulesTakenLiterally) {
  Random random(4);
  for (int round = 0; round < 60; ++round) {
    const std::array<int, 3> size{1 + static_cast<int>(random.below(6)),
                                  1 + static_cast<int>(random.below(6)),
                                  1 + static_cast<int>(random.below(40))};
    const std::uint32_t labels = 2 + random.below(5), same = random.below(4);
    std::vector<RegionIndex> voxels(static_cast<std::size_t>(size[0] * size[1] * size[2]));
    for (std::size_t i = 0; i < voxels.size(); ++i)
      voxels[i] =
          i > 0 && random.below(4) < same ? voxels[i - 1] : static_cast<RegionIndex>(random.below(labels));
    std::map<std::pair<RegionIndex, RegionIndex>, std::uint64_t> expected;
    const auto at = [&](int x, int y, int z) {
      return voxels[static_cast<std::size_t>((z * size[1] + y) * size[0] + x)];
    };
    for (int z = 0; z < size[2]; ++z)
      for (int y = 0; y < size[1]; ++y)
        for (int x = 0; x < size[0]; ++x)
          for (int k = 0; k < 27; ++k) {
            const int dx = k % 3 - 1, dy = k / 3 % 3 - 1, dz = k / 9 - 1;
            const int i = x + dx, j = y + dy, l = z + dz;
            if (i < 0 || j < 0 || l < 0 || i >= size[0] || j >= size[1] || l >= size[2]) continue;
            const RegionIndex a = at(x, y, z), b = at(i, j, l);
            if (a < b) expected[{a, b}] += std::abs(dx) + std::abs(dy) + std::abs(dz) == 1;
          }
    for (const unsigned threads : {1u, 3u}) {
      const ThreadLimit limit(threads);
      const std::vector<VoxelContact> found = voxel_contacts(grid_of(size, voxels), nullptr);
      ASSERT_EQ(found.size(), expected.size());
      for (const VoxelContact& c : found) {
        const auto e = expected.find({c.first, c.second});
        ASSERT_NE(e, expected.end());
        EXPECT_EQ(c.faces, e->second);
        EXPECT_TRUE(voxels[c.voxel] == c.first || voxels[c.voxel] == c.second);
      }
    }
  }
}

}  // namespace
}  // namespace tetwright::voxel_contacts_test
