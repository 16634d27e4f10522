// SPDX-License-Identifier: Apache-2.0
#include "mesher/cut/independent_rounds.h"

#include <gtest/gtest.h>

#include "common/random.h"
#include "tests/mesher/lattices.h"

namespace tetwright::independent_rounds_test {
namespace {

// Each point is assigned one more than the largest number within two edges, so the result depends on the
// order.
TEST(IndependentRounds, AreLikeOneAfterTheOther) {
  const LabelledLattice lattice = make_lattice([](const Vec3& p) { return p.x() + p.y() < 5.2 ? 1 : 0; });
  std::vector<Index> points = lattice.stars.points();
  Random random(3);
  for (std::size_t i = points.size(); i > 1; --i)
    std::swap(points[i - 1], points[random.below(static_cast<std::uint32_t>(i))]);
  const auto visit = [&](std::vector<int>& numbers, Index p) {
    int max_number = 0;
    for (Index t : lattice.stars.tets(p))
      for (Index q : lattice.tets[t]) {
        max_number = std::max(max_number, numbers[q]);
        if (!lattice.stars.lists(q)) continue;
        for (Index u : lattice.stars.tets(q))
          for (Index r : lattice.tets[u]) max_number = std::max(max_number, numbers[r]);
      }
    numbers[p] = max_number + 1;
  };
  // Groups of one, two, three, ... points.
  std::vector<std::size_t> starts{0};
  while (starts.back() < points.size())
    starts.push_back(std::min(points.size(), starts.back() + 1 + starts.size() % 5));
  std::vector<int> expected(lattice.positions.size(), 0);
  for (Index p : points) visit(expected, p);
  for (unsigned threads : {1u, 4u}) {
    const ThreadLimit limit(threads);
    std::vector<int> numbers(lattice.positions.size(), 0);
    std::size_t last = 0;
    IndependentRounds(lattice).run(
        points, starts,
        [&](std::span<const Index> groups) {
          for (Index b : groups)
            for (std::size_t k = starts[b]; k < starts[b + 1]; ++k) visit(numbers, points[k]);
        },
        [&](std::size_t done) { last = done; });
    EXPECT_EQ(numbers, expected);
    EXPECT_EQ(last, starts.size() - 1);
  }
}

}  // namespace
}  // namespace tetwright::independent_rounds_test
