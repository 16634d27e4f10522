// SPDX-License-Identifier: Apache-2.0
#include "tools/app/exit_status.h"

#include <gtest/gtest.h>

#include <new>
#include <stdexcept>
#include <string>
#include <system_error>

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
  EXPECT_EQ(exit_status(std::runtime_error("pthread_create has failed")), ExitStatus::output_failed);
  EXPECT_EQ(exit_status(std::system_error(std::make_error_code(std::errc::resource_unavailable_try_again))),
            ExitStatus::output_failed);
  EXPECT_EQ(exit_status(std::out_of_range("")), ExitStatus::internal_error);
}

TEST(ExitStatus, MessagesSayWhatToDo) {
  EXPECT_NE(failure_message(std::runtime_error("no thread")).find("--threads"), std::string::npos);
  EXPECT_NE(failure_message(std::bad_alloc()).find("--resolution"), std::string::npos);
  EXPECT_NE(failure_message(InternalError("odd")).find("please report"), std::string::npos);
  EXPECT_EQ(failure_message(InputError("a.ply: no points")), "a.ply: no points");
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
