// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/connected_components.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "common/random.h"
#include "tests/mesher/label_volumes.h"
#include "tetwright/resources.h"

namespace tetwright::connected_components_test {
namespace {

using Size = std::array<int, 3>;
using Regions = std::vector<RegionIndex>;

Regions merged(const Regions& regions, const Size& size, std::size_t min_voxels) {
  RegionGrid grid = grid_of(size, regions);
  merge_small_islands(grid, min_voxels, nullptr);
  return voxels_of(grid);
}

/// One row of voxels, a digit each.
Regions row(const std::string& digits) {
  Regions regions;
  for (char c : digits) regions.push_back(static_cast<RegionIndex>(c - '0'));
  return regions;
}
std::string merged_row(const std::string& digits, std::size_t min_voxels) {
  std::string text;
  for (RegionIndex r : merged(row(digits), {static_cast<int>(digits.size()), 1, 1}, min_voxels))
    text += static_cast<char>('0' + r);
  return text;
}
/// A plane of 3 x 3 voxels.
std::string merged_plane(const std::string& nine, std::size_t min_voxels) {
  std::string text;
  for (RegionIndex r : merged(row(nine), {3, 3, 1}, min_voxels)) text += static_cast<char>('0' + r);
  return text;
}

/// A literal implementation of the rules: searches all islands again after each merge.
class Plain {
 public:
  Plain(Regions regions, const Size& size) : regions_(std::move(regions)), size_(size) {}

  Regions merge(std::size_t min_voxels) {
    for (;;) {
      std::vector<std::vector<std::size_t>> islands = find();
      // Islands are in order of their lowest voxels, which a stable sort by size preserves.
      const auto largest = std::max_element(islands.begin(), islands.end(),
                                            [](const auto& a, const auto& b) { return a.size() < b.size(); });
      if (largest->size() < min_voxels) return regions_;
      const auto size = [&](const auto& island) {
        return continues(island) ? std::max(island.size(), min_voxels) : island.size();
      };
      std::stable_sort(islands.begin(), islands.end(),
                       [&](const auto& a, const auto& b) { return size(a) < size(b); });
      if (size(islands.front()) >= min_voxels) return regions_;
      std::map<RegionIndex, int> faces;
      for (std::size_t v : islands.front())
        for (std::size_t n : neighbours(v))
          if (regions_[n] != regions_[v]) ++faces[regions_[n]];
      const auto best = std::max_element(faces.begin(), faces.end(),
                                         [](const auto& a, const auto& b) { return a.second < b.second; });
      for (std::size_t v : islands.front()) regions_[v] = best->first;
    }
  }

  std::vector<std::vector<std::size_t>> find() const {
    std::vector<std::vector<std::size_t>> islands;
    std::vector<char> seen(regions_.size(), 0);
    for (std::size_t start = 0; start < regions_.size(); ++start) {
      if (seen[start]) continue;
      seen[start] = 1;
      std::vector<std::size_t> island{start};
      for (std::size_t i = 0; i < island.size(); ++i)
        for (std::size_t n : touching(island[i]))
          if (!seen[n] && regions_[n] == regions_[start]) {
            seen[n] = 1;
            island.push_back(n);
          }
      islands.push_back(island);
    }
    return islands;
  }

 private:
  /// True for the outside at the border.
  bool continues(const std::vector<std::size_t>& island) const {
    if (regions_[island[0]] != outside_region) return false;
    return std::any_of(island.begin(), island.end(), [&](std::size_t v) {
      for (int n : size_) {
        const std::size_t count = static_cast<std::size_t>(n), at = v % count;
        if (count > 1 && (at == 0 || at + 1 == count)) return true;
        v /= count;
      }
      return false;
    });
  }

  std::vector<std::size_t> touching(std::size_t v) const {
    const int x = static_cast<int>(v) % size_[0], y = static_cast<int>(v) / size_[0] % size_[1],
              z = static_cast<int>(v) / size_[0] / size_[1];
    std::vector<std::size_t> result;
    for (int k = std::max(0, z - 1); k <= std::min(size_[2] - 1, z + 1); ++k)
      for (int j = std::max(0, y - 1); j <= std::min(size_[1] - 1, y + 1); ++j)
        for (int i = std::max(0, x - 1); i <= std::min(size_[0] - 1, x + 1); ++i)
          result.push_back(static_cast<std::size_t>((k * size_[1] + j) * size_[0] + i));
    return result;
  }

