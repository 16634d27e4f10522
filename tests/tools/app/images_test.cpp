// SPDX-License-Identifier: Apache-2.0

// Tests images as inputs through the program: thresholds, probability maps, and what is refused.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "tests/tools/program.h"
#include "tetwright/io.h"

namespace tetwright::images_test {
namespace {

class Images : public testing::Test {
 protected:
  std::string path(const std::string& file) const { return folder_ / file; }
  /// Writes a raw volume of float, whose header is FILE.nhdr, with voxels of half a unit.
  std::string image(const std::string& file, const std::function<double(const Vec3&)>& value,
                    const std::string& type = "float") const {
    std::string bytes;
    for (int z = 0; z < side; ++z)
      for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
          const auto v = static_cast<float>(value(Vec3(x, y, z)));
          bytes.append(reinterpret_cast<const char*>(&v), sizeof v);
        }
    const std::string n = std::to_string(side);
    write_file_atomically(path(file + ".raw"), bytes);
    write_file_atomically(
        path(file + ".nhdr"),
        "NRRD0004\ntype: " + type + "\ndimension: 3\nspace: LPS\nsizes: " + n + " " + n + " " + n +
            "\nspace directions: (0.5,0,0) (0,0.5,0) (0,0,0.5)\nencoding: raw\nendian: little\n"
            "data file: " +
            file + ".raw\n");
    return path(file + ".nhdr");
  }
  /// Distance inside a ball in the middle.
  static std::function<double(const Vec3&)> ball(double radius, double x = 9.5) {
    return [=](const Vec3& p) { return radius - (p - Vec3(x, 9.5, 9.5)).norm(); };
  }
  Answer prepare(const std::string& words) const {
    return run("prepare " + words + " --target-tets 1500 -o " + path("out.vtu") + " --stats " +
               path("s.json"));
  }
  nlohmann::json stats() const { return nlohmann::json::parse(contents(path("s.json"))); }
  double volume(const std::string& name) const {
    const nlohmann::json all = stats();
    for (const nlohmann::json& m : all.at("result").at("materials"))
      if (m.at("name") == name) return m.at("volume");
    ADD_FAILURE() << "there is no material " << name;
    return 0;
  }
  static double ball_volume(double radius) { return 4.0 / 3 * 3.14159265 * radius * radius * radius / 8; }

