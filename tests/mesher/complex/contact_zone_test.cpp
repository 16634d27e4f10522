// SPDX-License-Identifier: Apache-2.0
#include "mesher/complex/contact_zone.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace tetwright {
namespace {

/// A square in the plane x = y, with one region on either side.
LabelledComplex sheet_between(RegionIndex behind, RegionIndex front) {
  LabelledComplex complex;
  complex.points = {{2, 2, 2}, {6, 6, 2}, {6, 6, 8}, {2, 2, 8}};
  complex.faces = {{{0, 1, 2}, behind, front}, {{0, 2, 3}, behind, front}};
  return complex;
}

GridFrame frame() {
  GridFrame voxels;
  voxels.cells = voxels.box = {10, 10, 10};
  return voxels;
}

TEST(ContactZone, RoundingDoesNotDecideOnAContact) {
  for (const auto& [behind, front] : {std::pair<RegionIndex, RegionIndex>{1, 2}, {2, 1}}) {
    const ContactZone zone(sheet_between(behind, front), frame());
    for (const double off : {-1e-13, 0.0, 1e-13})
      EXPECT_EQ(zone.nearest({4 + off, 4, 5}).region, 1) << behind << " " << off;
  }
}

TEST(ContactZone, PointsBesideAContactAreOnTheirSide) {
  const ContactZone zone(sheet_between(1, 2), frame());
  const RegionIndex low = zone.nearest({4.001, 4, 5}).region, high = zone.nearest({4, 4.001, 5}).region;
  EXPECT_NE(low, high);
  EXPECT_NEAR(zone.nearest({4.5, 3.5, 5}).distance.value, std::sqrt(0.5), 1e-12);
}

}  // namespace
}  // namespace tetwright
