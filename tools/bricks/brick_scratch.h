// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace tetwright {

/// Everything that determines the bricks of a job, as names and values.
using BrickJob = std::vector<std::pair<std::string, std::string>>;
/// Name of the value of --bricks in it.
inline constexpr const char* bricks_option = "--bricks";

/// A folder with the finished bricks of a job. A brick's file appears complete or not at all, so that a job
/// which was stopped goes on from its finished bricks.
///
/// The folder belongs to one process at a time. Bricks may be written and read concurrently.
class BrickScratch {
 public:
  /// Opens the folder, or makes it.
  /// \throws UsageError if it has files of another job, or of an unknown one, or if another process uses it
  /// \throws OutputError if it cannot be written, or cannot be locked
  BrickScratch(std::string folder, const BrickJob& job);
  ~BrickScratch();
  BrickScratch(const BrickScratch&) = delete;
  BrickScratch& operator=(const BrickScratch&) = delete;

  /// Path of a brick's file.
  /// \param kept_surface BrickTask::keep_surface: such a brick has another file
  std::string file(std::size_t brick, bool kept_surface = false) const;
  bool has(std::size_t brick, bool kept_surface = false) const;
  /// \throws OutputError if the file cannot be written; nothing of it is left then
  void write(std::size_t brick, const std::string& bytes, bool kept_surface = false) const;
  /// \throws InputError if the file cannot be read
  std::string read(std::size_t brick, bool kept_surface = false) const;
  /// Space for more files, and of the files of bricks there are; bytes.
  double free_bytes() const;
  double used_bytes() const;
  /// Removes the files of all bricks and of the job, and the folder if nothing else is in it. Errors are
  /// ignored: the job is finished.
  void remove() const noexcept;

 private:
  std::string folder_;
  int lock_ = -1;
};

/// The value of --bricks of the job whose bricks a folder has; 0 if there is none.
int cells_of_job(const std::string& folder);

}  // namespace tetwright
