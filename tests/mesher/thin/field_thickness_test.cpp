// SPDX-License-Identifier: Apache-2.0
#include "mesher/thin/field_thickness.h"

#include <gtest/gtest.h>

#include "tests/mesher/fields.h"

namespace tetwright::field_thickness_test {
namespace {

TEST(ThinParts, ThickOnesAreNotNamed) {
  for (const auto& surfaces :
       {std::vector{make_sphere(1)}, std::vector{make_box({0.01, 0.02, 0.03}, {1, 1, 1})},
        std::vector{make_sphere(1), make_sphere(0.7)}}) {
    const auto field = make_field(surfaces, 0.05);
    EXPECT_TRUE(find_thin_parts(*field, field->interface_voxels()).empty());
    EXPECT_EQ(find_thin_sheets(*field, field->interface_voxels()).finer.refinement, 0);
  }
}

TEST(ThinParts, WallsAndGaps) {
  const auto plate = make_field({make_box({0.01, 0.02, 0.03}, {1, 1, 0.1})}, 0.05);
  const auto thin = find_thin_parts(*plate, plate->interface_voxels());
  ASSERT_EQ(thin.size(), 1u);
  EXPECT_EQ(thin[0].region, 1);
  EXPECT_GT(thin[0].places, 400u);
  const Vec3 first = plate->voxels().to_input(thin[0].first);
  EXPECT_NEAR(first.z(), 0.065, 0.1);
  const auto gap = make_field(
      {joined(make_box({0.01, 0.02, 0.03}, {1, 1, 0.5}), make_box({0.01, 0.02, 0.57}, {1, 1, 1}))}, 0.05);
  const auto narrow = find_thin_parts(*gap, gap->interface_voxels());
  ASSERT_EQ(narrow.size(), 1u);
  EXPECT_EQ(narrow[0].region, 0);
}

TEST(ThinParts, SheetsAreRefinedAsFarAsTheyNeed) {
  // Thickness of the shell between two spheres, voxels, and the levels needed for one and a half cells.
  const std::pair<double, int> cases[] = {{2.0, 0}, {1.2, 1}, {0.9, 1}, {0.6, 2}, {0.45, 2}};
  for (const auto& [voxels, levels] : cases) {
    const auto field =
        make_field({make_sphere(1, Vec3::Zero(), 6), make_sphere(1 - 0.08 * voxels, Vec3::Zero(), 6)}, 0.08);
    const ThinSheets sheets = find_thin_sheets(*field, field->interface_voxels());
    EXPECT_EQ(sheets.finer.refinement, levels) << voxels;
    EXPECT_TRUE(sheets.too_thin.empty()) << voxels;
    EXPECT_EQ(sheets.finer.cells.size(), static_cast<std::size_t>(levels) + 1);
  }
}

}  // namespace
}  // namespace tetwright::field_thickness_test
