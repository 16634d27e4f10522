// SPDX-License-Identifier: Apache-2.0
#include "tetwright/files.h"

#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>

#include "tests/common/io/expect_error.h"
#include "tests/common/io/file_test.h"
#include "tetwright/progress.h"

namespace tetwright::atomic_file_test {
namespace {

using AtomicFile = FileTest;

TEST_F(AtomicFile, NewAndReplaced) {
  write_file_atomically(path("a"), "first");
  EXPECT_EQ(get(path("a")), "first");
  chmod(path("a").c_str(), 0640);
  write_file_atomically(path("a"), std::string("sec\0nd", 6));
  EXPECT_EQ(get(path("a")), std::string("sec\0nd", 6));
  struct stat status;
  ASSERT_EQ(stat(path("a").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0640u);
  EXPECT_EQ(files(), 1u);
  EXPECT_EQ(read_whole_file(path("a")), std::string("sec\0nd", 6));
}

TEST_F(AtomicFile, AReservedFileIsWrittenByAnyone) {
  put(path("a"), "old");
  chmod(path("a").c_str(), 0640);
  {
    OutputFiles files;
    const std::string temporary = files.reserve(path("a"));
    write_reserved_file(temporary, path("a"), [](const ByteSink& sink) { sink("longer"); });
    write_reserved_file(temporary, path("a"), [](const ByteSink& sink) { sink("new"); });
    EXPECT_EQ(get(path("a")), "old");
    files.commit();
    EXPECT_EQ(get(path("a")), "new");
    struct stat status;
    ASSERT_EQ(stat(path("a").c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777, 0640u);
    const std::string unused = files.reserve(path("b"));
    EXPECT_TRUE(std::filesystem::path(unused).is_absolute());
    EXPECT_EQ(this->files(), 2u);
  }
  EXPECT_EQ(this->files(), 1u);
  // As on a machine that has another folder.
  EXPECT_NE(error_of<OutputError>([&] {
              write_reserved_file(path("gone"), path("b"), [](const ByteSink& sink) { sink("x"); });
            }).find("all processes must see the folder"),
            std::string::npos);
  EXPECT_EQ(this->files(), 1u);
}

TEST_F(AtomicFile, ALinkStaysAndItsTargetIsReplaced) {
  namespace fs = std::filesystem;
  fs::create_directory(path("sub"));
  put(path("sub/target"), "old");
  fs::create_symlink("sub/target", path("link"));
  fs::create_symlink(path("link"), path("link to link"));
  write_file_atomically(path("link to link"), "new");
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_EQ(get(path("sub/target")), "new");
  fs::create_symlink("sub/fresh", path("dangling"));
  write_file_atomically(path("dangling"), "fresh");
  EXPECT_TRUE(fs::is_symlink(path("dangling")));
  EXPECT_EQ(get(path("sub/fresh")), "fresh");
  fs::create_symlink("round", path("round"));
  EXPECT_NE(error_of<OutputError>([&] { check_output_file(path("round")); }).find("link"), std::string::npos);
}

TEST_F(AtomicFile, ImpossibleTargets) {
  std::filesystem::create_directory(path("folder"));
  put(path("file"), "");
  EXPECT_NE(error_of<OutputError>([&] { check_output_file(path("folder")); }).find("folder"),
            std::string::npos);
  EXPECT_NE(error_of<OutputError>([&] { check_output_file(path("none/a")); }).find("No such file"),
            std::string::npos);
  EXPECT_NE(error_of<OutputError>([&] { check_output_file(path("file/a")); }).find("file"),
            std::string::npos);
  EXPECT_NE(error_of<OutputError>([&] { check_output_file("/dev/null"); }).find("not a regular file"),
            std::string::npos);
  if (geteuid() != 0) {  // root may write everywhere
    chmod(path("folder").c_str(), 0555);
    EXPECT_NE(error_of<OutputError>([&] { check_output_file(path("folder/a")); }).find("not writable"),
              std::string::npos);
    chmod(path("folder").c_str(), 0755);
  }
}

TEST_F(AtomicFile, OverTheFileSizeLimitNothingIsLeft) {
  put(path("a"), "old");
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit small{1000, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string message =
      error_of<OutputError>([&] { write_file_atomically(path("a"), std::string(5000, 'x')); });
  const std::string fresh =
      error_of<OutputError>([&] { write_file_atomically(path("b"), std::string(5000, 'x')); });
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_NE(message.find("too large"), std::string::npos) << message;
  EXPECT_NE(fresh.find("too large"), std::string::npos) << fresh;
  EXPECT_EQ(get(path("a")), "old");
  EXPECT_EQ(files(), 1u);
  struct sigaction now = {};
  sigaction(SIGXFSZ, nullptr, &now);
  EXPECT_EQ(now.sa_handler, SIG_DFL);
}

TEST_F(AtomicFile, AnErrorBetweenPiecesLeavesTheOldFile) {
  put(path("a"), "old");
  for (const char* name : {"a", "b"})
    EXPECT_EQ(error_of<OutputError>([&] {
                write_file_atomically(path(name), [](const ByteSink& sink) {
                  sink(std::string(5000, 'x'));
                  throw OutputError("no more");
                });
              }),
              "no more");
  EXPECT_EQ(get(path("a")), "old");
  EXPECT_EQ(files(), 1u);
  write_file_atomically(path("a"), [](const ByteSink& sink) {
    sink("new");
    sink("");
    sink("er");
  });
  EXPECT_EQ(get(path("a")), "newer");
}

TEST_F(AtomicFile, FilesOfOneCallAppearTogether) {
  put(path("a"), "old");
  {
    OutputFiles files;
    files.write(path("a"), "new");
    files.write(path("b"), "other");
    EXPECT_EQ(get(path("a")), "old");
    EXPECT_FALSE(std::filesystem::exists(path("b")));
  }
  EXPECT_EQ(files(), 1u);  // files that were not committed are removed
  OutputFiles files;
  files.write(path("a"), "new");
  files.write(path("b"), "other");
  // A file that cannot be written does not affect the others.
  EXPECT_NE(error_of<OutputError>([&] { files.write(path("none/c"), "x"); }).find("No such file"),
            std::string::npos);
  files.commit();
  EXPECT_EQ(get(path("a")), "new");
  EXPECT_EQ(get(path("b")), "other");
  EXPECT_EQ(this->files(), 2u);
}

TEST_F(AtomicFile, CancellingLeavesTheOldFile) {
  put(path("a"), "old");
  Progress progress;
  OutputFiles files(&progress);
  files.write(path("b"), "before");
  (void)error_of<Interrupted>([&] {
    files.write(path("a"), [&](const ByteSink& sink) {
      sink("one");
      progress.cancel();
      sink("two");
    });
  });
  (void)error_of<Interrupted>([&] { files.write(path("a"), "x"); });
  (void)error_of<Interrupted>([&] { files.commit(); });
  EXPECT_EQ(get(path("a")), "old");
  EXPECT_FALSE(std::filesystem::exists(path("b")));
}

TEST_F(AtomicFile, WhatIsAbandonedIsGone) {
  put(path("a"), "old");
  // In a separate process, since nothing can be written afterwards.
  EXPECT_EXIT(
      {
        OutputFiles files;
        files.write(path("a"), "new");
        files.write(path("b"), "other");
        (void)abandon_output_files();
        _exit(this->files() != 1 || get(path("a")) != "old" ? 1 : 7);
      },
      testing::ExitedWithCode(7), "");
  EXPECT_EXIT(
      {
        write_file_atomically(path("c"), "done");
        _exit(abandon_output_files() ? 7 : 1);
      },
      testing::ExitedWithCode(7), "");
}

TEST_F(AtomicFile, ADiskThatIsFull) {
  // /dev/full fails every write like a full disk, but is rejected as a target before that.
  EXPECT_NE(error_of<OutputError>([&] { write_file_atomically("/dev/full", "x"); }).find("regular"),
            std::string::npos);
}

TEST_F(AtomicFile, UnreadableInput) {
  EXPECT_NE(error_of<InputError>([&] { (void)read_whole_file(path("none")); }).find("No such file"),
            std::string::npos);
  EXPECT_NE(error_of<InputError>([&] { (void)read_whole_file(path("")); }).find("folder"), std::string::npos);
  EXPECT_NE(error_of<InputError>([&] { (void)read_whole_file("/dev/zero"); }).find("regular"),
            std::string::npos);
  put(path("empty"), "");
  EXPECT_EQ(read_whole_file(path("empty")), "");
}

}  // namespace
}  // namespace tetwright::atomic_file_test
