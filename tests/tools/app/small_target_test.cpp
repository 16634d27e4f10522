// SPDX-License-Identifier: Apache-2.0

// A count too small for the body is said before meshing.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "tests/tools/program.h"

namespace tetwright::said_small_target_test {
namespace {

/// A plate of 30 x 30 x 1.
void write_plate(const std::string& file) {
  std::ofstream out(file);
  for (const char* p : {"0 0 0", "30 0 0", "30 30 0", "0 30 0", "0 0 1", "30 0 1", "30 30 1", "0 30 1"})
    out << "v " << p << "\n";
  out << "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
}

std::multiset<std::string> codes(const nlohmann::json& stats) {
  std::multiset<std::string> found;
  for (const auto& d : stats.at("diagnostics")) found.insert(d.at("code").get<std::string>());
  return found;
}

TEST(SaidSmallTarget, IsSaidBeforeMeshingWithTheCountThatHolds) {
  const TemporaryFolder folder;
  write_plate(folder / "plate.obj");
  // Stages are logged as they begin.
  (void)run("prepare " + (folder / "plate.obj") + " -o " + (folder / "p.vtu") +
            " --target-tets 60 --resolution 40 --max-refinement 0 --threads 1 --stats " +
            (folder / "s.json") + " --log-file " + (folder / "log"));
  const std::string log = contents(folder / "log");
  const std::size_t said = log.find("--target-tets 60 is too small for good shapes: the ");
  ASSERT_NE(said, std::string::npos) << log;
  EXPECT_LT(said, log.find("stage: signed distances")) << log;
  const auto stats = nlohmann::json::parse(contents(folder / "s.json"));
  ASSERT_EQ(stats["min_tets"].size(), 1u);
  const double needed = stats["min_tets"][0]["tets"];
  EXPECT_GT(needed, 350);
  EXPECT_LT(needed, 800);
  // The rule that keeps walls from becoming flat names a better number in the end.
  EXPECT_EQ(codes(stats).count("target-too-small"), 0u);
  EXPECT_EQ(codes(stats).count("target-missed"), 1u);
}

TEST(SaidSmallTarget, SufficientCountsAndOtherRequestsSayNothing) {
  const TemporaryFolder folder;
  write_plate(folder / "plate.obj");
  const auto said = [&](const std::string& options) {
    const Answer a = run("prepare " + (folder / "plate.obj") + " -o " + (folder / "p.vtu") +
                         " --resolution 40 --max-refinement 0 --threads 1 " + options);
    EXPECT_LE(a.status, 1) << a.err;
    return a.err.find("too small for good shapes") != std::string::npos;
  };
  EXPECT_TRUE(said("--target-tets 60"));
  EXPECT_FALSE(said("--target-tets 800"));
  EXPECT_FALSE(said("--target-tets 60 --min-thickness 0.1"));
}

TEST(SaidSmallTarget, ThinLabelIsNamed) {
  const TemporaryFolder folder;
  std::ofstream(folder / "names.txt") << "1 core\n2 skin\n";
  {
    std::ofstream out(folder / "v.nrrd", std::ios::binary);
    out << "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 24 24 24\nencoding: raw\n\n";
    for (int z = 0; z < 24; ++z)
      for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 24; ++x) {
          const double r2 = (x - 11.5) * (x - 11.5) + (y - 11.5) * (y - 11.5) + (z - 11.5) * (z - 11.5);
          out.put(static_cast<char>(r2 < 81 ? 1 : r2 < 121 ? 2 : 0));
        }
  }
  const Answer a =
      run("prepare " + (folder / "v.nrrd") + " -o " + (folder / "v.vtu") + " --label-names " +
          (folder / "names.txt") + " --target-tets 150 --threads 1 --stats " + (folder / "s.json"));
  EXPECT_NE(a.err.find("--target-tets 150 is too small for good shapes: the "), std::string::npos) << a.err;
  EXPECT_NE(a.err.find("'skin' "), std::string::npos) << a.err;
  EXPECT_LT(a.err.find("too small for good shapes"), a.err.find("note: ")) << a.err;
  // The shapes are poor, so that the note stays.
  EXPECT_EQ(codes(nlohmann::json::parse(contents(folder / "s.json"))).count("target-too-small"), 1u) << a.err;
}

}  // namespace
}  // namespace tetwright::said_small_target_test
