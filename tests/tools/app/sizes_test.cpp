// SPDX-License-Identifier: Apache-2.0

// --size-field, --max-edge, --min-edge and --grading.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/tools/program.h"

namespace tetwright::sizes_test {
namespace {

/// A tet that contains the surroundings of the origin, with one size at its first vertex and another at the
/// others.
std::string tet_with_sizes(double first, double others) {
  const std::string rest = std::to_string(others);
  return "# vtk DataFile Version 3.0\nsizes\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n"
         "-9 -9 -9\n27 -9 -9\n-9 27 -9\n-9 -9 27\nCELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n"
         "POINT_DATA 4\nSCALARS size double 1\nLOOKUP_TABLE default\n" +
         std::to_string(first) + "\n" + rest + "\n" + rest + "\n" + rest + "\n";
}

class Sizes : public testing::Test {
 protected:
  Sizes() { EXPECT_EQ(run("sample sphere -o " + surface).status, 0); }
  TemporaryFolder f;
  const std::string surface = f / "s.ply", out = f / "o.vtu", field = f / "size.vtk";

  nlohmann::json prepare(const std::string& options, int status) {
    const Answer a = run("prepare " + surface + " -o " + out + " --stats " + (f / "s.json") + " " + options);
    EXPECT_EQ(a.status, status) << a.err;
    said = a.err;
    return nlohmann::json::parse(contents(f / "s.json"));
  }
  std::string said;
};

TEST_F(Sizes, DecideTheNumberOfTets) {
  put(field, tet_with_sizes(0.4, 0.4));
  const auto coarse = prepare("--size-field " + field, 0);
  EXPECT_EQ(coarse["edge_lengths"]["field"], "size");
  EXPECT_GE(coarse["edge_lengths"]["within_percent"], 95);
  EXPECT_NEAR(coarse["edge_lengths"]["median_ratio"].get<double>(), 1, 0.1);
  put(field, tet_with_sizes(0.2, 0.2));
  const auto fine = prepare("--size-field " + field, 0);
  EXPECT_GE(fine["edge_lengths"]["within_percent"], 95);
  const double ratio = fine["result"]["tets"].get<double>() / coarse["result"]["tets"].get<double>();
  EXPECT_GT(ratio, 5);
  EXPECT_LT(ratio, 12);
  // Simplifying a tet mesh reports --max-edge as well.
  const Answer a = run("simplify " + out + " -o " + (f / "t.vtu") + " --max-edge 0.5 --target-tets 500");
  EXPECT_EQ(a.status, 1) << a.err;
  EXPECT_NE(a.err.find("--max-edge"), std::string::npos) << a.err;
}

TEST_F(Sizes, WinOverACount) {
  put(field, tet_with_sizes(0.25, 0.25));
  const auto j = prepare("--size-field " + field + " --target-tets 100", 1);
  EXPECT_EQ(j["shortfall"][0]["what"], "target_tets");
  EXPECT_NE(said.find("--size-field"), std::string::npos) << said;
}

TEST_F(Sizes, BoundsHold) {
  const auto j = prepare("--max-edge 0.4 --target-tets 300", 1);  // more tets than the target
  EXPECT_EQ(j["edge_lengths"]["above_max"], 0);
  EXPECT_LE(j["edge_lengths"]["longest"], 0.4);
}

TEST_F(Sizes, EdgesAreSplitHoweverMuchTooLongTheyAre) {
  const std::string cube = f / "cube.vtu";
  ASSERT_EQ(run("sample tet_cube -o " + cube).status, 0);
  const Answer a =
      run("simplify " + cube + " -o " + out + " --target-tets 100 --max-edge 0.1 --stats " + (f / "s.json"));
  EXPECT_EQ(a.status, 1) << a.err;  // more tets than the target, and nothing else
  const auto j = nlohmann::json::parse(contents(f / "s.json"));
  EXPECT_EQ(j["edge_lengths"]["above_max"], 0) << a.err;
  EXPECT_EQ(j["shortfall"].size(), 1u) << a.err;
}

TEST_F(Sizes, BadValuesSayWhatToDo) {
  const std::string call = "prepare " + surface + " -o " + out + " ";
  put(field, tet_with_sizes(0.25, 0.25));
  expect_refused(call + "--size-field " + (f / "none.vtk"), 3, {"none.vtk"});
  expect_refused(call + "--size-field " + (f / "sizes.txt"), 2, {"sizes.txt", ".vtk"});
  expect_refused(call + "--target-tets 100 --grading 0.2", 2, {"--grading", "--size-field"});
  expect_refused(call + "--size-field " + field + " --grading 0", 2, {"--grading", "'0'"});
  expect_refused(call + "--target-tets 100 --max-edge -1", 2, {"--max-edge", "'-1'"});
  expect_refused(call + "--target-tets 100 --min-edge 0", 2, {"--min-edge", "'0'"});
  expect_refused(call + "--target-tets 100 --min-edge 0.5 --max-edge 0.4", 2, {"--max-edge", "--min-edge"});
  expect_refused(call + "--target-tets 100 --max-edge 0.4 --schedule paper", 2, {"--schedule paper"});
  put(field, tet_with_sizes(0, 0.2));
  expect_refused(call + "--size-field " + field, 3, {"size.vtk", "0"});
  put(field, tet_with_sizes(-1, 0.2));
  expect_refused(call + "--size-field " + field, 3, {"size.vtk", "-1"});
  // The field ends within the body.
  std::string half = tet_with_sizes(0.1, 0.1);
  half.replace(half.find("27 -9 -9"), 8, "0. -9 -9");
  put(field, half);
  expect_refused(call + "--size-field " + field, 3, {"size.vtk", "the sizes end within the body"});
}

}  // namespace
}  // namespace tetwright::sizes_test
