// SPDX-License-Identifier: Apache-2.0
#include "simplify/mesh/neighbourhood.h"

#include <gtest/gtest.h>

#include "tests/simplify/meshes.h"

namespace tetwright::neighbourhood_test {
namespace {

TEST(Neighbourhood, FindsWhatAScanFinds) {
  const EditableMesh mesh(grid_mesh(4), "mesh");
  Neighbourhood near;
  for (const std::vector<Index>& points :
       {std::vector<Index>{7}, std::vector<Index>{60, 3, 61, 3}, std::vector<Index>{}}) {
    std::vector<Index> tets, around;
    std::vector<bool> seen(mesh.point_slots(), false);
    for (Index t = 0; t < mesh.tet_slots(); ++t) {
      const Tet& p = mesh.points(t);
      if (mesh.dead(t) || std::none_of(p.begin(), p.end(), [&](Index q) {
            return std::find(points.begin(), points.end(), q) != points.end();
          }))
        continue;
      tets.push_back(t);
      for (Index q : p) seen[q] = true;
    }
    for (Index q = 0; q < seen.size(); ++q)
      if (seen[q]) around.push_back(q);
    EXPECT_EQ(near.tets_at(mesh, points), tets);
    EXPECT_EQ(near.points_of(mesh, tets), around);
    std::erase_if(tets, [](Index t) { return t % 2 == 0; });
    EXPECT_EQ(near.tets_at(mesh, points, [](Index t) { return t % 2 != 0; }), tets);
  }
}

TEST(Neighbourhood, MakesAListDistinct) {
  Neighbourhood near;
  std::vector<Index> list{5, 3, 5, 1, 3, 3};
  near.make_distinct(list);
  EXPECT_EQ(list, (std::vector<Index>{1, 3, 5}));
  near.make_distinct(list);
  EXPECT_EQ(list, (std::vector<Index>{1, 3, 5}));
}

}  // namespace
}  // namespace tetwright::neighbourhood_test
