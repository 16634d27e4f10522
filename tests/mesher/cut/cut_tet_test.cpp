// SPDX-License-Identifier: Apache-2.0
#include "mesher/cut/cut_tet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <map>
#include <set>

#include "common/geometry/quality.h"

namespace tetwright::cut_tet_test {
namespace {

/// The corners of a regular tet, positive.
const std::array<Vec3, 4> corners{Vec3(1, 1, 1), Vec3(1, -1, -1), Vec3(-1, -1, 1), Vec3(-1, 1, -1)};

/// A position inside the simplex of the corners, different for each vertex, equal for all pieces.
Vec3 place(const CutCase& cut, PieceVertex v) {
  Vec3 sum = Vec3::Zero();
  double weights = 0;
  for (int k = 0; k < 4; ++k) {
    if (!(v >> k & 1)) continue;
    const double weight = 1 + 0.2 * ((k * 3 + v + static_cast<int>(cut.ranks[0])) % 4);
    sum += weight * corners[k];
    weights += weight;
  }
  return sum / weights;
}

double volume_of(const CutCase& cut, const Piece& piece) {
  std::array<Vec3, 4> x;
  for (int k = 0; k < 4; ++k) x[k] = place(cut, piece.vertices[k]);
  return tet_volume(x[0], x[1], x[2], x[3]);
}

/// All cases of four corners, each on an interface or in one of four regions.
template <class Body>
void for_each_case(Body&& body) {
  for (int code = 0; code < 625; ++code) {
    std::array<Index, 4> ranks{0, 1, 2, 3};
    do {
      CutCase cut;
      for (int k = 0, c = code; k < 4; ++k, c /= 5)
        cut.regions[k] = c % 5 == 4 ? on_interface : static_cast<RegionIndex>(c % 5);
      cut.ranks = ranks;
      if (std::count(cut.regions.begin(), cut.regions.end(), on_interface) == 4) continue;
      for (bool other : {false, true}) body(cut, other);
    } while (std::next_permutation(ranks.begin(), ranks.end()));
  }
}

TEST(CutTet, PiecesFillTheTet) {
  const double whole = tet_volume(corners[0], corners[1], corners[2], corners[3]);
  ASSERT_GT(whole, 0);
  for_each_case([&](const CutCase& cut, bool other) {
    Pieces pieces;
    const int n = cut_tet(cut, other, pieces);
    ASSERT_LE(n, max_pieces);
    double sum = 0;
    for (int p = 0; p < n; ++p) {
      const double v = volume_of(cut, pieces[p]);
      ASSERT_GT(v, 1e-4);
      sum += v;
      // A piece has no corner of another region, and its region is one of the tet's.
      for (PieceVertex vertex : pieces[p].vertices) {
        if (!std::has_single_bit(static_cast<unsigned>(vertex))) continue;
        const RegionIndex r = cut.regions[std::countr_zero(static_cast<unsigned>(vertex))];
        ASSERT_TRUE(r == on_interface || r == pieces[p].region);
      }
      ASSERT_NE(std::count(cut.regions.begin(), cut.regions.end(), pieces[p].region), 0);
    }
    ASSERT_NEAR(sum, whole, 1e-12);
  });
}

/// The triangles of pieces on the face opposite a corner, with their regions.
std::set<std::pair<std::set<int>, int>> shown_on(const Pieces& pieces, int n, int dropped) {
  std::set<std::pair<std::set<int>, int>> shown;
  for (int p = 0; p < n; ++p)
    for (int skip = 0; skip < 4; ++skip) {
      std::set<int> face;
      bool on_face = true;
      for (int k = 0; k < 4; ++k) {
        if (k == skip) continue;
        face.insert(pieces[p].vertices[k]);
        on_face &= !(pieces[p].vertices[k] >> dropped & 1);
      }
      if (on_face) shown.insert({face, pieces[p].region});
    }
  return shown;
}

// The triangles on a face depend only on the corners of that face.
TEST(CutTet, FacesAgreeWithTheNeighbours) {
  for (int dropped = 0; dropped < 4; ++dropped) {
    std::map<std::vector<int>, std::set<std::pair<std::set<int>, int>>> known;
    for_each_case([&](const CutCase& cut, bool other) {
      Pieces pieces;
      const int n = cut_tet(cut, other, pieces);
      std::vector<int> key;
      bool any_pure = false;
      for (int k = 0; k < 4; ++k) {
        if (k == dropped) continue;
        key.push_back(cut.regions[k]);
        any_pure |= cut.regions[k] != on_interface;
        for (int l = 0; l < 4; ++l)
          if (l != dropped) key.push_back(cut.ranks[k] < cut.ranks[l]);
      }
      // A face on interfaces is an interface itself, or inside the region of the fourth corner.
      if (!any_pure) return;
      const auto [it, fresh] = known.try_emplace(key, shown_on(pieces, n, dropped));
      EXPECT_EQ(it->second, shown_on(pieces, n, dropped));
    });
  }
}

}  // namespace
}  // namespace tetwright::cut_tet_test
