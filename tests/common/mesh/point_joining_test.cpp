// SPDX-License-Identifier: Apache-2.0
#include "common/mesh/point_joining.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "common/random.h"

namespace tetwright::point_joining_test {
namespace {

using Numbers = std::vector<std::vector<Index>>;

struct Piece {
  std::vector<Vec3> points;
  std::vector<std::uint8_t> shared;
};

JoinedPoints join(const std::vector<Piece>& pieces) {
  std::vector<PiecePoints> views;
  for (const Piece& piece : pieces) views.push_back({piece.points, piece.shared});
  return join_points(views);
}

/// Point on the first axis.
Vec3 at(double x) { return {x, 0, 0}; }

TEST(PointJoining, NumbersFollowThePiecesAndTheirPoints) {
  const JoinedPoints joined = join({{{at(5), at(2)}, {0, 0}}, {{at(9), at(1), at(7)}, {0, 0, 0}}});
  EXPECT_EQ(joined.count, 5u);
  EXPECT_EQ(joined.numbers, (Numbers{{0, 1}, {2, 3, 4}}));
}

TEST(PointJoining, SharedPointsAreJoinedOnce) {
  // 2 is in all pieces, 3 in two of them, and 4 only in one although another might have had it.
  const JoinedPoints joined = join({{{at(1), at(2), at(3)}, {0, 1, 1}},
                                    {{at(2), at(4), at(5)}, {1, 1, 0}},
                                    {{at(6), at(3), at(2)}, {0, 1, 1}}});
  EXPECT_EQ(joined.count, 6u);
  EXPECT_EQ(joined.numbers, (Numbers{{0, 1, 2}, {1, 3, 4}, {5, 2, 1}}));
}

TEST(PointJoining, EqualPointsThatAreNotSharedStayApart) {
  const JoinedPoints joined =
      join({{{at(1), at(2)}, {0, 1}}, {{at(1), at(2)}, {0, 0}}, {{at(2), at(1)}, {1, 1}}});
  EXPECT_EQ(joined.count, 5u);
  EXPECT_EQ(joined.numbers, (Numbers{{0, 1}, {2, 3}, {1, 4}}));
}

TEST(PointJoining, OnlyEqualCoordinatesAreJoined) {
  const double next = std::nextafter(1.0, 2.0);
  const JoinedPoints joined =
      join({{{at(1), {0, 1, 0}, {0.0, 0, 3}}, {1, 1, 1}}, {{at(next), {0, 0, 1}, {-0.0, 0, 3}}, {1, 1, 1}}});
  EXPECT_EQ(joined.count, 5u);
  EXPECT_EQ(joined.numbers, (Numbers{{0, 1, 2}, {3, 4, 2}}));
}

TEST(PointJoining, PiecesMayBeEmpty) {
  EXPECT_EQ(join({}).count, 0u);
  EXPECT_TRUE(join({}).numbers.empty());
  EXPECT_EQ(join({{}, {}}).numbers, (Numbers{{}, {}}));
  const JoinedPoints joined = join({{}, {{at(1)}, {1}}, {}, {{at(1), at(2)}, {1, 0}}, {}});
  EXPECT_EQ(joined.count, 2u);
  EXPECT_EQ(joined.numbers, (Numbers{{}, {0}, {}, {0, 1}, {}}));
}

// More points than the table has slots at first.
TEST(PointJoining, ManyPointsAgreeWithASearch) {
  Random random(4);
  std::vector<Piece> pieces(5);
  for (Piece& piece : pieces)
    for (double x = 0; x < 3000; ++x) {
      if (random.below(3) == 0) continue;
      piece.points.push_back(at(x));
      piece.shared.push_back(static_cast<std::uint8_t>(random.below(2)));
    }
  const JoinedPoints joined = join(pieces);
  std::vector<Index> known(3000, no_index);
  Index count = 0;
  for (std::size_t b = 0; b < pieces.size(); ++b)
    for (std::size_t p = 0; p < pieces[b].points.size(); ++p) {
      Index& number = known[static_cast<std::size_t>(pieces[b].points[p].x())];
      const bool is_new = !pieces[b].shared[p] || number == no_index;
      ASSERT_EQ(joined.numbers[b][p], is_new ? count : number);
      if (pieces[b].shared[p]) number = joined.numbers[b][p];
      count += is_new;
    }
  EXPECT_EQ(joined.count, count);
}

}  // namespace
}  // namespace tetwright::point_joining_test
