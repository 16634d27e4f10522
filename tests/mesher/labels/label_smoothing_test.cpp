// SPDX-License-Identifier: Apache-2.0
#include "mesher/labels/label_smoothing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "common/random.h"

namespace tetwright::label_smoothing_test {
namespace {

constexpr int cells = LabelSmoother::cells, nodes = LabelSmoother::nodes, reach = LabelSmoother::reach;
using Labels = std::function<RegionIndex(int x, int y, int z)>;
using Node = std::array<int, 3>;

/// Selects the nodes of a tile that tests examine: a corner of it, and its faces, which neighbouring tiles
/// share.
bool is_looked_at(int x, int y, int z) {
  constexpr int corner = 16;
  const auto on_face = [](int i) { return i == 0 || i == nodes - 1; };
  return (x <= corner && y <= corner && z <= corner) || on_face(x) || on_face(y) || on_face(z);
}

/// Distances of each label at the examined nodes of the tile whose first node is `first`.
std::map<Node, std::map<RegionIndex, float>> distances(LabelSmoother& smoother, const Node& first,
                                                       const Labels& label) {
  std::size_t i = 0;
  for (int z = -reach; z < nodes + reach; ++z)
    for (int y = -reach; y < nodes + reach; ++y)
      for (int x = -reach; x < nodes + reach; ++x)
        smoother.voxels()[i++] = label(first[0] + x, first[1] + y, first[2] + z);
  smoother.number_labels();
  smoother.smooth(std::vector<float>(1 << 16, 0.0F));
  std::map<Node, std::map<RegionIndex, float>> all;
  for (std::size_t l = 0; l < smoother.labels().size(); ++l)
    for (int z = 0; z < nodes; ++z)
      for (int y = 0; y < nodes; ++y)
        for (int x = 0; x < nodes; ++x)
          if (is_looked_at(x, y, z))
            all[{first[0] + x, first[1] + y, first[2] + z}][smoother.labels()[l]] =
                smoother.distance(l, x, y, z);
  return all;
}

/// Random labels that depend only on the position.
Labels noise(std::uint64_t seed, std::uint32_t labels, int coarseness = 1) {
  return [=](int x, int y, int z) {
    const auto part = [&](int v) { return static_cast<std::uint64_t>((v + 1000) / coarseness); };
    return static_cast<RegionIndex>(Random(seed, part(x) * 4096 + part(y), part(z)).below(labels));
  };
}

struct Named {
  const char* what;
  Labels labels;
};
std::vector<Named> all_labels() {
  return {{"noise of two", noise(1, 2)},
          {"noise of five", noise(2, 5)},
          {"noise of many", noise(3, 30)},
          {"coarse noise", noise(4, 6, 4)},
          {"sheet", [](int x, int y, int z) { return RegionIndex(z == (x + y) / 3 + 4 ? 2 : 7); }},
          {"edge-connected sheet", [](int x, int, int z) { return RegionIndex(z == x  ? 2
                                                                              : z > x ? 1
                                                                                      : 3); }},
          {"checkerboard", [](int x, int y, int z) { return RegionIndex((x + y + z + 300) % 2); }},
          {"one voxel", [](int x, int y, int z) { return RegionIndex(x == 8 && y == 8 && z == 8); }},
          {"ball", [](int x, int y, int z) {
             return RegionIndex((x - 14) * (x - 14) + (y - 9) * (y - 9) + (z - 8) * (z - 8) < 60 ? 65535 : 3);
           }}};
}

TEST(LabelSmoothing, NodesOfNeighbouringTilesAreTheSameBits) {
  // A new smoother for each tile and one smoother for all tiles must agree, so no state of a previous tile
  // may remain.
  LabelSmoother used;
  for (const Named& n : all_labels()) {
    SCOPED_TRACE(n.what);
    const auto here = distances(used, {0, 0, 0}, n.labels);
    for (const Node& step : {Node{cells, 0, 0}, Node{0, -cells, cells}}) {
      LabelSmoother fresh;
      const auto there = distances(fresh, step, n.labels);
      EXPECT_EQ(there, distances(used, step, n.labels));
      std::size_t shared = 0;
      for (const auto& [node, of_labels] : here) {
        const auto other = there.find(node);
        if (other == there.end()) continue;
        ++shared;
        for (const auto& [label, d] : of_labels) {
          const auto its = other->second.find(label);
          // A label that does not occur in one tile is far away in the other.
          ASSERT_EQ(d, its == other->second.end() ? LabelSmoother::band : its->second)
              << "label " << label << " at " << node[0] << " " << node[1] << " " << node[2];
        }
      }
      EXPECT_GT(shared, 0u);
    }
  }
}

/// Volume of each label in the cells of the tile's first part, voxels, by dense sampling of the trilinear
/// distances.
std::map<RegionIndex, double> sampled_shares(const LabelSmoother& smoother, int along) {
  constexpr int samples = LabelSmoother::part_cells;
  std::map<RegionIndex, double> sums;
  const auto value = [&](std::size_t l, double x, double y, double z) {
    const int i = static_cast<int>(x), j = static_cast<int>(y), k = static_cast<int>(z);
    double sum = 0;
    for (int c = 0; c < 8; ++c)
      sum += (c & 1 ? x - i : 1 - x + i) * (c & 2 ? y - j : 1 - y + j) * (c & 4 ? z - k : 1 - z + k) *
             static_cast<double>(smoother.distance(l, i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)));
    return sum;
  };
  for (int k = 0; k < samples * along; ++k)
    for (int j = 0; j < samples * along; ++j)
      for (int i = 0; i < samples * along; ++i) {
        double smallest = HUGE_VAL;
        RegionIndex winner = 0;
        for (std::size_t l = 0; l < smoother.labels().size(); ++l)
          if (const double d = value(l, (i + 0.5) / along, (j + 0.5) / along, (k + 0.5) / along);
              d < smallest)
            smallest = d, winner = smoother.labels()[l];
        sums[winner] += 1.0 / (along * along * along);
      }
  return sums;
}

TEST(LabelSmoothing, SharesAreTheVolumes) {
  for (const Named& n : all_labels()) {
    SCOPED_TRACE(n.what);
    LabelSmoother smoother;
    distances(smoother, {0, 0, 0}, n.labels);
    if (smoother.labels().size() > 8) continue;  // sampling would take too long
    // Rods from corner to corner are narrower than two samples.
    const double tolerance = std::string_view(n.what) == "checkerboard" ? 0.15 : 0.02;
    std::map<RegionIndex, double> exact = sampled_shares(smoother, 9);
    const std::vector<double> shares = smoother.shares({0, 0, 0});
    double sum = 0;
    for (std::size_t l = 0; l < shares.size(); ++l) {
      const double volume = exact[smoother.labels()[l]];
      EXPECT_NEAR(shares[l], volume, tolerance * volume + 0.1) << smoother.labels()[l];
      sum += shares[l];
    }
    EXPECT_NEAR(sum, std::pow(LabelSmoother::part_cells, 3), 1e-3);
  }
}

TEST(LabelSmoothing, ContactsAreTheFacesBetweenVoxels) {
  for (const Named& n : all_labels()) {
    SCOPED_TRACE(n.what);
    LabelSmoother smoother;
    const Node first{-7, 3, 20};
    distances(smoother, first, n.labels);
    std::map<std::pair<RegionIndex, RegionIndex>, std::uint32_t> faces;
    for (int z = first[2]; z < first[2] + cells; ++z)
      for (int y = first[1]; y < first[1] + cells; ++y)
        for (int x = first[0]; x < first[0] + cells; ++x)
          for (const Node& to : {Node{x + 1, y, z}, {x, y + 1, z}, {x, y, z + 1}}) {
            const RegionIndex a = n.labels(x, y, z), b = n.labels(to[0], to[1], to[2]);
            if (a != b) ++faces[std::minmax(a, b)];
          }
    std::vector<std::pair<RegionIndex, RegionIndex>> found;
    for (const LabelSmoother::Contact& c : smoother.contacts()) {
      EXPECT_EQ(c.faces, faces[std::pair(c.first, c.second)]);
      found.emplace_back(c.first, c.second);
    }
    EXPECT_EQ(found.size(), faces.size());
    EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
  }
}

TEST(LabelSmoothing, EachNodeIsItsOwnLabels) {
  LabelSmoother smoother;
  for (const Named& n : all_labels()) {
    SCOPED_TRACE(n.what);
    for (const auto& [node, of_labels] : distances(smoother, {0, 0, 0}, n.labels)) {
      const RegionIndex own = n.labels(node[0], node[1], node[2]);
      for (const auto& [label, d] : of_labels) {
        ASSERT_LE(std::abs(d), LabelSmoother::band + 0.01F);
        if (label == own) continue;
        ASSERT_LT(of_labels.at(own), d) << label << " at " << node[0] << " " << node[1];
      }
    }
  }
}

TEST(LabelSmoothing, AFlatInterfaceIsWhereTheVoxelsHaveIt) {
  LabelSmoother smoother;
  const auto all = distances(smoother, {0, 0, 0}, [](int, int y, int) { return RegionIndex(y < 8 ? 4 : 6); });
  for (const auto& [node, of_labels] : all) {
    const double d = node[1] - 7.5;
    if (std::abs(d) > 1) continue;
    EXPECT_NEAR(of_labels.at(4), d, 0.1) << node[1];
    EXPECT_NEAR(of_labels.at(6), -of_labels.at(4), 1e-6);
  }
}

TEST(LabelSmoothing, ASlantedInterfaceIsNearlyFlat) {
  // The plane is half a voxel from the lowest centres above it and the highest below it.
  constexpr double a = 0.37, b = 0.21;
  LabelSmoother smoother;
  const auto height = [](int x, int y) { return 3.2 + a * x + b * y; };
  const auto all = distances(smoother, {0, 0, 0},
                             [&](int x, int y, int z) { return RegionIndex(z < height(x, y) ? 1 : 2); });
  const double slope = std::sqrt(1 + a * a + b * b);
  double sum = 0;
  int count = 0;
  for (const auto& [node, of_labels] : all) {
    const double d = (node[2] - height(node[0], node[1])) / slope;
    if (std::abs(d) > 0.8) continue;
    EXPECT_NEAR(of_labels.at(1), d, 0.3);
    sum += (of_labels.at(1) - d) * (of_labels.at(1) - d), ++count;
  }
  EXPECT_LT(std::sqrt(sum / count), 0.12);
}

TEST(LabelSmoothing, NumbersOfLabelsDoNotMatter) {
  LabelSmoother first, second;
  const Labels labels = noise(9, 4, 3);
  constexpr std::array<RegionIndex, 4> numbers{5, 17, 40000, 65000};
  const auto one = distances(first, {0, 0, 0}, labels);
  const auto other =
      distances(second, {0, 0, 0}, [&](int x, int y, int z) { return numbers[labels(x, y, z)]; });
  for (const auto& [node, of_labels] : one)
    for (const auto& [label, d] : of_labels) ASSERT_EQ(d, other.at(node).at(numbers[label]));
}

TEST(LabelSmoothing, TurnedAndMirroredVoxelsGiveTheSame) {
  LabelSmoother smoother;
  const Labels labels = noise(10, 3, 3);
  const auto one = distances(smoother, {0, 0, 0}, labels);
  const auto turned = distances(smoother, {0, 0, 0}, [&](int x, int y, int z) { return labels(y, z, x); });
  const auto mirrored =
      distances(smoother, {0, 0, 0}, [&](int x, int y, int z) { return labels(cells - x, y, z); });
  for (const auto& [node, of_labels] : one)
    for (const auto& [label, d] : of_labels) {
      if (!is_looked_at(cells - node[0], node[1], node[2])) continue;
      ASSERT_NEAR(d, turned.at({node[2], node[0], node[1]}).at(label), 1e-4);
      ASSERT_NEAR(d, mirrored.at({cells - node[0], node[1], node[2]}).at(label), 1e-4);
    }
}

}  // namespace
}  // namespace tetwright::label_smoothing_test
