// SPDX-License-Identifier: Apache-2.0

// Tests standard input and output as files.
#include <gtest/gtest.h>

#include "tests/tools/program.h"

namespace tetwright::streams_test {
namespace {

/// Runs a shell pipeline whose commands call the program as "$t".
Answer shell(const std::string& pipeline) {
  const TemporaryFolder folder;
  const std::string command =
      "t=" + program() + "; { " + pipeline + "; } >" + (folder / "out") + " 2>" + (folder / "err");
  const int code = std::system(command.c_str());
  return {WIFEXITED(code) ? WEXITSTATUS(code) : 1000 + WTERMSIG(code), contents(folder / "out"),
          contents(folder / "err")};
}

TEST(Streams, AreReadAndWrittenLikeFiles) {
  const TemporaryFolder f;
  ASSERT_EQ(run("sample torus -o " + (f / "t.ply")).status, 0);
  const std::string options = "--resolution 16 --accept-changes --output-format vtu";
  for (const char* name : {"ply", ".ply"}) {
    const Answer a = shell("cat " + (f / "t.ply") + " | $t mesh - --input-format " + name + " " + options +
                           " -o - >" + (f / "s.vtu") + " && $t check " + (f / "s.vtu"));
    EXPECT_EQ(a.status, 0) << a.err;
    EXPECT_NE(contents(f / "s.vtu").find("VTKFile"), std::string::npos);
  }
  // Directly from one command to the next.
  const Answer a =
      shell("$t mesh " + (f / "t.ply") + " --resolution 16 -o - --output-format msh41-binary --quiet" +
            " | $t simplify - --input-format msh --target-tets 500 -o - --output-format medit" +
            " | $t check - --input-format mesh");
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_NE(a.out.find("valid"), std::string::npos);
  EXPECT_EQ(f.entries(), 2u);
}

TEST(Streams, OfTheBoundary) {
  const TemporaryFolder f;
  ASSERT_EQ(run("sample two_materials -o " + (f / "in.vtu")).status, 0);
  const std::string call = "improve " + (f / "in.vtu") + " -o " + (f / "out.msh") + " --boundary ";
  ASSERT_EQ(run(call + (f / "file.vtp") + " --output-format msh41").status, 0);
  const std::string mesh = contents(f / "out.msh");
  const Answer a = run(call + "- --output-format vtp");
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_EQ(a.out, contents(f / "file.vtp"));
  EXPECT_NE(contents(f / "out.msh"), mesh) << "--output-format is that of the stream";
  expect_refused(call + "-", 2, {"--boundary -", "--output-format"});
  expect_refused(call + "- --output-format msh41", 2, {"msh41", "for a surface", ".vtp"});
  expect_refused(call + "- --output-format vtp --stats -", 2, {"--boundary -", "--stats -"});
  expect_refused("improve " + (f / "in.vtu") + " -o - --boundary - --output-format vtp", 2,
                 {"-o -", "--boundary -"});
}

TEST(Streams, OfVolumes) {
  const TemporaryFolder f;
  ASSERT_EQ(run("sample organs -o " + (f / "o.nrrd")).status, 0);
  const std::string rest = " --voxel-size 3 --uniform --accept-changes --quiet -o ";
  ASSERT_EQ(run("mesh " + (f / "o.nrrd") + rest + (f / "file.vtu")).status, 0);
  ASSERT_EQ(shell("$t mesh - --input-format nrrd" + rest + (f / "stream.vtu") + " <" + (f / "o.nrrd")).status,
            0);
  EXPECT_EQ(contents(f / "file.vtu"), contents(f / "stream.vtu"));
}

TEST(Streams, OfSamples) {
  const TemporaryFolder f;
  for (const auto& [sample, format] :
       {std::pair{"torus", "ply"}, {"organs", "nrrd"}, {"two_materials", "msh41"}, {"tet_cube", "vtu"}}) {
    const std::string name = f / (std::string("s.") + format);
    const std::string written = std::string("sample ") + sample + " --output-format " + format + " -o ";
    ASSERT_EQ(run(written + name).status, 0);
    const Answer a = run(written + "-");
    EXPECT_EQ(a.status, 0) << a.err;
    EXPECT_EQ(a.out, contents(name)) << sample;
    EXPECT_FALSE(a.out.empty());
  }
  expect_refused("sample torus -o -", 2, {"--output-format"});
  expect_refused("sample torus -o - --output-format vtu", 2, {"for a surface", ".ply"});
  expect_refused("sample organs -o - --output-format ply", 2, {"no format \"ply\" for a volume", ".nrrd"});
  expect_refused("sample torus -o - --output-format glb", 2, {"can be read, not written"});
  expect_refused("sample tet_cube -o - --output-format xdmf", 2, {"xdmf", "several files"});
}

TEST(Streams, MessagesNameThem) {
  const Answer a = shell("echo nonsense | $t mesh - --input-format off -o /dev/null.vtu");
  EXPECT_NE(a.status, 0);
  const TemporaryFolder f;
  const Answer b = shell("echo nonsense | $t mesh - --input-format off -o " + (f / "o.vtu"));
  EXPECT_EQ(b.status, 3);
  EXPECT_EQ(b.err.rfind("tetwright: stdin: ", 0), 0u) << b.err;
}

TEST(Streams, ReaderThatHasGone) {
  const TemporaryFolder f;
  ASSERT_EQ(run("sample torus -o " + (f / "t.ply")).status, 0);
  const Answer a =
      shell("{ $t mesh " + (f / "t.ply") + " --quiet -o - --output-format msh22; echo $? >&2; } | true");
  EXPECT_NE(a.err.find("standard output"), std::string::npos) << a.err;
  EXPECT_NE(a.err.find("\n5\n"), std::string::npos) << a.err;
}

TEST(Streams, ThatCannotBe) {
  const TemporaryFolder f;
  const std::string output = " -o " + (f / "o.vtu");
  expect_refused("mesh -" + output, 2, {"--input-format", ".ply"});
  expect_refused("mesh - - --input-format ply" + output, 2, {"can be given once"});
  expect_refused("mesh - stdin --input-format ply" + output, 2, {"stdin", "another name"});
  expect_refused("mesh a.ply --input-format ply" + output, 2, {"--input-format"});
  expect_refused("mesh - --input-format jpeg" + output, 2, {"jpeg", ".ply"});
  for (const char* several : {"xdmf", "node", "hdr", "nhdr"})
    expect_refused(std::string("mesh - --input-format ") + several + output, 2, {several});
  expect_refused("mesh a.ply -o -", 2, {"--output-format"});
  expect_refused("mesh a.ply -o - --output-format xdmf", 2, {"several files"});
  expect_refused("mesh a.ply -o - --output-format vtu --stats -", 2, {"-o -", "--stats -"});
  EXPECT_EQ(f.entries(), 0u);
}

}  // namespace
}  // namespace tetwright::streams_test
