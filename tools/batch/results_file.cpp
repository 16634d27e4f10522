// SPDX-License-Identifier: Apache-2.0
#include "tools/batch/results_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "tetwright/error.h"
#include "tetwright/files.h"

namespace tetwright {

namespace {

/// Start of each line of results, whose keys are sorted.
constexpr std::string_view line_beginning = R"({"args":[)";

bool is_beginning_of_line(std::string_view text) {
  return text.substr(0, line_beginning.size()) == line_beginning.substr(0, text.size());
}

[[noreturn]] void fail(const std::string& path, const std::string& what) {
  throw OutputError("cannot write " + path + ": " + what);
}

}  // namespace

ResultsFile::ResultsFile(const std::string& path) : path_(path) {
  check_output_file(path);
  file_ = open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (file_ < 0) fail(path, std::strerror(errno));
  sync_folder_of(path);
  try {
    if (flock(file_, LOCK_EX | LOCK_NB) != 0)
      fail(path, errno == EWOULDBLOCK ? "another batch is writing it; give this one its own --results"
                                      : std::strerror(errno));
    reload();
  } catch (...) {
    close(file_);
    throw;
  }
}

ResultsFile::~ResultsFile() { close(file_); }

void ResultsFile::reload() {
  const std::string text = read_whole_file(path_);
  std::size_t number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string line = text.substr(begin, end - begin);
    ++number;
    if (!read_line(line)) {
      // A kill may have left the beginning of a line.
      if (end < text.size() || !is_beginning_of_line(line))
        throw InputError(path_, number,
                         "it is not a batch result; give --results another file, or remove this one");
      if (ftruncate(file_, static_cast<off_t>(begin)) != 0) fail(path_, std::strerror(errno));
    } else if (end == text.size()) {
      write_whole("\n");
    }
    begin = end + 1;
  }
}

bool ResultsFile::read_line(const std::string& text) {
  try {
    const nlohmann::json line = nlohmann::json::parse(text);
    statuses_[{line.at("id").get<std::string>(), line.at("args").get<std::vector<std::string>>()}] =
        line.at("status").get<int>();
    return true;
  } catch (const nlohmann::json::exception&) {
    return false;
  }
}

void ResultsFile::write_whole(const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t written = ::write(file_, text.data() + done, text.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(path_, std::strerror(errno));
    done += static_cast<std::size_t>(written);
  }
}

int ResultsFile::status_of(const Job& job) const {
  const auto found = statuses_.find({job.id, job.arguments});
  return found == statuses_.end() ? -1 : found->second;
}

void ResultsFile::append(const Job& job, int status, const std::string& line) {
  const std::lock_guard lock(mutex_);
  write_whole(line + "\n");
  if (fdatasync(file_) != 0 && errno != EINVAL) fail(path_, std::strerror(errno));
  statuses_[{job.id, job.arguments}] = status;
}

}  // namespace tetwright
