// SPDX-License-Identifier: Apache-2.0

// Tests --base and --thicken, from file to file.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/tools/program.h"

namespace tetwright::open_surfaces_app_test {
namespace {

/// Writes hills of 3 km x 3 km in map coordinates.
void write_terrain(const std::string& file) {
  constexpr int n = 20;
  std::ofstream out(file);
  out.precision(12);
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i)
      out << "v " << 5e5 + 150 * i << ' ' << 4.6e6 + 150 * j << ' '
          << 800 + 300 * std::sin(0.2 * i) * std::cos(0.15 * j) << '\n';
  for (int j = 0; j < n; ++j)
    for (int i = 1; i <= n; ++i) {
      const int a = j * (n + 1) + i;
      out << "f " << a << ' ' << a + 1 << ' ' << a + n + 2 << "\nf " << a << ' ' << a + n + 2 << ' '
          << a + n + 1 << '\n';
    }
}

TEST(OpenSurfaces, ATerrainBecomesABlock) {
  const TemporaryFolder f;
  write_terrain(f / "terrain.obj");
  const Answer refused =
      run("prepare " + (f / "terrain.obj") + " -o " + (f / "a.msh") + " --target-tets 1500");
  EXPECT_EQ(refused.status, 3);
  EXPECT_NE(refused.err.find("encloses nothing"), std::string::npos) << refused.err;

  const Answer a = run("prepare " + (f / "terrain.obj") + " -o " + (f / "a.msh") +
                       " --target-tets 1500 --base 100 --strict --stats " + (f / "s.json"));
  EXPECT_EQ(a.status, 0) << a.err;
  for (const char* name : {"top (", "side (", "base ("})
    EXPECT_NE(a.out.find(name), std::string::npos) << a.out;
  const nlohmann::json stats = nlohmann::json::parse(contents(f / "s.json"));
  EXPECT_NE(stats.dump().find("base-added"), std::string::npos);
  EXPECT_EQ(run("check " + (f / "a.msh")).status, 0);
}

TEST(OpenSurfaces, AMembraneBecomesAPlate) {
  const TemporaryFolder f;
  std::ofstream(f / "m.off") << "OFF\n4 2 0\n0 0 0\n2 0 0\n2 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n";
  const Answer a = run("prepare " + (f / "m.off") + " -o " + (f / "a.msh") +
                       " --target-tets 800 --thicken 0.2 --strict --stats " + (f / "s.json"));
  EXPECT_EQ(a.status, 0) << a.err;
  const nlohmann::json stats = nlohmann::json::parse(contents(f / "s.json"));
  EXPECT_NEAR(stats.at("result").at("volume").get<double>(), 0.4, 1e-8);
  for (const char* name : {"front (", "back (", "rim ("})
    EXPECT_NE(a.out.find(name), std::string::npos) << a.out;
}

TEST(OpenSurfaces, OptionsAreChecked) {
  const TemporaryFolder f;
  write_terrain(f / "terrain.obj");
  const auto status = [&](const std::string& options) {
    return run("prepare " + (f / "terrain.obj") + " -o " + (f / "a.msh") + " --target-tets 1500 " + options)
        .status;
  };
  EXPECT_EQ(status("--base below"), 2);
  EXPECT_EQ(status("--base nan"), 2);
  EXPECT_EQ(status("--base 900"), 2);
  EXPECT_EQ(status("--thicken 0"), 2);
  EXPECT_EQ(status("--base auto --thicken 1%"), 2);
}

}  // namespace
}  // namespace tetwright::open_surfaces_app_test
