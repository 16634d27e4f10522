// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "tools/batch/jobs.h"

namespace tetwright {

/// The results of a batch, a line of JSON for each job that ended, in the order in which they did:
/// {"id", "args", "status", "seconds", "messages", "stats"}. A line is appended whole and synced to the disk
/// once the job's files are in place, so that what it says is there. A kill can leave part of a line at the
/// end, which is cut off when the file is read again.
class ResultsFile {
 public:
  /// Opens or creates the file, which no other process may have open in this way. Throws InputError where a
  /// line is not such a result (with its number), OutputError where the file cannot be written or is in use.
  explicit ResultsFile(const std::string& path);
  ~ResultsFile();
  ResultsFile(const ResultsFile&) = delete;
  ResultsFile& operator=(const ResultsFile&) = delete;

  /// Reads what a child process, which shares the file, has appended. Throws as the constructor does.
  void reload();
  /// The status with which a job of this id and these arguments ended last, or -1.
  int status_of(const Job& job) const;
  /// Appends the line of a job that ended. May be called concurrently. Throws OutputError.
  void append(const Job& job, int status, const std::string& line);

 private:
  /// False where it is no result.
  bool read_line(const std::string& text);
  void write_whole(const std::string& text);

  std::string path_;
  int file_ = -1;
  std::mutex mutex_;
  std::map<std::pair<std::string, std::vector<std::string>>, int> statuses_;
};

}  // namespace tetwright
