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

/// Name of the number of rounds in it, even if it was chosen.
inline constexpr const char* rounds_option = "--brick-rounds";

/// Which file of a job.
struct BrickFile {
  std::size_t brick = 0;
  int round = 1;              ///< from 1
  bool kept_surface = false;  ///< BrickTask::keep_surface: such a brick has another file
};

/// How a volume is divided.
struct BrickDivision {
  int cells = 0;   ///< the value of --bricks; 0: none
  int rounds = 0;  ///< the value of --brick-rounds; 0: none
};

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

  std::string path(const BrickFile& file) const;
  bool has(const BrickFile& file) const;
  /// \throws OutputError if the file cannot be written; nothing of it is left then
  void write(const BrickFile& file, const std::string& bytes) const;
  /// \throws InputError if the file cannot be read
  std::string read(const BrickFile& file) const;
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

/// The division of the job whose bricks a folder has, if there is one.
BrickDivision division_of_job(const std::string& folder);

}  // namespace tetwright
