// SPDX-License-Identifier: Apache-2.0
#include "common/mesh/boundary_groups.h"

#include <gtest/gtest.h>

namespace tetwright {
namespace {

TEST(BoundaryGroups, PairsGetTheNumbersThatTheUsersLeave) {
  TetMesh mesh;
  const MaterialPair outer{2, std::nullopt}, inner{2, 7};
  mesh.interfaces = {{{0, 1, 2}, 2, 7, 0},
                     {{0, 1, 3}, 2, std::nullopt, 0},
                     {{0, 1, 4}, 2, std::nullopt, 1},
                     {{0, 1, 5}, 2, std::nullopt, 2},
                     {{0, 1, 6}, 2, 7, 2},
                     {{0, 1, 7}, 2, 7, 3}};
  mesh.patch_groups = {{{outer, 1}, {2, "inlet"}},
                       {{outer, 2}, {0, "wall"}},
                       {{inner, 2}, {0, "wall"}},
                       {{inner, 3}, {-5, ""}},
                       {{inner, 9}, {1, "of no face"}}};
  const BoundaryGroups groups(mesh);
  std::vector<std::int64_t> numbers;
  for (const BoundaryGroups::Group& g : groups.all()) numbers.push_back(g.number);
  // outer, inner, then -5, "wall" and "inlet", in this order.
  EXPECT_EQ(numbers, (std::vector<std::int64_t>{1, 3, 4, 5, 2}));
  EXPECT_EQ(groups.all()[0].pair, outer);
  EXPECT_EQ(groups.all()[4].surface_region.name, "inlet");
  std::vector<std::int64_t> of_faces;
  for (const InterfaceTriangle& t : mesh.interfaces) of_faces.push_back(groups.number_of(t));
  EXPECT_EQ(of_faces, (std::vector<std::int64_t>{3, 1, 2, 5, 5, 4}));
}

}  // namespace
}  // namespace tetwright
