// SPDX-License-Identifier: Apache-2.0
#include "tools/app/log_file.h"

#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <memory>
#include <mutex>

#include "common/message_text.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
std::unique_ptr<std::FILE, CloseFile> log_stream;
std::mutex log_mutex;

/// Current time as "2026-01-31T12:34:56.789Z".
std::string utc_now() {
  const auto now = std::chrono::system_clock::now();
  const std::time_t seconds = std::chrono::system_clock::to_time_t(now);
  const auto since_epoch = std::chrono::duration_cast<std::chrono::milliseconds>(now.time_since_epoch());
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  char date[24], text[32];
  std::strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%S", &utc);
  std::snprintf(text, sizeof text, "%s.%03dZ", date, static_cast<int>(since_epoch.count() % 1000));
  return text;
}

}  // namespace

void open_log(const std::string& path) {
  const std::lock_guard lock(log_mutex);
  log_stream.reset(std::fopen(path.c_str(), "ae"));
  if (!log_stream)
    throw OutputError("--log-file " + path + ": " + std::strerror(errno) +
                      "; give a file in a folder that can be written");
}

void log_line(const std::string& text) {
  const std::lock_guard lock(log_mutex);
  if (!log_stream) return;
  std::fprintf(log_stream.get(), "%s %d %s\n", utc_now().c_str(), static_cast<int>(getpid()),
               printable(text).c_str());
  std::fflush(log_stream.get());
}

}  // namespace tetwright
