// SPDX-License-Identifier: Apache-2.0

// --time-limit and --memory-limit.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/tools/program.h"
#include "tetwright/files.h"

namespace tetwright::limits_test {
namespace {

class Limits : public ::testing::Test {
 protected:
  /// Statistics of a run, which must end with this status.
  nlohmann::json stats(const std::string& arguments, int status) {
    const Answer a = run(arguments + " --stats " + (f / "s.json"));
    EXPECT_EQ(a.status, status) << arguments << "\n" << a.err;
    err = a.err;
    return nlohmann::json::parse(contents(f / "s.json"));
  }
  static const nlohmann::json* shortfall(const nlohmann::json& stats, const std::string& what) {
    for (const auto& s : stats["shortfall"])
      if (s["what"] == what) return &s;
    return nullptr;
  }

  TemporaryFolder f;
  std::string err;
};

TEST_F(Limits, OutOfTimeBeforeThereIsAMesh) {
  ASSERT_EQ(run("sample knot -o " + (f / "s.ply")).status, 0);
  for (const char* command : {"mesh", "prepare --target-tets 1000"}) {
    const auto j =
        stats(std::string(command) + " " + (f / "s.ply") + " -o " + (f / "o.vtu") + " --time-limit 0.001", 5);
    EXPECT_NE(err.find("--time-limit"), std::string::npos) << err;
    EXPECT_NE(j["error"]["stage"], "");
    EXPECT_FALSE(f.has("o.vtu"));
  }
}

TEST_F(Limits, WhatThereIsAtTheEndIsAValidMesh) {
  ASSERT_EQ(run("sample knot -o " + (f / "s.ply")).status, 0);
  ASSERT_EQ(run("mesh " + (f / "s.ply") + " --resolution 32 --accept-changes -o " + (f / "d.vtu")).status, 0);
  const double whole =
      stats("simplify " + (f / "d.vtu") + " --target-tets 1000 -o " + (f / "w.vtu"), 0)["seconds"]["total"];
  const double read = stats("check " + (f / "d.vtu"), 0)["seconds"]["read"];
  // At several times; the first may be before the mesh is read.
  int ended_early = 0, simplified = 0;
  for (const double share : {0.15, 0.3, 0.5, 0.8}) {
    const double limit = read + share * (whole - read);
    const Answer a = run("simplify " + (f / "d.vtu") + " --target-tets 1000 -o " + (f / "o.vtu") +
                         " --time-limit " + std::to_string(limit) + " --stats " + (f / "s.json"));
    if (a.status == 5) continue;
    ASSERT_LE(a.status, 1) << a.err;
    const auto j = nlohmann::json::parse(contents(f / "s.json"));
    if (a.status == 1) {
      ++ended_early;
      simplified += j["result"]["tets"] < j["dense"]["tets"];
      ASSERT_TRUE(shortfall(j, "time_limit")) << a.err;
      EXPECT_NE(a.err.find("left undone"), std::string::npos) << a.err;
    }
    EXPECT_EQ(run("check " + (f / "o.vtu") + " --before " + (f / "d.vtu")).status, 0);
  }
  EXPECT_GT(ended_early, 0);
  EXPECT_GT(simplified, 0);
  // A limit that is never reached does not change a byte.
  ASSERT_EQ(
      run("simplify " + (f / "d.vtu") + " --target-tets 1000 -o " + (f / "l.vtu") + " --time-limit 1e30")
          .status,
      0);
  EXPECT_EQ(contents(f / "l.vtu"), contents(f / "w.vtu"));
}

// Time is reserved for writing, as long as reading took, without the time spent waiting for the input.
TEST_F(Limits, WaitingForTheInputIsNoReading) {
  ASSERT_EQ(run("sample knot -o " + (f / "s.ply")).status, 0);
  ASSERT_EQ(run("mesh " + (f / "s.ply") + " --resolution 32 --accept-changes -o " + (f / "d.vtu")).status, 0);
  const std::string call = " --target-tets 1000 -o " + (f / "o.vtu");
  const double whole = stats("simplify " + (f / "d.vtu") + call, 0)["seconds"]["total"];
  const double wait = 4 * whole;
  const std::string pipe = "(sleep " + std::to_string(wait) + "; cat " + (f / "d.vtu") + ") | " + program() +
                           " simplify - --input-format vtu --quiet --time-limit " +
                           std::to_string(wait + 3 * whole) + call;
  EXPECT_EQ(std::system(pipe.c_str()), 0);
}

TEST_F(Limits, AToleranceIsComparedAlsoWhenTimeEnds) {
  ASSERT_EQ(run("sample torus -o " + (f / "s.ply")).status, 0);
  ASSERT_EQ(run("mesh " + (f / "s.ply") + " --resolution 24 --accept-changes -o " + (f / "d.vtu")).status, 0);
  const std::string call = "simplify " + (f / "d.vtu") + " --tolerance 1% -o " + (f / "o.vtu");
  // Find a limit that ends the run early, however busy the machine is.
  const double most = 2 * stats(call, 0)["seconds"]["total"].get<double>();
  double low = 0, high = most;
  for (int attempt = 0; attempt < 40; ++attempt) {
    if (attempt % 10 == 0) {
      low = 0;
      high = most;
    }
    const double limit = (low + high) / 2;
    const Answer a = run(call + " --time-limit " + std::to_string(limit) + " --stats " + (f / "s.json"));
    if (a.status != 1) {
      (a.status == 5 ? low : high) = limit;
      continue;
    }
    const auto j = nlohmann::json::parse(contents(f / "s.json"));
    ASSERT_TRUE(shortfall(j, "time_limit"));
    // The tolerance is met, though there may have been no time to prove it.
    const auto& held = j["tolerance"];
    EXPECT_LE(held["from_mesh"]["lower"], held["distance"]) << a.err;
    EXPECT_LE(held["from_surface"]["lower"], held["distance"]) << a.err;
    EXPECT_EQ(held["held"], shortfall(j, "tolerance") == nullptr);
    if (!held["held"]) {
      EXPECT_NE(a.err.find("--time-limit, which ended the measurement"), std::string::npos) << a.err;
    }
    return;
  }
  FAIL() << "between " << low << " and " << high << " s";
}

TEST_F(Limits, MemoryMakesCellsLarger) {
  ASSERT_EQ(run("sample knot -o " + (f / "s.ply")).status, 0);
  const std::string call = "mesh " + (f / "s.ply") + " -o " + (f / "o.vtu");
  const auto free = stats(call, 0);
  const auto limited = stats(call + " --memory-limit 0.075", 1);
  ASSERT_TRUE(shortfall(limited, "memory_limit")) << err;
  EXPECT_LT(limited["dense"]["resolution"], free["dense"]["resolution"]);
  EXPECT_LT(limited["peak_bytes"].get<double>(), 0.1 * (1 << 30));  // by an estimate, which is within 25 %
  EXPECT_EQ(run("check " + (f / "o.vtu")).status, 0);
  // Cells that were requested are rejected.
  expect_refused(call + " --resolution 400 --memory-limit 0.075", 5, {"GB are available"});
  expect_refused("check " + (f / "o.vtu") + " --memory-limit 0.01", 5, {"checking its", "GB are available"});
  // So are volumes, whose cells are their voxels.
  ASSERT_EQ(run("sample organs -o " + (f / "v.nrrd")).status, 0);
  expect_refused("mesh " + (f / "v.nrrd") + " -o " + (f / "v.vtu") + " --voxel-size 0.2 --memory-limit 0.075",
                 5, {"GB are available"});
}

TEST_F(Limits, MemoryIsThatOfImagesToo) {
  // 270^3 voxels, all 0: 79 MB as floats.
  for (const char* file : {"a.raw", "b.raw"}) {
    write_file_atomically(f / file, "");
    std::filesystem::resize_file(f / file, 270 * 270 * 270);
  }
  ASSERT_EQ(run("sample organs -o " + (f / "v.nrrd")).status, 0);
  const std::string call = "mesh " + (f / "v.nrrd") + " -o " + (f / "v.vtu") + " --memory-limit 0.12";
  const std::string header =
      "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 270 270 270\nencoding: raw\ndata file: ";
  write_file_atomically(f / "a.nhdr", header + "a.raw\n");
  write_file_atomically(f / "b.nhdr", header + "b.raw\n");
  expect_refused(call + " --values a=" + (f / "a.nhdr") + " --values b=" + (f / "b.nhdr"), 5,
                 {"the values of " + (f / "b.nhdr"), "beside the 0.0733", "GB that images and masks take"});
  expect_refused("mesh " + (f / "a.nhdr") + " " + (f / "b.nhdr") + " --iso 1 -o " + (f / "v.vtu") +
                     " --memory-limit 0.12",
                 5, {"the values of " + (f / "b.nhdr"), "beside the 0.0733"});
}

TEST_F(Limits, AreNumbersAboveZero) {
  expect_refused("mesh a.ply -o b.vtu --time-limit 0", 2, {"--time-limit", "above 0"});
  expect_refused("mesh a.ply -o b.vtu --memory-limit much", 2, {"--memory-limit", "'much'"});
}

}  // namespace
}  // namespace tetwright::limits_test
