// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/tools/program.h"
#include "tetwright/io.h"

namespace tetwright::parts_app_test {
namespace {

class PartsApp : public ::testing::Test {
 protected:
  PartsApp() { EXPECT_EQ(run("sample random-interior-small -o " + (f / "in.vtu")).status, 0); }
  /// `more` begins with the output file in the folder.
  Answer improved(const std::string& more) const {
    return run("improve " + (f / "in.vtu") + " --max-iterations 1 --seed 3 -o " + (f / more));
  }
  void expect_written(const Answer& a) const { EXPECT_TRUE(a.status == 0 || a.status == 1) << a.err; }

  TemporaryFolder f;
};

TEST_F(PartsApp, WritesPiecesThatCheckAndSimplifyReadAgain) {
  expect_written(improved("whole.vtu"));
  const Answer a = improved("m.pvtu --parts 4 --stats " + (f / "s.json"));
  expect_written(a);
  EXPECT_NE(a.out.find("4 parts of "), std::string::npos) << a.out;
  for (const char* file : {"m.pvtu", "m_0.vtu", "m_1.vtu", "m_2.vtu", "m_3.vtu"}) EXPECT_TRUE(f.has(file));
  const auto stats = nlohmann::json::parse(contents(f / "s.json"));
  const auto& parts = stats.at("parts");
  std::size_t tets = 0;
  for (const auto& part : parts.at("each")) {
    tets += part.at("tets").get<std::size_t>();
    EXPECT_GT(part.at("ghosts").get<std::size_t>(), 0u);
    EXPECT_GT(part.at("neighbours").get<std::size_t>(), 0u);
    EXPECT_GE(part.at("pieces").get<std::size_t>(), 1u);
  }
  EXPECT_EQ(tets, stats.at("result").at("tets").get<std::size_t>());
  EXPECT_LE(parts.at("imbalance").get<double>(), 0.05);
  EXPECT_GT(parts.at("cut_faces").get<std::size_t>(), 0u);

  EXPECT_EQ(run("check " + (f / "m.pvtu")).status, run("check " + (f / "whole.vtu")).status);
  const std::string out = " --max-iterations 1 -o ";
  expect_written(run("improve " + (f / "whole.vtu") + out + (f / "a.vtu")));
  expect_written(run("improve " + (f / "m.pvtu") + out + (f / "b.vtu")));
  EXPECT_EQ(contents(f / "a.vtu"), contents(f / "b.vtu"));
}

TEST_F(PartsApp, ThreadsDoNotChangeTheFiles) {
  std::string first;
  for (const char* threads : {"1", "2"}) {
    expect_written(improved("m.pvtu --parts 3 --threads " + std::string(threads)));
    const std::string bytes =
        contents(f / "m.pvtu") + contents(f / "m_0.vtu") + contents(f / "m_1.vtu") + contents(f / "m_2.vtu");
    if (first.empty()) first = bytes;
    EXPECT_TRUE(bytes == first);
  }
}

TEST_F(PartsApp, EveryFormatThatHoldsPartsIsWritten) {
  for (const TetFormatInfo& format : written_tet_formats()) {
    if (!format.parts) continue;
    for (const char* order : {"1", "2"}) {
      const TemporaryFolder g;
      const Answer a = run("improve " + (f / "in.vtu") + " --max-iterations 1 --parts 3 --order " + order +
                           " --output-format " + format.name + " -o " + (g / ("m" + format.extension)));
      expect_written(a);
      EXPECT_EQ(g.entries(), files_of_tet_mesh("m" + format.extension, format.name, 3).size());
    }
  }
}

TEST_F(PartsApp, WrongCallsAreRefused) {
  const std::string call = "improve " + (f / "in.vtu") + " --max-iterations 1 -o ";
  expect_refused(call + (f / "m.mesh") + " --parts 2", 2, {"--parts", ".pvtu .vtkhdf .msh .xdmf"});
  expect_refused(call + (f / "m.msh") + " --output-format msh22 --parts 2", 2, {"--parts", "msh22"});
  expect_refused(call + (f / "m.pvtu") + " --parts 0", 2, {"--parts"});
  expect_refused(call + "- --output-format msh41 --parts 1", 2, {"standard output"});
  expect_refused(call + "- --output-format pvtu", 2, {"standard output"});
  expect_refused(call + (f / "m.pvtu") + " --parts 2 --log-file " + (f / "m_1.vtu"), 2, {"--log-file", "-o"});
  EXPECT_EQ(run("sample tet_cube -o " + (f / "small.vtu")).status, 0);
  expect_refused("improve " + (f / "small.vtu") + " --parts 10000 -o " + (f / "m.pvtu"), 2,
                 {"--parts 10000", "tets"});
  expect_refused("simplify " + (f / "in.vtu") + " --target-tets 20 --parts 21 -o " + (f / "m.pvtu"), 2,
                 {"--parts 21", "--target-tets"});
  EXPECT_FALSE(f.has("m.pvtu"));
  EXPECT_FALSE(f.has("m_0.vtu"));
}

TEST_F(PartsApp, AnInconsistentSetIsRefusedWithThePiece) {
  expect_written(improved("m.pvtu --parts 3"));
  std::filesystem::copy_file(f / "m_0.vtu", f / "m_2.vtu", std::filesystem::copy_options::overwrite_existing);
  expect_refused("check " + (f / "m.pvtu"), 3, {"piece 2"});
  std::filesystem::remove(f / "m_1.vtu");
  expect_refused("check " + (f / "m.pvtu"), 3, {"piece 1", "m_1.vtu"});
}

}  // namespace
}  // namespace tetwright::parts_app_test
