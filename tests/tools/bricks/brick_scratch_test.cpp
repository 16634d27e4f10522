// SPDX-License-Identifier: Apache-2.0
#include "tools/bricks/brick_scratch.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <filesystem>
#include <functional>
#include <optional>

#include "tests/common/temporary_folder.h"
#include "tetwright/error.h"

namespace tetwright::brick_scratch_test {
namespace {

const BrickJob job{{"voxels", "10 20 30"}, {"--seed", "1"}};

/// Expects an error of this kind whose message contains all of `said`.
template <class Error>
void expect_error(const std::function<void()>& work, const std::vector<std::string>& said) {
  try {
    work();
    ADD_FAILURE() << "no error";
  } catch (const Error& e) {
    for (const std::string& s : said)
      EXPECT_NE(std::string(e.what()).find(s), std::string::npos) << e.what() << " lacks: " << s;
  }
}

/// Limits the size of files during its lifetime, which acts like a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    rlimit limit = before_;
    limit.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() { setrlimit(RLIMIT_FSIZE, &before_); }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
};

class BrickScratchTest : public ::testing::Test {
 protected:
  std::string path() const { return folder_ / "scratch"; }
  std::string path(const std::string& name) const { return folder_ / ("scratch/" + name); }

  TemporaryFolder folder_;
};

TEST_F(BrickScratchTest, KeepsBricksForTheNextProcess) {
  const std::string bytes("a\0b", 3);
  {
    const BrickScratch scratch(path(), job);
    EXPECT_FALSE(scratch.has({0}));
    scratch.write({0}, "old");
    scratch.write({0}, bytes);
    scratch.write({12}, "");
    EXPECT_EQ(scratch.read({0}), bytes);
    EXPECT_GT(scratch.free_bytes(), 0);
  }
  const BrickScratch scratch(path(), job);
  EXPECT_TRUE(scratch.has({0}));
  EXPECT_FALSE(scratch.has({1}));
  EXPECT_TRUE(scratch.has({12}));
  EXPECT_EQ(scratch.read({0}), bytes);
  EXPECT_EQ(scratch.read({12}), "");
  EXPECT_TRUE(std::filesystem::is_regular_file(scratch.path({12})));
  expect_error<InputError>([&] { (void)scratch.read({1}); }, {scratch.path({1})});
  EXPECT_EQ(scratch.path({1}), path("brick-1.tetwright"));
}

TEST_F(BrickScratchTest, MakesFoldersWithinFolders) {
  const BrickScratch scratch(path("a/b"), job);
  scratch.write({3}, "x");
  EXPECT_EQ(contents(path("a/b/brick-3.tetwright")), "x");
}

TEST_F(BrickScratchTest, AnotherJobIsRefused) {
  { const BrickScratch scratch(path(), job); }
  const auto open = [&](const BrickJob& other) { const BrickScratch scratch(path(), other); };
  expect_error<UsageError>(
      [&] {
        open({{"voxels", "10 20 30"}, {"--seed", "2"}});
      },
      {"another job", "--seed is \"1\", here \"2\"", "--scratch"});
  expect_error<UsageError>(
      [&] {
        open({{"voxels", "10 20 30"}, {"--seed", "1"}, {"--beta", "5"}});
      },
      {"another job", "--beta is missing, here \"5\""});
  EXPECT_NO_THROW(open(job));
}

TEST_F(BrickScratchTest, ADamagedDescriptionIsRefused) {
  { const BrickScratch scratch(path(), job); }
  const std::string description = contents(path("tetwright-job.json"));
  for (const std::string& damaged : {std::string(), std::string("{"), std::string("[1]"), std::string("7"),
                                     std::string("\0\xff\xfe", 3), description.substr(0, 30)}) {
    put(path("tetwright-job.json"), damaged);
    expect_error<UsageError>([&] { const BrickScratch scratch(path(), job); },
                             {"tetwright-job.json", "no description of a job", "--scratch"});
    EXPECT_EQ(contents(path("tetwright-job.json")), damaged);
  }
  put(path("tetwright-job.json"), description);
  EXPECT_NO_THROW(BrickScratch(path(), job));
}

TEST_F(BrickScratchTest, BelongsToOneProcessAtATime) {
  {
    const BrickScratch scratch(path(), job);
    put(path(".tetwright-1.tmp"), "a brick that is being written");
    // Locks of two descriptions of an open file exclude each other within a process, too.
    expect_error<UsageError>([&] { const BrickScratch second(path(), job); },
                             {path(), "another process", "--scratch"});
    EXPECT_TRUE(std::filesystem::exists(path(".tetwright-1.tmp")));
  }
  EXPECT_NO_THROW(BrickScratch(path(), job));
}

TEST_F(BrickScratchTest, RemovesWhatKilledProcessesLeft) {
  { const BrickScratch scratch(path(), job); }
  const std::vector<std::string> foreign{"notes.txt", ".tetwright-notes", "notes.tmp", "brick-1.txt"};
  for (const std::string& name : foreign) put(path(name), name);
  put(path(".tetwright-123-abc.tmp"), "half a brick");
  const BrickScratch scratch(path(), job);
  EXPECT_FALSE(std::filesystem::exists(path(".tetwright-123-abc.tmp")));
  for (const std::string& name : foreign) EXPECT_EQ(contents(path(name)), name);
}

TEST_F(BrickScratchTest, AFileInsteadOfTheFolderIsRefused) {
  put(path(), "precious");
  for (const std::string& wrong : {path(), path("below")})
    expect_error<OutputError>([&] { const BrickScratch scratch(wrong, job); },
                              {wrong, "cannot make this folder", "--scratch"});
  EXPECT_EQ(contents(path()), "precious");
}

TEST_F(BrickScratchTest, AFullDiskLeavesTheOtherBricks) {
  const BrickScratch scratch(path(), job);
  scratch.write({0}, std::string(3000, 'a'));
  scratch.write({1}, "old");
  {
    const FileSizeLimit limit(2000);
    for (const std::size_t brick : {1, 2})
      expect_error<OutputError>([&] { scratch.write({brick}, std::string(3000, 'b')); },
                                {scratch.path({brick})});
    EXPECT_NO_THROW(scratch.write({3}, std::string(1000, 'c')));
  }
  EXPECT_EQ(scratch.read({0}), std::string(3000, 'a'));
  EXPECT_EQ(scratch.read({1}), "old");
  EXPECT_FALSE(scratch.has({2}));
  EXPECT_TRUE(scratch.has({3}));
  // The job's file, the lock and three bricks.
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(path()), {}), 5);
}

