// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/processes.h"

#include <fcntl.h>
#include <malloc.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tetwright/error.h"
#include "tetwright/files.h"

namespace tetwright {

namespace {

std::string text_of(const nlohmann::json& json) {
  return json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// Value of an entry of /proc/self/status.
std::size_t bytes_of(const char* name) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == name) {
      std::size_t kib = 0;
      status >> kib;
      return kib * 1024;
    }
  return 0;
}

}  // namespace

nlohmann::json in_child(const std::function<nlohmann::json()>& work) {
  int ends[2];
  if (pipe(ends) != 0) throw OutputError("no pipe could be opened");
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) throw OutputError("no process could be started");
  if (child == 0) {
    close(ends[0]);
    nlohmann::json answer;
    try {
      answer = work();
    } catch (const std::exception& e) {
      answer = {{"error", e.what()}};
    }
    const std::string text = text_of(answer);
    std::size_t done = 0;
    while (done < text.size()) {
      const ssize_t n = write(ends[1], text.data() + done, text.size() - done);
      if (n <= 0) _exit(1);
      done += static_cast<std::size_t>(n);
    }
    std::fflush(nullptr);
    _exit(0);
  }
  close(ends[1]);
  std::string text;
  char buffer[65536];
  for (ssize_t n; (n = read(ends[0], buffer, sizeof buffer)) > 0;)
    text.append(buffer, static_cast<std::size_t>(n));
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  auto answer = nlohmann::json::parse(text, nullptr, false);
  if (status != 0 || answer.is_discarded())
    return {{"error", "the process ended with status " + std::to_string(status)}};
  return answer;
}

ProgramRun run_program(const std::vector<std::string>& arguments) {
  std::vector<char*> pointers;
  pointers.reserve(arguments.size() + 1);
  for (const std::string& a : arguments) pointers.push_back(const_cast<char*>(a.c_str()));
  pointers.push_back(nullptr);
  std::fflush(nullptr);
  const Stopwatch watch;
  const pid_t child = fork();
  if (child < 0) throw OutputError("no process could be started");
  if (child == 0) {
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, STDOUT_FILENO);
    execvp(pointers[0], pointers.data());
    _exit(127);
  }
  int status = 0;
  rusage usage{};
  wait4(child, &status, 0, &usage);
  ProgramRun run;
  run.seconds = watch.seconds();
  run.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  run.cpu_seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  run.peak_bytes = static_cast<std::size_t>(usage.ru_maxrss) * 1024;  // Linux reports KiB
  return run;
}

std::size_t peak_bytes_now() { return bytes_of("VmHWM:"); }
std::size_t resident_bytes_now() { return bytes_of("VmRSS:"); }

void reset_peak() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << 5;  // proc(5): resets VmHWM to the resident size
}

double ThreadStopwatch::now() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

ScratchFolder::ScratchFolder() {
  path_ = (std::filesystem::temp_directory_path() / "tetwright-benchmark-").string() + std::string(6, 'X');
  if (!mkdtemp(path_.data())) throw OutputError("no temporary folder could be made at " + path_);
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

void write_json(const nlohmann::json& json, const std::string& path) {
  if (!path.empty()) write_file_atomically(path, text_of(json) + "\n");
}

}  // namespace tetwright
