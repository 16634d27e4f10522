// SPDX-License-Identifier: Apache-2.0
#include "tools/bricks/brick_scratch.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "common/message_text.h"
#include "tetwright/error.h"
#include "tetwright/files.h"

namespace tetwright {

namespace {

namespace fs = std::filesystem;

constexpr const char* job_file = "tetwright-job.json";
constexpr const char* brick_prefix = "brick-";
constexpr const char* brick_suffix = ".tetwright";
/// Begin and end the names of temporary files of OutputFiles.
constexpr const char *temporary_prefix = ".tetwright-", *temporary_suffix = ".tmp";

bool is_brick(const std::string& name) {
  return name.starts_with(brick_prefix) && name.ends_with(brick_suffix);
}

/// Checks that a job of a folder is this one.
void check_job(const fs::path& path, const nlohmann::ordered_json& job) {
  const std::string file = path.string();
  const auto there = nlohmann::ordered_json::parse(read_whole_file(file), nullptr, false);
  const std::string remedy = "give --scratch another folder, or delete this one";
  if (!there.is_object()) throw UsageError(file + ": this is no description of a job; " + remedy);
  for (const auto& [name, value] : job.items())
    if (const auto found = there.find(name); found == there.end() || *found != value)
      throw UsageError(file + ": the bricks are those of another job: " + printable(name) + " is " +
                       printable(found == there.end() ? "missing" : found->dump()) + ", here " +
                       printable(value.dump()) + "; " + remedy);
}

}  // namespace

BrickScratch::BrickScratch(std::string folder, const BrickJob& job) : folder_(std::move(folder)) {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error || !fs::is_directory(folder_))
    throw OutputError(folder_ + ": cannot make this folder: " +
                      (error ? error.message() : "a file has that name") + "; give --scratch another one");
  nlohmann::ordered_json described;
  for (const auto& [name, value] : job) described[name] = value;
  const fs::path path = fs::path(folder_) / job_file;
  // The folder itself is locked, as files are replaced.
  lock_ = open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (lock_ < 0) throw OutputError(folder_ + ": " + std::strerror(errno));
  try {
    if (flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
      throw UsageError(folder_ +
                       ": another process works on these bricks; wait until it ends, or give "
                       "--scratch another folder");
    // Left by processes that were killed: no other one works here.
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_))
      if (const std::string name = entry.path().filename().string();
          name.starts_with(temporary_prefix) && name.ends_with(temporary_suffix))
        fs::remove(entry.path(), error);
    if (fs::exists(path))
      check_job(path, described);
    else if (used_bytes() > 0)
      throw UsageError(folder_ + ": there are bricks of an unknown job, without " + job_file +
                       "; give --scratch another folder, or delete this one");
    else
      write_file_atomically(path.string(), described.dump(1) + "\n");
  } catch (...) {
    close(lock_);
    throw;
  }
}

BrickScratch::~BrickScratch() { close(lock_); }

std::string BrickScratch::file(std::size_t brick) const {
  return (fs::path(folder_) / (brick_prefix + std::to_string(brick) + brick_suffix)).string();
}

bool BrickScratch::has(std::size_t brick) const {
  std::error_code error;
  return fs::exists(file(brick), error);
}

void BrickScratch::write(std::size_t brick, const std::string& bytes) const {
  write_file_atomically(file(brick), bytes);
}

std::string BrickScratch::read(std::size_t brick) const { return read_whole_file(file(brick)); }

double BrickScratch::free_bytes() const {
  std::error_code error;
  const fs::space_info space = fs::space(folder_, error);
  return error ? 0 : static_cast<double>(space.available);
}

double BrickScratch::used_bytes() const {
  double bytes = 0;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_, error))
    if (is_brick(entry.path().filename().string())) {
      const std::uintmax_t size = entry.file_size(error);
      if (!error) bytes += static_cast<double>(size);
    }
  return bytes;
}

void BrickScratch::remove() const noexcept {
  try {
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_))
      if (is_brick(entry.path().filename().string())) fs::remove(entry.path(), error);
    // Last: bricks without their job would be those of any job.
    fs::remove(fs::path(folder_) / job_file, error);
    fs::remove(folder_, error);
  } catch (const std::exception&) {
    return;
  }
}

}  // namespace tetwright