  static constexpr int side = 20;
  TemporaryFolder folder_;
};

TEST_F(Images, AThresholdMakesABody) {
  const std::string file = image("tooth", ball(7));
  const Answer a = prepare(file + " --iso 0");
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_NEAR(volume("tooth"), ball_volume(7), 0.02 * ball_volume(7));
  const nlohmann::json isos = stats().at("input").at("volume").at("isos");
  ASSERT_EQ(isos.size(), 1u);
  EXPECT_EQ(isos[0].at("name"), "tooth");
  EXPECT_EQ(isos[0].at("automatic"), false);
  EXPECT_NE(a.out.find("'tooth' from 0 on"), std::string::npos) << a.out;
  EXPECT_EQ(prepare(file + " --iso crown=0").status, 0);
  EXPECT_NEAR(volume("crown"), ball_volume(7), 0.02 * ball_volume(7));
}

TEST_F(Images, SeveralThresholdsNestMaterials) {
  const Answer a = prepare(image("ct", ball(8)) + " --iso core=4 --iso shell=0");
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_NEAR(volume("core"), ball_volume(4), 0.05 * ball_volume(4));
  EXPECT_NEAR(volume("shell"), ball_volume(8) - ball_volume(4), 0.03 * ball_volume(8));
}

TEST_F(Images, OtsusThresholdIsPrinted) {
  const auto inside = ball(7);
  const Answer a = prepare(image("ct", [&](const Vec3& p) { return 100 / (1 + std::exp(-3 * inside(p))); }) +
                           " --iso auto");
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_NE(a.out.find("(Otsu's threshold)"), std::string::npos) << a.out;
  EXPECT_NEAR(volume("ct"), ball_volume(7), 0.08 * ball_volume(7));
}

TEST_F(Images, ProbabilityMapsAreMaterials) {
  const auto map = [](double x) {
    return [=](const Vec3& p) { return 0.9 / (1 + std::exp((p - Vec3(x, 9.5, 9.5)).norm() - 5)); };
  };
  const std::string both = image("left", map(6)) + " " + image("right", map(13));
  const Answer a = prepare(both);
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_NEAR(volume("left"), volume("right"), 0.03 * volume("right"));
  const double half = volume("left");
  EXPECT_EQ(prepare(both + " --outside-probability 0.2").status, 0);
  EXPECT_GT(volume("left"), 1.1 * half);
  for (const char* p : {"-0.1", "1.5", "nan"}) {
    const Answer none = prepare(both + " --outside-probability=" + p);
    EXPECT_EQ(none.status, 2);
    EXPECT_NE(none.err.find(p), std::string::npos) << none.err;
  }
  // Distances are no probabilities.
  const std::string distances = image("a", ball(4, 5)) + " " + image("b", ball(4, 14));
  const Answer refused = prepare(distances);
  EXPECT_EQ(refused.status, 3);
  EXPECT_NE(refused.err.find("probabilities are from 0 to 1"), std::string::npos) << refused.err;
  EXPECT_EQ(prepare(distances + " --iso 0").status, 0);
  EXPECT_NEAR(volume("a"), ball_volume(4), 0.06 * ball_volume(4));
  EXPECT_EQ(prepare(distances + " --iso a=0 --iso b=0").status, 2);
  const Answer same =
      prepare("--material a=" + path("a.nhdr") + " --material a=" + path("b.nhdr") + " --iso 0");
  EXPECT_EQ(same.status, 2);
  EXPECT_NE(same.err.find("b.nhdr are two images called 'a'"), std::string::npos) << same.err;
}

TEST_F(Images, SmoothingIsAsked) {
  Answer a = prepare(image("ct", ball(7)) + " --iso 0 --smooth 1.5");
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_NEAR(volume("ct"), ball_volume(7), 0.03 * ball_volume(7));
  a = prepare(path("ct.nhdr") + " --iso 0 --smooth 0");
  EXPECT_EQ(a.status, 2);
  a = prepare(path("ct.nhdr") + " --iso 0 --smooth 1000");
  EXPECT_EQ(a.status, 2);
}

TEST_F(Images, RefusalsNameTheRangeAndWhatToDo) {
  const std::string file = image("ct", ball(7));
  const Answer above = prepare(file + " --iso 50");
  EXPECT_EQ(above.status, 4);
  EXPECT_NE(above.err.find("its values are from "), std::string::npos) << above.err;
  const Answer below = prepare(file + " --iso=-50");
  EXPECT_EQ(below.status, 3);
  EXPECT_NE(below.err.find("nothing would be outside"), std::string::npos) << below.err;
  const Answer without = prepare(file);
  EXPECT_EQ(without.status, 3);
  EXPECT_NE(without.err.find("--iso"), std::string::npos) << without.err;
  const Answer nan =
      prepare(image("nan", [](const Vec3& p) { return p[0] == 3 ? std::nan("") : 1.0; }) + " --iso 1");
  EXPECT_EQ(nan.status, 3);
  EXPECT_NE(nan.err.find("voxel (3, 0, 0)"), std::string::npos) << nan.err;
  for (const std::string words :
       {" --iso 1 --iso 2", " --iso a=1 --iso a=2", " --iso x", " --iso a=1 --labels 3",
        " --iso 1 --on-overlap first", " --iso 1 --outside-probability 0.5", " --iso outside=1"})
    EXPECT_EQ(prepare(file + words).status, 2) << words;
  const Answer surface = run("prepare " + path("x.stl") + " --iso 1 -o " + path("o.vtu"));
  EXPECT_NE(surface.status, 0);
}

TEST_F(Images, GrayValuesOfWholeNumbersAreNotMeshedAsLabels) {
  ASSERT_EQ(run("sample bone -o " + path("bone.nrrd")).status, 0);
  const Answer labels = prepare(path("bone.nrrd"));
  EXPECT_EQ(labels.status, 3);
  EXPECT_NE(labels.err.find("looks like an image of gray values"), std::string::npos) << labels.err;
  const Answer bone = prepare(path("bone.nrrd") + " --iso bone=600");
  EXPECT_EQ(bone.status, 0) << bone.err;
}

TEST_F(Images, BricksGiveTheSameKindOfMesh) {
  const Answer a = prepare(image("ct", ball(8)) + " --iso 0 --bricks 32 --voxel-size 0.25");
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_NEAR(volume("ct"), ball_volume(8), 0.02 * ball_volume(8));
}

}  // namespace
}  // namespace tetwright::images_test
