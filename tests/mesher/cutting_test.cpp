#include "mesher/cutting.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "common/quality.h"
#include "test_surfaces.h"

namespace tetwright {
namespace {

/// The corners of the regular tet, positive.
const std::array<Vec3, 4> corners{Vec3(1, 1, 1), Vec3(1, -1, -1), Vec3(-1, -1, 1), Vec3(-1, 1, -1)};

Vec3 place(const CutCase& cut, PieceVertex v) {
  if (v.from == v.to) return corners[v.from];
  // A different place on every edge, the same from both ends.
  const int a = std::min(v.from, v.to), b = std::max(v.from, v.to);
  const double share = 0.3 + 0.06 * a + 0.03 * b + 0.01 * static_cast<double>(cut.ranks[0]);
  return corners[a] + share * (corners[b] - corners[a]);
}

double case_volume(const CutCase& cut, bool other) {
  std::array<Piece, 3> pieces;
  double sum = 0;
  for (int p = 0, n = cut_inside(cut, other, pieces); p < n; ++p) {
    std::array<Vec3, 4> x;
    for (int k = 0; k < 4; ++k) x[k] = place(cut, pieces[p][k]);
    const double v = tet_volume(x[0], x[1], x[2], x[3]);
    EXPECT_GT(v, 1e-3);
    sum += v;
  }
  return sum;
}

template <class Body>
void for_each_case(Body&& body) {
  for (int code = 0; code < 81; ++code) {
    std::array<Index, 4> ranks{0, 1, 2, 3};
    do {
      CutCase cut;
      for (int k = 0, c = code; k < 4; ++k, c /= 3) cut.sides[k] = static_cast<Side>(c % 3 - 1);
      cut.ranks = ranks;
      for (bool other : {false, true}) body(cut, other);
    } while (std::next_permutation(ranks.begin(), ranks.end()));
  }
}

CutCase swapped_sides(CutCase cut) {
  for (Side& s : cut.sides) s = static_cast<Side>(-static_cast<int>(s));
  return cut;
}

TEST(Cutting, InsideAndOutsideAddUp) {
  const double whole = tet_volume(corners[0], corners[1], corners[2], corners[3]);
  ASSERT_GT(whole, 0);
  for_each_case([&](const CutCase& cut, bool other) {
    if (std::all_of(cut.sides.begin(), cut.sides.end(), [](Side s) { return s == Side::on; })) return;
    // The quadrilateral within the tet is bent: the other side must take the same diagonal. With the sides
    // swapped, corners 0, 1 and 2, 3 of the order change places and the diagonals 02-13 and 03-12 stay.
    EXPECT_NEAR(case_volume(cut, other) + case_volume(swapped_sides(cut), other), whole, 1e-12);
  });
}

// What a case shows on a face follows from that face's corners alone.
TEST(Cutting, FacesAgreeWithTheNeighbours) {
  using Vertex = std::pair<int, int>;
  using Shown = std::set<std::set<Vertex>>;
  for (int dropped = 0; dropped < 4; ++dropped) {
    std::map<std::vector<int>, Shown> known;
    for_each_case([&](const CutCase& cut, bool other) {
      std::array<Piece, 3> pieces;
      const int n = cut_inside(cut, other, pieces);
      std::map<std::set<Vertex>, int> faces;
      for (int p = 0; p < n; ++p)
        for (int skip = 0; skip < 4; ++skip) {
          std::set<Vertex> face;
          for (int k = 0; k < 4; ++k)
            if (k != skip)
              face.insert({std::min(pieces[p][k].from, pieces[p][k].to),
                           std::max(pieces[p][k].from, pieces[p][k].to)});
          EXPECT_EQ(face.size(), 3u);
          EXPECT_LE(++faces[face], 2);
        }
      Shown shown;
      for (const auto& [face, count] : faces) {
        bool on_face = true;
        for (const Vertex& v : face) on_face &= v.first != dropped && v.second != dropped;
        if (!on_face) continue;
        EXPECT_EQ(count, 1);
        shown.insert(face);
      }
      std::vector<int> key;
      bool any_inside = false;
      for (int k = 0; k < 4; ++k) {
        if (k == dropped) continue;
        key.push_back(static_cast<int>(cut.sides[k]));
        any_inside |= cut.sides[k] == Side::inside;
        for (int l = 0; l < 4; ++l)
          if (l != dropped) key.push_back(cut.ranks[k] < cut.ranks[l]);
      }
      // A face on the interface belongs to whichever tets are inside.
      if (!any_inside) return;
      const auto [it, fresh] = known.try_emplace(key, shown);
      EXPECT_EQ(it->second, shown);
    });
  }
}

TEST(Cutting, CutsAreSharedAndOffTheEnds) {
  // Two tets on one face, cut through all of its edges' far ends.
  LabelledLattice lattice;
  lattice.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.4, 0.4, -1}};
  lattice.distances = {-1, 1e-9f, 2, 0.5f, 3};
  lattice.is_centre.assign(5, 0);
  for (float d : lattice.distances) lattice.sides.push_back(d < 0 ? Side::inside : Side::outside);
  lattice.tets = {{0, 1, 2, 3}, {0, 2, 1, 4}};
  const CutMesh mesh = cut_lattice(lattice);
  EXPECT_EQ(mesh.tets.size(), 2u);
  EXPECT_EQ(mesh.points.size(), 5u);
  EXPECT_EQ(broken_promise(mesh.points, mesh.tets), "");
  for (const Vec3& p : mesh.points) {
    if (p.x() > 0 && p.y() == 0) {
      EXPECT_LT(p.x(), 0.8);
    }
  }
  double worst = 4;
  for (const Tet& t : mesh.tets)
    worst = std::min(
        worst, min_solid_angle(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]));
  EXPECT_EQ(worst, std::min(worst_inside_angle(lattice, lattice.tets[0]),
                            worst_inside_angle(lattice, lattice.tets[1])));
}

}  // namespace
}  // namespace tetwright
