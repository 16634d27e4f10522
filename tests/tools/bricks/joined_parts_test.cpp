// SPDX-License-Identifier: Apache-2.0
#include "tools/bricks/joined_parts.h"

#include <gtest/gtest.h>

#include "tests/tools/bricks/cut_meshes.h"

namespace tetwright::joined_parts_test {
namespace {

using namespace cut_meshes;

/// The bricks that meet, from boundaries alone and from the joined mesh.
std::vector<std::size_t> meeting(const std::vector<BrickPart>& parts) {
  std::vector<PartBoundary> boundaries;
  for (const BrickPart& part : parts) boundaries.push_back(boundary_of(part));
  const std::vector<std::size_t> found = meeting_parts(boundaries);
  EXPECT_EQ(found, meeting_parts(join_parts(parts), parts.size()));
  return found;
}

/// Two slabs with a thin gap between them, cut along the plane through their middle.
std::vector<BrickPart> slabs() {
  TetMesh mesh = grid_mesh({4, 4, 5}, [](int, int, int z) -> Tag { return z == 2 ? Tag() : Tag(1 + z / 2); });
  for (Vec3& p : mesh.points)
    if (p.z() > 2) p.z() -= 0.9;
  mesh.interfaces = find_interfaces(mesh);
  return cut(mesh, 4, [](std::size_t, const Vec3& p) {
    return static_cast<std::size_t>(p.x() > 2) + 2 * static_cast<std::size_t>(p.z() > 2.05);
  });
}

TEST(MeetingParts, AreNoneWhereNothingMoved) {
  EXPECT_TRUE(meeting(cut(whole_mesh(), 2, [](std::size_t, const Vec3& p) {
                return static_cast<std::size_t>(p.x() > 3);
              })).empty());
  EXPECT_TRUE(meeting(slabs()).empty());
}

TEST(MeetingParts, AreThoseWhoseBoundariesCross) {
  std::vector<BrickPart> parts = slabs();
  // A point of the lower slab, not on the cut, moves through the gap.
  std::size_t moved = 0;
  for (std::size_t p = 0; p < parts[1].mesh.points.size(); ++p) {
    Vec3& at = parts[1].mesh.points[p];
    if (at == Vec3(3, 2, 2)) {
      at.z() += 0.3;
      ++moved;
    }
  }
  ASSERT_EQ(moved, 1u);
  EXPECT_EQ(meeting(parts), (std::vector<std::size_t>{1, 3}));
}

}  // namespace
}  // namespace tetwright::joined_parts_test
