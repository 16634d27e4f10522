// SPDX-License-Identifier: Apache-2.0

// Tests the sample `foam` with its options through the program.
#include <gtest/gtest.h>

#include "tests/tools/program.h"
#include "tetwright/io.h"

namespace tetwright::foam_test {
namespace {

TEST(Foam, HasTheSameBytesForAnyNumberOfThreads) {
  const TemporaryFolder f;
  const std::string options = " --voxels 50 --grains 300 --quiet -o ";
  ASSERT_EQ(run("sample foam --threads 1" + options + (f / "one.nrrd")).status, 0);
  ASSERT_EQ(run("sample foam --threads 4" + options + (f / "four.nrrd")).status, 0);
  const std::string bytes = contents(f / "one.nrrd");
  EXPECT_EQ(contents(f / "four.nrrd"), bytes);
  EXPECT_NE(bytes.find("type: uint16\n"), std::string::npos);
  EXPECT_NE(bytes.find("sizes: 50 50 50\n"), std::string::npos);
  const Answer stream = run("sample foam --output-format nrrd" + options + "-");
  EXPECT_EQ(stream.status, 0) << stream.err;
  EXPECT_EQ(stream.out, bytes);
}

TEST(Foam, HasDefaults) {
  const TemporaryFolder f;
  ASSERT_EQ(run("sample foam -o " + (f / "a.nrrd")).status, 0);
  ASSERT_EQ(run("sample foam --voxels 64 --grains 20 -o " + (f / "b.nrrd")).status, 0);
  EXPECT_EQ(contents(f / "a.nrrd"), contents(f / "b.nrrd"));
  // Too small for 20 grains.
  ASSERT_EQ(run("sample foam --voxels 5 -o " + (f / "c.nrrd")).status, 0);
  EXPECT_EQ(read_label_volume(f / "c.nrrd").labels, std::vector<MaterialTag>(125, 1));
}

TEST(Foam, IsMeshed) {
  const TemporaryFolder f;
  ASSERT_EQ(run("sample foam --voxels 24 --grains 6 -o " + (f / "foam.nrrd")).status, 0);
  const Answer a =
      run("mesh " + (f / "foam.nrrd") + " --voxel-size 2 --accept-changes -o " + (f / "foam.vtu"));
  ASSERT_EQ(a.status, 0) << a.err;
  EXPECT_NE(a.out.find("6 labels"), std::string::npos) << a.out;
  const Answer check = run("check " + (f / "foam.vtu"));
  EXPECT_EQ(check.status, 0) << check.out << check.err;
}

TEST(Foam, WrongCallsAreStatusTwo) {
  const TemporaryFolder f;
  const std::string out = " -o " + (f / "foam.nrrd");
  expect_refused("sample foam --voxels 3" + out, 2, {"--voxels", "'3'", "4 to 4096"});
  expect_refused("sample foam --voxels 4097" + out, 2, {"--voxels", "'4097'", "4 to 4096"});
  expect_refused("sample foam --grains 0" + out, 2, {"--grains", "'0'", "1 to 1000000"});
  expect_refused("sample foam --grains few" + out, 2, {"--grains", "'few'"});
  expect_refused("sample foam --voxels 16 --grains 65" + out, 2,
                 {"--grains 65", "16 voxels", "room for 64", "fewer grains", "more --voxels"});
  expect_refused("sample organs --voxels 16" + out, 2, {"--voxels 16", "sample foam", "organs"});
  expect_refused("sample sphere --grains 5" + out, 2, {"--grains 5", "sample foam", "sphere"});
  expect_refused("mesh a.off --grains 5 -o a.vtu", 2, {"no option --grains of mesh"});
  expect_refused("sample foam -o " + (f / "foam.nii"), 2, {"foam.nii", ".nrrd"});
  expect_refused("sample foam -o " + (f / "foam.vtu"), 2, {"foam.vtu", "volume of labels", ".nrrd"});
  EXPECT_EQ(f.entries(), 0u);
}

TEST(Foam, AFullDiskIsStatusFiveAndLeavesNothing) {
  const TemporaryFolder f;
  put(f / "old.nrrd", "precious");
  // A file size limit of 16 blocks acts like a full disk.
  expect_refused("sample foam -o " + (f / "old.nrrd"), 5, {"old.nrrd"}, "ulimit -f 16;");
  EXPECT_EQ(contents(f / "old.nrrd"), "precious");
  EXPECT_EQ(f.entries(), 1u);
  expect_refused("sample foam --voxels 4096 --output-format nrrd -o - --memory-limit 1", 5,
                 {"standard output", "-o a file"});
}

}  // namespace
}  // namespace tetwright::foam_test
