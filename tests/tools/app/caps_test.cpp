// SPDX-License-Identifier: Apache-2.0

// Tests caps of holes, from file to file.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/tools/program.h"

namespace tetwright::caps_test {
namespace {

/// Writes a duct of 1 x 1 x 3 without its ends.
void write_duct(const std::string& file) {
  std::ofstream out(file);
  for (const int z : {0, 3})
    for (const char* p : {"0 0", "1 0", "1 1", "0 1"}) out << "v " << p << ' ' << z << '\n';
  out << "f 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
}

TEST(Caps, ArePatchesWithFigures) {
  const TemporaryFolder f;
  write_duct(f / "duct.obj");
  const Answer a = run("prepare " + (f / "duct.obj") + " -o " + (f / "a.msh") +
                       " --target-tets 600 --cap inlet@0.5,0.5,0.05 --stats " + (f / "s.json"));
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_NE(a.out.find("caps: 2 of 2 holes, 14.3 % of the boundary: inlet (area 1, flat), cap_2"),
            std::string::npos)
      << a.out;
  const nlohmann::json caps = nlohmann::json::parse(contents(f / "s.json")).at("caps");
  EXPECT_EQ(caps.at("holes"), 2);
  EXPECT_EQ(caps.at("flat"), 2);
  EXPECT_NEAR(caps.at("share"), 1. / 7, 1e-6);
  const nlohmann::json& inlet = caps.at("patches").at(0);
  EXPECT_EQ(inlet.at("name"), "inlet");
  EXPECT_NEAR(inlet.at("area"), 1, 1e-6);
  EXPECT_NEAR(inlet.at("normal").at(2), -1, 1e-9);
  EXPECT_NEAR(inlet.at("centre").at(2), 0, 1e-9);
  EXPECT_EQ(inlet.at("flat"), true);
  EXPECT_EQ(inlet.at("crease"), true);

  // The names are in the file, and the next command keeps them.
  const Answer next = run("improve " + (f / "a.msh") + " -o " + (f / "b.msh"));
  EXPECT_EQ(next.status, 0) << next.err;
  EXPECT_NE(next.out.find("named patches: "), std::string::npos) << next.out;
  EXPECT_NE(next.out.find("inlet ("), std::string::npos) << next.out;
}

TEST(Caps, NamesThatCannotBeGivenAreRefused) {
  const TemporaryFolder f;
  write_duct(f / "duct.obj");
  const std::string call =
      "prepare " + (f / "duct.obj") + " -o " + (f / "a.msh") + " --target-tets 600 --cap ";
  const auto refusal = [&](const std::string& caps) {
    const Answer a = run(call + caps);
    EXPECT_EQ(a.status, 2) << a.err;
    return a.err;
  };
  EXPECT_NE(refusal("a@0.5,0.5,1.5").find("is 1.5 from the nearest cap, at (0.5, 0.5, "), std::string::npos);
  EXPECT_NE(refusal("a@0.5,0.5,0 --cap b@0.4,0.5,0").find("is the same as 'a'"), std::string::npos);
  EXPECT_NE(refusal("a").find("'a' is not NAME@X,Y,Z"), std::string::npos);
}

}  // namespace
}  // namespace tetwright::caps_test
