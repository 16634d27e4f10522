// SPDX-License-Identifier: Apache-2.0

// Tests invalid calls: the status and the message.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/tools/program.h"

namespace tetwright::wrong_calls_test {
namespace {

TEST(WrongCalls, AreStatusTwo) {
  const TemporaryFolder f;
  put(f / "t.off", tetrahedron_off);
  const std::string in = f / "t.off", out = f / "t.vtu";
  expect_refused("", 2, {"there is no command", "prepare, mesh, simplify"});
  expect_refused("prepare " + in + " -o " + out, 2, {"--target-tets"});
  expect_refused("prepare " + in + " -o " + out + " --target-tets 0", 2, {"0"});
  expect_refused("prepare " + in + " -o " + out + " --target-tets many", 2, {"many"});
  expect_refused("prepare " + in + " -o " + out + " --target-tets 100 --gama 3", 2, {"--gama"});
  expect_refused("prepare " + in + " -o " + out + " --target-tets 100 --tolerance -1", 2, {"--tolerance"});
  expect_refused("prepare " + in + " -o " + out + " --tolerance 1 --schedule paper", 2, {"--tolerance"});
  expect_refused("prepare " + in + " -o " + out + " --target-tets 100 --beta nan", 2, {});
  expect_refused("prepare " + in + " -o " + out + " --target-tets 100 --threads 0", 2, {"--threads"});
  expect_refused("mesh " + in + " -o " + out + " --resolution 2", 2, {"--resolution"});
  expect_refused("mesh " + in + " -o " + out + " --resolution 20 --voxel-size 0.1", 2, {"--voxel-size"});
  expect_refused("mesh " + in + " -o " + (f / "t.xyz"), 2, {"t.xyz", ".vtu"});
  expect_refused("mesh " + (f / "t.foo") + " -o " + out, 2, {"t.foo"});
  expect_refused("simplify " + in + " -o " + out + " --target-tets 10", 2, {"t.off"});
  expect_refused("prepare " + in + " -o " + out + " --target-tets -5", 2, {"-5"});
  expect_refused("prepare " + in + " -o " + out + " --target-tets 99999999999999999999999", 2,
                 {"--target-tets"});
  expect_refused("prepare " + in + " -o " + out + " --target-tets ''", 2, {"--target-tets"});
  expect_refused("prepare " + in + " -o " + out + " --target-tets 100 --seed -1", 2, {"-1"});
  expect_refused("prepare " + in + " -o " + out + " --tolerance= --target-tets 100", 2,
                 {"--tolerance= has no value"});
  for (const char* number : {" 5", "5 ", "5 %", "0x5", "+5", "1e-400", "1e400", "inf"})
    expect_refused("prepare " + in + " -o " + out + " --tolerance '" + number + "'", 2,
                   {"--tolerance: '" + std::string(number) + "' is not a "});
  // Two outputs through links to the same file, which does not exist yet.
  for (const char* link : {"link.vtu", "link.json"}) std::filesystem::create_symlink("real", f / link);
  expect_refused("mesh " + in + " -o " + (f / "link.vtu") + " --stats " + (f / "link.json"), 2,
                 {"link.json is also the file of -o"});
  for (const char* link : {"link.vtu", "link.json"}) std::filesystem::remove(f / link);
  expect_refused("sample dodo -o " + out, 2, {"dodo", "sphere"});
  expect_refused("sample sphere -o " + out, 2, {"t.vtu", ".ply"});
  expect_refused("sample organs -o " + out, 2, {"t.vtu", "volume of labels", ".nrrd"});
  EXPECT_EQ(f.entries(), 1u);
}

TEST(WrongCalls, NameTheNearestCommandAndOption) {
  expect_refused("frob", 2,
                 {"no command 'frob'", "the nearest is 'mesh'", "prepare, mesh, simplify, improve"});
  expect_refused("simplfy --target-tets 5", 2, {"'simplfy'", "'simplify'"});
  expect_refused("simplify a.vtu -o b.vtu --target-tet 5", 2,
                 {"no option --target-tet of simplify", "nearest is --target-tets"});
  expect_refused("mesh a.off -o b.vtu --resolutoin=5", 2,
                 {"--resolutoin of mesh", "nearest is --resolution"});
  expect_refused("simplify a.vtu b.vtu -o c.vtu --target-tets 5", 2, {"simplify takes one MESH; 'b.vtu'"});
  // Arguments after -- are names; the error is in the value before it.
  expect_refused("check --threads=0 -- a.vtu", 2, {"--threads", "'0'"});
  expect_refused("mesh a.off -o b.vtu -o c.vtu", 2, {"--output was given more than once"});
  expect_refused("--verson", 2, {"no option --verson;", "nearest is --version"});
}

TEST(WrongCalls, NameTheCommandsForAKindOfFile) {
  const TemporaryFolder f;
  for (const char* command : {"prepare --target-tets 9 ", "mesh "})
    expect_refused(command + (f / "x.vtu") + " -o " + (f / "o.vtu"), 2,
                   {"x.vtu is a tet mesh", "'tetwright simplify'", ".ply", ".vdb", ".nii.gz"});
  expect_refused("mesh " + (f / "x") + " -o " + (f / "o.vtu"), 2, {"no extension", ".ply", ".nrrd"});
  expect_refused("simplify --target-tets 9 " + (f / "x.STL") + " -o " + (f / "o.vtu"), 2,
                 {"x.STL is a surface", "'tetwright prepare'", ".vtu"});
  expect_refused("improve " + (f / "x.nii.gz") + " -o " + (f / "o.vtu"), 2, {"is a volume", ".vtu"});
  EXPECT_EQ(f.entries(), 0u);
}

}  // namespace
}  // namespace tetwright::wrong_calls_test
