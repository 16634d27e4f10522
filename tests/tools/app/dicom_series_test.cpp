// SPDX-License-Identifier: Apache-2.0

// Tests folders of DICOM slices as inputs of the program.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/common/io/volumes/dicom_series.h"
#include "tests/tools/program.h"
#include "tetwright/io.h"

namespace tetwright::dicom_series_test {
namespace {

class DicomSeriesInput : public testing::Test {
 protected:
  std::string path(const std::string& file) const { return folder_ / file; }

  /// Writes slices with a ball of -1000 + 200 r at the distance r from its surface.
  void write_ball(double radius) const {
    std::filesystem::create_directories(path("knee"));
    for (int z = 0; z < side; ++z) {
      DicomToWrite slice{.columns = side,
                         .rows = side,
                         .pixel_spacing = "0.5\\0.5",
                         .rescale_slope = "1",
                         .rescale_intercept = "-1024"};
      slice.position = Vec3(100, 0, 0.5 * z);
      std::vector<std::uint16_t> pixels;
      for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
          pixels.push_back(static_cast<std::uint16_t>(
              1324 + 100 * (radius - (Vec3(x, y, z) - Vec3(9.5, 9.5, 9.5)).norm())));
      write_file_atomically(path("knee/" + std::to_string(side - z)),
                            dicom_file(slice, dicom_pixels(pixels, slice)));
    }
  }
  Answer prepare(const std::string& words) const {
    return run("prepare " + words + " --target-tets 1500 -o " + path("out.vtu") + " --stats " +
               path("s.json"));
  }

  static constexpr int side = 20;
  TemporaryFolder folder_;
};

TEST_F(DicomSeriesInput, AThresholdMakesABody) {
  write_ball(7);
  write_file_atomically(path("knee/notes.txt"), "no slice");
  const Answer a = prepare(path("knee") + " --iso bone=300");
  EXPECT_EQ(a.status, 0) << a.err;
  const nlohmann::json stats = nlohmann::json::parse(contents(path("s.json")));
  const nlohmann::json& bone = stats.at("result").at("materials").at(0);
  EXPECT_EQ(bone.at("name"), "bone");
  const double ball = 4.0 / 3 * 3.14159265 * 7 * 7 * 7 / 8;
  EXPECT_NEAR(bone.at("volume").get<double>(), ball, 0.02 * ball);
  EXPECT_NE((a.out + a.err).find("notes.txt"), std::string::npos) << a.out << a.err;
  EXPECT_EQ(stats.at("input").at("volume").at("space"), "left-posterior-superior");
}

TEST_F(DicomSeriesInput, RefusalsNameFiles) {
  write_ball(7);
  std::filesystem::remove(path("knee/7"));
  const Answer missing = prepare(path("knee") + " --iso 300");
  EXPECT_EQ(missing.status, 3);
  EXPECT_NE(missing.err.find("the distance between 8 and 6 is 1, and between most other slices 0.5"),
            std::string::npos)
      << missing.err;
  write_file_atomically(path("knee/liver.nii.gz"), "a mask");
  const Answer mixed = prepare(path("knee") + " --iso 300");
  EXPECT_EQ(mixed.status, 2);
  EXPECT_NE(mixed.err.find("has slices (DICOM) and other volumes, such as liver.nii.gz"), std::string::npos)
      << mixed.err;
}

}  // namespace
}  // namespace tetwright::dicom_series_test
