// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/common/io/expect_error.h"
#include "tetwright/prepare.h"

namespace tetwright::inputs_test {
namespace {

ImageVolume image_of_values(std::vector<std::vector<float>> channels) {
  ImageVolume image;
  image.size = {2, 1, 1};
  image.channels = std::move(channels);
  return image;
}

TEST(VolumeInputs, AreLabelsOrImages) {
  double waited = 0;
  Input image("a", image_of_values({{0.5f, 2}}));
  EXPECT_EQ(image.kind(), FileKind::volume);
  EXPECT_TRUE(image.is_value());
  EXPECT_EQ(take_image(image, waited).channels, (std::vector<std::vector<float>>{{0.5f, 2}}));
  Input whole("a", image_of_values({{1, 2}}));
  EXPECT_EQ(take_label_volume(whole, waited).labels, (std::vector<MaterialTag>{1, 2}));
  LabelVolume volume;
  volume.size = {2, 1, 1};
  volume.labels = {3, -4};
  Input labels("b", volume);
  EXPECT_EQ(take_image(labels, waited).channels, (std::vector<std::vector<float>>{{3, -4}}));
  Input stream("c", InputStream{".nrrd", [] {
                                  return std::string(
                                      "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 1 1\n"
                                      "encoding: raw\n\n\3\4");
                                }});
  stream.volume_file.spacing = Vec3(1, 2, 3);
  const ImageVolume read = take_image(stream, waited);
  EXPECT_EQ(read.channels, (std::vector<std::vector<float>>{{3, 4}}));
  EXPECT_EQ(read.directions(2, 2), 3);
}

TEST(VolumeInputs, ImagesAreRefusedAsLabels) {
  double waited = 0;
  Input fraction("a", image_of_values({{1, 0.5f}})), channels("b", image_of_values({{1, 2}, {3, 4}}));
  EXPECT_EQ(
      error_of<InputError>([&] { (void)take_label_volume(fraction, waited); }),
      "a: voxel (1, 0, 0) has the value 0.5, not a whole number; a volume of labels is needed; mesh an image "
      "with --iso");
  EXPECT_EQ(error_of<InputError>([&] { (void)take_label_source(channels, waited); }),
            "b: 2 channels; a volume with one label per voxel is needed");
}

}  // namespace
}  // namespace tetwright::inputs_test
