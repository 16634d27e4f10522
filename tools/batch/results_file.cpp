#include "tools/batch/results_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/error.h"
#include "common/formats/atomic_file.h"

namespace tetwright {

namespace {

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
      fail(path, errno == EWOULDBLOCK ? "another batch is writing it; give this one --results of its own"
                                      : std::strerror(errno));
    const std::string text = read_whole_file(path);
    const std::size_t whole = text.rfind('\n') + 1;  // 0 without any
    read_lines(text.substr(0, whole));
    if (whole < text.size() && ftruncate(file_, static_cast<off_t>(whole)) != 0)
      fail(path, std::strerror(errno));
  } catch (...) {
    close(file_);
    throw;
  }
}

ResultsFile::~ResultsFile() { close(file_); }

void ResultsFile::read_lines(const std::string& text) {
  std::size_t number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    ++number;
    try {
      const nlohmann::json line = nlohmann::json::parse(text.substr(begin, end - begin));
      statuses_[{line.at("id").get<std::string>(), line.at("args").get<std::vector<std::string>>()}] =
          line.at("status").get<int>();
    } catch (const nlohmann::json::exception&) {
      throw InputError(path_, number,
                       "it is no result of a batch; give --results another file, or remove this one");
    }
    begin = end + 1;
  }
}

int ResultsFile::status_of(const Job& job) const {
  const auto found = statuses_.find({job.id, job.arguments});
  return found == statuses_.end() ? -1 : found->second;
}

void ResultsFile::append(const Job& job, int status, const std::string& line) {
  const std::lock_guard lock(mutex_);
  const std::string text = line + "\n";
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t written = write(file_, text.data() + done, text.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(path_, std::strerror(errno));
    done += static_cast<std::size_t>(written);
  }
  if (fdatasync(file_) != 0 && errno != EINVAL) fail(path_, std::strerror(errno));
  statuses_[{job.id, job.arguments}] = status;
}

}  // namespace tetwright
