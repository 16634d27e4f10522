#include "tools/exit_status.h"

#include <gtest/gtest.h>

#include <new>

#include "common/error.h"

namespace tetwright::exit_status_test {
namespace {

TEST(ExitStatus, FollowsTheKindOfError) {
  EXPECT_EQ(exit_status(UsageError("")), ExitStatus::usage);
  EXPECT_EQ(exit_status(InputError("")), ExitStatus::bad_input);
  EXPECT_EQ(exit_status(NothingToMeshError("")), ExitStatus::nothing_to_mesh);
  EXPECT_EQ(exit_status(OutputError("")), ExitStatus::output_failed);
  EXPECT_EQ(exit_status(std::bad_alloc()), ExitStatus::output_failed);
  EXPECT_EQ(exit_status(Interrupted()), ExitStatus::interrupted);
}

TEST(ExitStatus, ABrokenInvariantIsOurBug) {
  try {
    TETWRIGHT_CHECK(1 + 1 == 3);
    FAIL();
  } catch (const std::exception& e) {
    EXPECT_EQ(exit_status(e), ExitStatus::internal_error);
    EXPECT_EQ(static_cast<int>(exit_status(e)), 70);
    EXPECT_NE(std::string(e.what()).find("1 + 1 == 3"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace tetwright::exit_status_test
