// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include "tests/common/temporary_folder.h"

namespace tetwright {

/// A test with a separate folder.
class FileTest : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_ / name; }
  static std::string get(const std::string& path) { return contents(path); }
  std::size_t files() const { return folder_.entries(); }

  TemporaryFolder folder_;
};

}  // namespace tetwright
