// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "tools/batch/jobs.h"

namespace tetwright {

/// Results of a batch: one line of JSON for each job that has ended, in the order in which they ended: {"id",
/// "args", "status", "seconds", "messages", "stats"}. A line is appended in one piece and synced to disk
/// after the job's files are in place. A kill can leave a partial last line, which the next read removes.
class ResultsFile {
 public:
  /// Opens or creates the file, and locks it against other batches.
  ///
  /// \throws InputError with the line number if a line is not such a result
  /// \throws OutputError if the file cannot be written or is in use
  explicit ResultsFile(const std::string& path);
  ~ResultsFile();
  ResultsFile(const ResultsFile&) = delete;
  ResultsFile& operator=(const ResultsFile&) = delete;

  /// Reads the lines that a child process, which shares the file, has appended.
  ///
  /// \throws Error in the cases of the constructor
  void reload();
  /// Last exit status of a job with this id and these arguments; -1 if it has not ended.
  int status_of(const Job& job) const;
  /// Appends the line of an ended job. Thread-safe.
  ///
  /// \throws OutputError if it cannot be written
  void append(const Job& job, int status, const std::string& line);

 private:
  /// Reads a line of results.
  /// \return false if it is not a result
  bool read_line(const std::string& text);
  void write_whole(const std::string& text);

  std::string path_;
  int file_ = -1;
  std::mutex mutex_;
  std::map<std::pair<std::string, std::vector<std::string>>, int> statuses_;
};

}  // namespace tetwright
