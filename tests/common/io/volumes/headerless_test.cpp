// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/headerless.h"

#include "tests/common/io/file_test.h"
#include "tests/common/io/image_values.h"
#include "tests/common/io/volume_bytes.h"

namespace tetwright::headerless_test {
namespace {

constexpr VoxelIndex size{5, 4, 3};

using HeaderlessFiles = FileTest;

VolumeFileOptions options_of(const std::string& type) { return {.dimensions = size, .voxel_type = type}; }

TEST_F(HeaderlessFiles, AreReadAsTheOptionsSay) {
  const auto expect = [&](const std::string& type, const std::string& bytes) {
    put(path("a.raw"), bytes);
    expect_image(read_image(path("a.raw"), options_of(type)), size, 1);
    expect_image(read_image_bytes(bytes, "f", ".raw", options_of(type)), size, 1);
  };
  expect("float32", bytes_of(image_numbers<float>(size, 1, 3)));
  expect("float32le", bytes_of(image_numbers<float>(size, 1, 3)));
  expect("float64be", bytes_of(image_numbers<double>(size, 1, 3), true));
  const VolumeFileOptions counted{.dimensions = VoxelIndex{2, 3, 4}, .voxel_type = "uint16be"};
  put(path("b.raw"), counted_voxels<std::uint16_t>(true));
  const auto source = open_label_source(path("b.raw"), {.file = counted});
  EXPECT_FALSE(source->in_memory());
  EXPECT_TRUE(source->grid().spacing_assumed);
  EXPECT_EQ(read_all(*source, "f").labels, counted_labels());
  EXPECT_EQ(read_label_volume(path("b.raw"), counted).labels, counted_labels());
  EXPECT_EQ(read_label_layers(path("b.raw"), counted).front().labels, counted_labels());
  EXPECT_EQ(label_layers(path("b.raw")), 1);
  EXPECT_EQ(file_kind("x/a.RAW"), FileKind::volume);
}

TEST_F(HeaderlessFiles, OfAnotherSizeAndWithoutOptionsAreRefused) {
  put(path("a.raw"), counted_voxels<std::uint16_t>());
  const VolumeFileOptions wrong{.dimensions = VoxelIndex{2, 3, 4}, .voxel_type = "float32"};
  EXPECT_EQ(
      error_of<InputError>([&] { (void)read_label_volume(path("a.raw"), wrong); }),
      path("a.raw") +
          ": its 2 x 3 x 4 voxels of 4 bytes need 96 bytes, but the file has 48; give its --dimensions and "
          "--voxel-type");
  const std::string none = error_of<UsageError>([&] { (void)read_image(path("a.raw")); });
  EXPECT_NE(none.find("give --dimensions NX,NY,NZ and --voxel-type"), std::string::npos) << none;
  EXPECT_NE(error_of<UsageError>([&] {
              check_volume_options({.voxel_type = "int24"});
            }).find("\"int24\" is not one of"),
            std::string::npos);
  (void)error_of<UsageError>([&] { check_volume_options({.dimensions = VoxelIndex{2, 0, 4}}); });
  (void)error_of<UsageError>([&] { check_volume_options({.spacing = Vec3(1, 0, 1)}); });
}

TEST_F(HeaderlessFiles, SpacingReplacesThatOfFiles) {
  const std::string nrrd =
      "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 3 4\nspace: LPS\nspace directions: (0,2,0) (3,0,0) "
      "(0,0,4)\n"
      "encoding: raw\n\n" +
      counted_voxels<std::uint8_t>();
  put(path("a.nrrd"), nrrd);
  const VolumeFileOptions options{.spacing = Vec3(0.5, 6, 4)};
  Eigen::Matrix3d expected;
  expected << 0, 6, 0, 0.5, 0, 0, 0, 0, 4;
  const auto check = [&](const LabelGrid& grid, bool replaced) {
    EXPECT_TRUE(grid.directions.isApprox(expected)) << grid.directions;
    EXPECT_EQ(grid.spacing_replaced, replaced);
    EXPECT_FALSE(grid.spacing_assumed);
  };
  check(read_label_volume(path("a.nrrd"), options), true);
  check(read_image(path("a.nrrd"), options), true);
  check(read_image_bytes(nrrd, "f", ".nrrd", options), true);
  check(read_label_layers(path("a.nrrd"), options).front(), true);
  check(open_label_source(path("a.nrrd"), {.file = options})->grid(), true);
  EXPECT_FALSE(read_label_volume(path("a.nrrd"), {.spacing = Vec3(2, 3, 4)}).spacing_replaced);  // the file's
  put(path("b.raw"), counted_voxels<std::uint8_t>());
  const LabelVolume raw = read_label_volume(
      path("b.raw"), {.dimensions = VoxelIndex{2, 3, 4}, .voxel_type = "uint8", .spacing = Vec3(1, 1, 2)});
  EXPECT_EQ(raw.directions(2, 2), 2);
  EXPECT_FALSE(raw.spacing_assumed || raw.spacing_replaced);
}

}  // namespace
}  // namespace tetwright::headerless_test
