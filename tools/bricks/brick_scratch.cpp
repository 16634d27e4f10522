// SPDX-License-Identifier: Apache-2.0
#include "tools/bricks/brick_scratch.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "common/message_text.h"
#include "tetwright/error.h"
#include "tetwright/files.h"
#include "tetwright/prepare.h"

namespace tetwright {

namespace {

namespace fs = std::filesystem;

constexpr const char* job_file = "tetwright-job.json";
constexpr const char* lock_file = "tetwright.lock";
constexpr const char* brick_prefix = "brick-";
constexpr const char* round_infix = "-round-";
constexpr const char* kept = "-kept";
constexpr const char* brick_suffix = ".tetwright";
/// Begin and end the names of temporary files of OutputFiles.
constexpr const char *temporary_prefix = ".tetwright-", *temporary_suffix = ".tmp";

bool is_brick(const std::string& name) {
  return name.starts_with(brick_prefix) && name.ends_with(brick_suffix);
}

nlohmann::ordered_json job_in(const std::string& file) {
  return nlohmann::ordered_json::parse(read_whole_file(file), nullptr, false);
}

/// Checks that a job of a folder is this one.
void check_job(const fs::path& path, const nlohmann::ordered_json& job) {
  const std::string file = path.string();
  const auto there = job_in(file);
  const std::string remedy = "give --scratch another folder, or delete this one";
  if (!there.is_object()) throw UsageError(file + ": this is no description of a job; " + remedy);
  for (const auto& [name, value] : job.items()) {
    const auto found = there.find(name);
    const bool missing = found == there.end();
    if (!missing && *found == value) continue;
    std::string message = file + ": the bricks are those of another job: ";
    message += printable(name) + " is " + printable(missing ? "missing" : found->dump());
    message += ", here " + printable(value.dump()) + "; ";
    if (!missing && name.starts_with("--")) message += "give the same to go on with them, or ";
    throw UsageError(message + remedy);
  }
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
  const std::string lock = (fs::path(folder_) / lock_file).string();
  lock_ = open(lock.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (lock_ < 0) throw OutputError(lock + ": " + std::strerror(errno));
  try {
    if (flock(lock_, LOCK_EX | LOCK_NB) != 0) {
      if (errno == EWOULDBLOCK)
        throw UsageError(folder_ +
                         ": another process works on these bricks; wait until it ends, or give "
                         "--scratch another folder");
      throw OutputError(lock + ": this file system does not lock files (" + std::strerror(errno) +
                        "); give --scratch a folder on another one");
    }
    if (fs::exists(path)) {
      check_job(path, described);
      // Left by processes that were killed: none but the one with the lock writes bricks.
      for (const fs::directory_entry& entry : fs::directory_iterator(folder_))
        if (const std::string name = entry.path().filename().string();
            name.starts_with(temporary_prefix) && name.ends_with(temporary_suffix))
          fs::remove(entry.path(), error);
    } else if (used_bytes() > 0) {
      throw UsageError(folder_ + ": there are bricks of an unknown job, without " + job_file +
                       "; give --scratch another folder, or delete this one");
    } else {
      write_file_atomically(path.string(), described.dump(1) + "\n");
    }
  } catch (...) {
    close(lock_);
    throw;
  }
}

BrickScratch::~BrickScratch() { close(lock_); }

std::string BrickScratch::path(const BrickFile& file) const {
  std::string name = brick_prefix + std::to_string(file.brick);
  if (file.round > 1) name += round_infix + std::to_string(file.round);
  if (file.kept_surface) name += kept;
  return (fs::path(folder_) / (name + brick_suffix)).string();
}

bool BrickScratch::has(const BrickFile& file) const {
  std::error_code error;
  return fs::exists(path(file), error);
}

void BrickScratch::write(const BrickFile& file, const std::string& bytes) const {
  write_file_atomically(path(file), bytes);
}

std::string BrickScratch::read(const BrickFile& file) const { return read_whole_file(path(file)); }

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
    fs::remove(fs::path(folder_) / lock_file, error);
    fs::remove(fs::canonical(folder_), error);  // not a link to it
  } catch (const std::exception&) {
    return;
  }
}

BrickDivision division_of_job(const std::string& folder) {
  const fs::path path = fs::path(folder) / job_file;
  std::error_code error;
  if (folder.empty() || !fs::exists(path, error)) return {};
  const auto job = job_in(path.string());
  const auto number = [&](const char* name, int low, int high) {
    const auto found = job.is_object() ? job.find(name) : job.end();
    if (found == job.end() || !found->is_string()) return 0;
    const std::string text = *found;
    int value = 0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value >= low && value <= high ? value : 0;
  };
  const int cells = number(bricks_option, min_brick_cells, max_brick_cells);
  if (!std::has_single_bit(static_cast<unsigned>(cells))) return {};
  return {cells, std::max(1, number(rounds_option, 1, max_brick_rounds))};
}

}  // namespace tetwright