TEST_F(BrickScratchTest, NothingIsLeftAtTheEndExceptForeignFiles) {
  for (const bool foreign : {true, false}) {
    const BrickScratch scratch(path(), job);
    for (const std::size_t brick : {0, 9, 1000}) scratch.write({brick}, "x");
    EXPECT_EQ(scratch.used_bytes(), 3);
    const std::vector<std::string> names{"notes.txt", "brick-1.txt", "my-brick-2.tetwright", "tetwright-job"};
    for (const std::string& name : names)
      if (foreign) put(path(name), name);
    scratch.write({9, 1, true}, "y");
    EXPECT_EQ(scratch.read({9}), "x");
    EXPECT_EQ(scratch.read({9, 1, true}), "y");
    scratch.remove();
    EXPECT_EQ(std::filesystem::exists(path()), foreign);
    if (!foreign) continue;
    EXPECT_EQ(static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(path()), {})),
              names.size());
    for (const std::string& name : names) {
      EXPECT_EQ(contents(path(name)), name);
      std::filesystem::remove(path(name));
    }
  }
}

TEST_F(BrickScratchTest, BricksOfAnUnknownJobAreRefused) {
  { BrickScratch(path(), job).write({0}, "x"); }
  std::filesystem::remove(path("tetwright-job.json"));
  expect_error<UsageError>([&] { const BrickScratch scratch(path(), job); },
                           {path(), "unknown job", "tetwright-job.json", "--scratch"});
  EXPECT_EQ(contents(path("brick-0.tetwright")), "x");
}

}  // namespace
}  // namespace tetwright::brick_scratch_test
