// SPDX-License-Identifier: Apache-2.0
#include "common/io/encodings/hdf5_file.h"

#include <gtest/gtest.h>

#include "common/io/encodings/hdf5_writer.h"
#include "tests/common/io/file_test.h"

namespace tetwright::hdf5_file_test {
namespace {

using Hdf5Files = FileTest;

/// Writes a file with one group.
/// \return files that other processes were to write
std::vector<std::string> shared_files_of(const std::string& path) {
  std::vector<std::string> shared;
  const FileSharing share{.hdf5 = [&](const std::string&, const std::string& file,
                                      const std::function<void(Hdf5Writer&)>&) { shared.push_back(file); }};
  OutputFiles files;
  write_hdf5_file(
      path, files, [](Hdf5Writer& file) { file.add_group("group"); }, &share);
  return shared;
}

TEST_F(Hdf5Files, AreSharedByProcesses) {
  EXPECT_EQ(shared_files_of(path("a.h5")), std::vector<std::string>{path("a.h5")});
}

TEST_F(Hdf5Files, StandardOutputIsThatOfOneProcess) { EXPECT_TRUE(shared_files_of("-").empty()); }

}  // namespace
}  // namespace tetwright::hdf5_file_test