  std::vector<std::size_t> neighbours(std::size_t v) const {
    std::vector<std::size_t> result;
    std::size_t step = 1, rest = v;
    for (int n : size_) {
      const std::size_t count = static_cast<std::size_t>(n), at = rest % count;
      if (at > 0) result.push_back(v - step);
      if (at + 1 < count) result.push_back(v + step);
      rest /= count;
      step *= count;
    }
    return result;
  }

  Regions regions_;
  Size size_;
};

TEST(ConnectedComponents, TheSameAsByTheRulesTakenLiterally) {
  Random random(1);
  std::size_t changed = 0;
  for (int round = 0; round < 1500; ++round) {
    const Size size{1 + static_cast<int>(random.below(7)), 1 + static_cast<int>(random.below(7)),
                    1 + static_cast<int>(random.below(7))};
    const std::uint32_t labels = 2 + random.below(4), same = random.below(4);
    Regions regions(static_cast<std::size_t>(size[0] * size[1] * size[2]));
    for (std::size_t i = 0; i < regions.size(); ++i)
      regions[i] =
          i > 0 && random.below(4) < same ? regions[i - 1] : static_cast<RegionIndex>(random.below(labels));
    const std::size_t min_voxels = 1 + random.below(14);
    SCOPED_TRACE("round " + std::to_string(round));
    Plain plain(regions, size);
    const std::vector<std::vector<std::size_t>> islands = plain.find();
    const Regions expected = plain.merge(min_voxels);
    RegionGrid grid = grid_of(size, regions);
    const IslandMerging merging = merge_small_islands(grid, min_voxels, nullptr);
    const Regions result = voxels_of(grid);
    ASSERT_EQ(result, expected);
    changed += result != regions;

    // The reported merges are the actual ones.
    std::map<std::uint64_t, MergedIsland> merged;
    for (const MergedIsland& m : merging.merged) merged[m.voxel] = m;
    ASSERT_EQ(merged.size(), merging.merged.size());
    std::size_t largest = 0;
    for (const std::vector<std::size_t>& island : islands) {
      largest = std::max(largest, island.size());
      const auto found = merged.find(island[0]);
      ASSERT_EQ(found != merged.end(), result[island[0]] != regions[island[0]]);
      if (found == merged.end()) continue;
      EXPECT_EQ(found->second.voxels, island.size());
      EXPECT_EQ(found->second.from, regions[island[0]]);
      EXPECT_EQ(found->second.to, result[island[0]]);
      merged.erase(found);
    }
    EXPECT_TRUE(merged.empty());
    EXPECT_EQ(merging.islands, min_voxels > 1 ? islands.size() : 0);
    EXPECT_EQ(merging.none_reaches, min_voxels > 1 && largest < min_voxels);
  }
  EXPECT_GT(changed, 500u);
}

TEST(ConnectedComponents, JoinWhatTheyShareMostFacesWith) {
  EXPECT_EQ(merged_plane("111"
                         "121"
                         "333",
                         2),
            "111111333");
  EXPECT_EQ(merged_plane("313"
                         "323"
                         "111",
                         2)
                .substr(3, 3),
            "333");
}

TEST(ConnectedComponents, BetweenEqualNeighboursTheSmallestRegionIsJoined) {
  EXPECT_EQ(merged_row("3331222", 2), "3332222");
  EXPECT_EQ(merged_row("2221333", 2), "2222333");
  EXPECT_EQ(merged_row("2221000", 2), "2220000");
}

TEST(ConnectedComponents, OfEqualIslandsThatWithTheLowestVoxelIsFirst) {
  // The 1 joins the 2, which is then large enough; in the opposite order the 2 would vanish.
  EXPECT_EQ(merged_row("3331233", 2), "3332233");
  // Here the 2 joins the 1.
  EXPECT_EQ(merged_row("3332133", 2), "3331133");
}

TEST(ConnectedComponents, TheSmallestIsFirst) {
  // The 2 joins the 1, which then is large enough; before that, the 1 would have joined the 0.
  EXPECT_EQ(merged_row("00001123333", 3), "00001113333");
}

TEST(ConnectedComponents, ChainsOfMerges) {
  // The 3 joins the 2, both join the 1, and all of them the 4, as each is still too small.
  EXPECT_EQ(merged_row("44444112300000", 1), "44444112300000");
  EXPECT_EQ(merged_row("5555552311155555", 4), "5555551111155555");
  EXPECT_EQ(merged_row("9999991299999", 4), "9999999999999");
  // An island that joins two islands of one region unites them into one that is large enough.
  EXPECT_EQ(merged_row("999991121199999", 5), "999991111199999");
}

TEST(ConnectedComponents, OutsideGoesOnBeyondTheBorder) {
  EXPECT_EQ(merged_row("0111", 2), "0111");
  EXPECT_EQ(merged_row("1110", 2), "1110");
  EXPECT_EQ(merged_row("1101", 2), "1111");
  EXPECT_EQ(merged_plane("111"
                         "110"
                         "111",
                         4),
            "111110111");
  // The outside of a slice does not continue across its plane.
  EXPECT_EQ(merged_plane("111"
                         "101"
                         "111",
                         4),
            "111111111");
  // Islands that join the outside at the border stay outside, however small both are.
  EXPECT_EQ(merged_row("22222223100", 5), "22222220000");
  Regions notch(27, 1);
  notch[13 - 9] = outside_region;  // the middle of the lowest plane
  EXPECT_EQ(merged(notch, {3, 3, 3}, 8), notch);
  Regions hole(27, 1);
  hole[13] = outside_region;
  EXPECT_EQ(merged(hole, {3, 3, 3}, 8), Regions(27, 1));
}

TEST(ConnectedComponents, OutsideIsARegionLikeOthersAndBeyondTheVolumeIsNothing) {
  EXPECT_EQ(merged_row("1101", 2), "1111");
  EXPECT_EQ(merged_row("1000", 2), "0000");
  // A corner has three faces beyond the volume, which do not count.
  Regions corner(27, 1);
  corner[0] = 2;
  EXPECT_EQ(merged(corner, {3, 3, 3}, 2), Regions(27, 1));
}

TEST(ConnectedComponents, IslandsTouchInEdgesAndCorners) {
  EXPECT_EQ(merged_plane("100"
                         "010"
                         "000",
                         2),
            "100010000");
  EXPECT_EQ(merged_plane("100"
                         "010"
                         "000",
                         3),
            "000000000");
  Regions corner(27, 0);
  corner[0] = corner[13] = corner[26] = 1;
  EXPECT_EQ(merged(corner, {3, 3, 3}, 3), corner);
  EXPECT_EQ(merged(corner, {3, 3, 3}, 4), Regions(27, 0));
  // The end of a row or plane does not touch the start of the next.
  EXPECT_EQ(merged_plane("001"
                         "100"
                         "000",
                         2),
            "000000000");
  Regions planes(18, 0);
  planes[8] = planes[9] = 1;
  EXPECT_EQ(merged(planes, {3, 3, 2}, 2), Regions(18, 0));
}

TEST(ConnectedComponents, LargeIslandsThatMergingJoinsAreListed) {
  RegionGrid grid = grid_of({7, 1, 1}, row("1110111"));
  const IslandMerging merging = merge_small_islands(grid, 3, nullptr);
  EXPECT_EQ(voxels_of(grid), row("1111111"));
  ASSERT_EQ(merging.joined.size(), 1u);
  EXPECT_EQ(merging.joined[0].region, 1);
  EXPECT_EQ(merging.joined[0].voxel, 3u);
  RegionGrid others = grid_of({7, 1, 1}, row("1110222"));
  EXPECT_TRUE(merge_small_islands(others, 3, nullptr).joined.empty());
}

TEST(ConnectedComponents, NothingIsMergedWhereNoIslandReachesTheNumber) {
  for (const std::string text : {"0123", "1", "1111"}) {
    RegionGrid grid = grid_of({static_cast<int>(text.size()), 1, 1}, row(text));
    const IslandMerging merging = merge_small_islands(grid, 5, nullptr);
    EXPECT_EQ(voxels_of(grid), row(text));
    EXPECT_TRUE(merging.none_reaches);
    EXPECT_TRUE(merging.merged.empty());
    EXPECT_EQ(merging.islands, std::set<char>(text.begin(), text.end()).size());
  }
  RegionGrid grid = grid_of({4, 1, 1}, row("1121"));
  EXPECT_TRUE(merge_small_islands(grid, std::size_t{1} << 40, nullptr).none_reaches);
}

TEST(ConnectedComponents, TheSameForAnyNumberOfThreads) {
  Random random(2);
  const Size size{40, 30, 50};
  Regions regions(60000);
  for (std::size_t i = 0; i < regions.size(); ++i)
    regions[i] = i > 1200 && random.below(3) ? regions[i - (random.below(2) ? 1 : 1200)]
                                             : static_cast<RegionIndex>(random.below(5));
  for (std::size_t min_voxels : {2u, 20u}) {
    std::vector<Regions> results;
    for (unsigned threads : {1u, 2u, 3u, 8u}) {
      const ThreadLimit limit(threads);
      results.push_back(merged(regions, size, min_voxels));
      EXPECT_EQ(results.back(), results[0]) << threads;
    }
    EXPECT_NE(results[0], regions);
  }
}

/// By flood fill: the number of parts of a region, for the outside only those that do not reach the border.
std::size_t plain_parts(const Regions& regions, const Size& size, RegionIndex region, bool touching) {
  std::vector<std::uint8_t> seen(regions.size(), 0);
  const auto at_border = [&](const Size& p) {
    for (int a = 0; a < 3; ++a)
      if (p[a] == 0 || p[a] == size[a] - 1) return true;
    return false;
  };
  const auto place = [&](const Size& p) {
    return (static_cast<std::size_t>(p[2]) * size[1] + p[1]) * size[0] + p[0];
  };
  std::size_t parts = 0;
  for (std::size_t i = 0; i < regions.size(); ++i) {
    if (seen[i] || regions[i] != region) continue;
    seen[i] = 1;
    const int n = static_cast<int>(i);
    std::vector<Size> open{{n % size[0], n / size[0] % size[1], n / size[0] / size[1]}};
    bool border = false;
    while (!open.empty()) {
      const Size p = open.back();
      open.pop_back();
      border |= at_border(p);
      for (int k = 0; k < 27; ++k) {
        const Size step{k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
        if (!touching && std::abs(step[0]) + std::abs(step[1]) + std::abs(step[2]) > 1) continue;
        const Size q{p[0] + step[0], p[1] + step[1], p[2] + step[2]};
        bool inside = true;
        for (int a = 0; a < 3; ++a) inside &= q[a] >= 0 && q[a] < size[a];
        if (!inside || regions[place(q)] != region || seen[place(q)]) continue;
        seen[place(q)] = 1;
        open.push_back(q);
      }
    }
    parts += region != outside_region || !border;
  }
  return parts;
}

TEST(ConnectedComponents, PartsAreThoseOfAFloodFill) {
  Random random(7);
  for (const Size& size : {Size{6, 5, 4}, Size{9, 1, 7}, Size{1, 8, 8}, Size{13, 12, 1}, Size{20, 9, 10}})
    for (int round = 0; round < 20; ++round) {
      Regions regions(static_cast<std::size_t>(size[0]) * size[1] * size[2]);
      for (RegionIndex& r : regions) r = static_cast<RegionIndex>(random.below(2 + round % 4));
      const std::vector<RegionParts> parts = count_parts(grid_of(size, regions), 5, nullptr);
      for (RegionIndex r = 0; r < 5; ++r) {
        EXPECT_EQ(parts[r].by_faces, plain_parts(regions, size, r, false));
        EXPECT_EQ(parts[r].touching, plain_parts(regions, size, r, true));
        EXPECT_EQ(parts[r].smallest == no_voxel, parts[r].by_faces == 0);
        if (parts[r].smallest != no_voxel) {
          EXPECT_EQ(regions[parts[r].smallest], r);
        }
      }
    }
  EXPECT_EQ(count_parts(grid_of({10, 1, 1}, row("1101000100")), 2, nullptr)[1].smallest, 3u);
}

TEST(ConnectedComponents, CanBeInterrupted) {
  Progress progress;
  progress.cancel();
  RegionGrid grid = grid_of({4, 1, 1}, row("1121"));
  EXPECT_THROW(merge_small_islands(grid, 2, &progress), Interrupted);
  EXPECT_THROW(count_parts(grid, 3, &progress), Interrupted);
}

}  // namespace
}  // namespace tetwright::connected_components_test
