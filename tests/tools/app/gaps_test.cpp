// SPDX-License-Identifier: Apache-2.0
// The line that reports a closed gap names the option that opens it.
#include <fstream>
#include <regex>

#include "tests/tools/program.h"

namespace tetwright::gaps_test {
namespace {

/// Writes two unit cubes this far apart.
void write_cubes(const std::string& file, double gap) {
  std::ofstream out(file);
  out << "OFF\n16 24 0\n";
  for (const double x : {0.0, 1 + gap})
    for (int k = 0; k < 8; ++k) out << x + (k & 1) << " " << (k >> 1 & 1) << " " << (k >> 2) << "\n";
  constexpr int sides[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                               {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const int first : {0, 8})
    for (const auto& s : sides) {
      out << "3 " << first + s[0] << " " << first + s[1] << " " << first + s[2] << "\n";
      out << "3 " << first + s[0] << " " << first + s[2] << " " << first + s[3] << "\n";
    }
}

/// The number that a message says opens the gaps; empty if it names none.
std::string number_in(const std::string& message, const std::string& option) {
  std::smatch found;
  return std::regex_search(message, found, std::regex(option + R"( \((\d+) opens the gaps\))"))
             ? found[1].str()
             : "";
}

TEST(ClosedGaps, TheNamedRefinementOpensThem) {
  const TemporaryFolder folder;
  write_cubes(folder / "cubes.off", 0.01);
  const std::string call =
      "mesh " + (folder / "cubes.off") + " --resolution 40 -o " + (folder / "m.vtu") + " --max-refinement ";
  const Answer closed = run(call + "1");
  EXPECT_EQ(closed.status, 1);
  const std::string number = number_in(closed.err, "--max-refinement");
  ASSERT_EQ(number, "3") << closed.err;  // cells of 2.01 / 40 / 8 = 0.0063
  EXPECT_EQ(run(call + "2").status, 1);
  const Answer open = run(call + number);
  EXPECT_EQ(open.status, 0) << open.err;
}

TEST(ClosedGaps, ATargetIsNamedIfItsCellsAreWithinTheBudget) {
  const TemporaryFolder folder;
  write_cubes(folder / "near.off", 0.005);
  write_cubes(folder / "nearer.off", 1e-5);
  const auto named = [&](const std::string& file) {
    const Answer a = run("prepare " + (folder / file) + " --target-tets 500 -o " + (folder / "m.vtu"));
    EXPECT_EQ(a.status, 1);
    return number_in(a.err, "--target-tets");
  };
  // Two sides of area 1 with cells of at most 0.004 take 3.8 million tets at least; 400 may be added for each
  // wanted one. With 13,000 the gap was seen to open.
  const std::string number = named("near.off");
  ASSERT_FALSE(number.empty());
  EXPECT_GE(std::stoi(number), 9400);
  EXPECT_LE(std::stoi(number), 20000);
  EXPECT_EQ(named("nearer.off"), "");  // no cells that fit
}

}  // namespace
}  // namespace tetwright::gaps_test
