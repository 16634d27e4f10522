// SPDX-License-Identifier: Apache-2.0
#include "tetwright/resources.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/common/io/expect_error.h"
#include "tests/common/temporary_folder.h"
#include "tetwright/error.h"

namespace tetwright::memory_test {
namespace {

class Memory : public testing::Test {
 protected:
  void write(const std::string& file, const std::string& text) const {
    const std::filesystem::path path = root() / file;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text << "\n";
  }
  std::filesystem::path root() const { return folder_ / "root"; }

 private:
  TemporaryFolder folder_;
};

TEST_F(Memory, IsTheMachinesWithoutLimits) {
  EXPECT_GT(available_memory(), 0);
  EXPECT_GE(available_memory(root()), available_memory());
}

TEST_F(Memory, IsTheSmallestLimitOfTheGroupAndThoseAboveIt) {
  write("proc/self/cgroup", "0::/a/b");
  write("sys/fs/cgroup/a/b/memory.max", "max");
  write("sys/fs/cgroup/a/memory.max", "20000000");
  write("sys/fs/cgroup/memory.max", "30000000");
  EXPECT_EQ(available_memory(root()), 2e7);
  write("sys/fs/cgroup/a/b/memory.max", "10000000");
  EXPECT_EQ(available_memory(root()), 1e7);
}

TEST_F(Memory, ReadsControlGroupsOfVersion1) {
  write("proc/self/cgroup", "12:cpu,cpuacct:/x\n4:hugetlb,memory:/docker/1\n0::/");
  write("sys/fs/cgroup/memory/docker/1/memory.limit_in_bytes", "5000000");
  EXPECT_EQ(available_memory(root()), 5e6);
}

TEST_F(Memory, FindsTheLimitWhereTheGroupIsNamedAsTheHostSeesIt) {
  write("proc/self/cgroup", "0::/system.slice/docker-1.scope");
  write("sys/fs/cgroup/memory.max", "7000000");
  EXPECT_EQ(available_memory(root()), 7e6);
}

TEST_F(Memory, ThatIsHeldIsNotAvailable) {
  const MemoryLimit limit(1e9);
  {
    HeldMemory held(4e8);
    EXPECT_EQ(available_memory(), 6e8);
    held.add(4e8);
    EXPECT_EQ(available_memory(), 2e8);
    EXPECT_NE(error_of<OutputError>([] {
                require_memory(3e8, "more", "take less");
              }).find("0.186265 GB are available beside the 0.745058 GB that images and masks take"),
              std::string::npos);
    held.add(4e8);
    EXPECT_EQ(available_memory(), 0);
  }
  EXPECT_EQ(available_memory(), 1e9);
}

TEST_F(Memory, IgnoresWhatIsNoNumber) {
  const double machine = available_memory(root());
  write("proc/self/cgroup", "nonsense\n0::/a");
  write("sys/fs/cgroup/a/memory.max", "plenty");
  EXPECT_EQ(available_memory(root()), machine);
}

TEST_F(Memory, ThatIsNotThereIsRefusedWithBothNumbers) {
  require_memory(1, "nothing", "never shown");
  try {
    require_memory(1e18, "the mesh", "use a lower resolution");
    FAIL();
  } catch (const OutputError& e) {
    EXPECT_NE(std::string(e.what()).find("the mesh would take about 9.31323e+08 GB of memory, but "),
              std::string::npos)
        << e.what();
    EXPECT_TRUE(std::string(e.what()).ends_with("GB are available; use a lower resolution"));
  }
}

}  // namespace
}  // namespace tetwright::memory_test
