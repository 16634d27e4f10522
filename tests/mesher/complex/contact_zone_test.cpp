// SPDX-License-Identifier: Apache-2.0
#include "mesher/complex/contact_zone.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/common/features/parts.h"
#include "tests/mesher/test_surfaces.h"
#include "tetwright/mesher_input.h"

namespace tetwright {
namespace {

/// Two boxes that share a face in the plane x = y.
MesherInput boxes_at_diagonal() {
  const auto turned = [](const Vec3& low, const Vec3& high) {
    TriangleMesh box = make_box(low, high);
    for (Vec3& p : box.points)
      p = Vec3((p.x() - p.y()) * std::sqrt(0.5), (p.x() + p.y()) * std::sqrt(0.5), p.z());
    return box;
  };
  return make_mesher_input({{"left", 1, turned({3, -2, 2}, {8, 0, 8}), "left.off"},
                            {"right", 2, turned({3, 0, 2}, {8, 2, 8}), "right.off"}});
}

GridFrame frame() {
  GridFrame voxels;
  voxels.cells = voxels.box = {10, 10, 10};
  return voxels;
}

TEST(ContactZone, RoundingDoesNotDecideOnAContact) {
  const MesherInput input = boxes_at_diagonal();
  const ContactZone zone(*input.complex, frame());
  for (const double off : {-1e-13, 0.0, 1e-13})
    for (const double along : {3.0, 4.0, 5.0})
      EXPECT_EQ(zone.nearest({along + off, along, 5}).region, 1) << off;
}

TEST(ContactZone, PointsBesideAContactAreOnTheirSide) {
  const MesherInput input = boxes_at_diagonal();
  const ContactZone zone(*input.complex, frame());
  EXPECT_EQ(zone.nearest({4.001, 4, 5}).region, 1);
  EXPECT_EQ(zone.nearest({4, 4.001, 5}).region, 2);
  EXPECT_NEAR(zone.nearest({4.5, 3.5, 5}).distance.value, std::sqrt(0.5), 1e-9);
}

}  // namespace
}  // namespace tetwright
