// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "tests/tools/program.h"

extern char** environ;

namespace tetwright {

inline void wait_a_moment() { std::this_thread::sleep_for(std::chrono::milliseconds(1)); }

/// A running program that the test can observe and send signals to.
class Process {
 public:
  Process(const std::vector<std::string>& arguments, const std::string& err) {
    std::vector<std::string> words{program()};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files, 1, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&files, 2, err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    EXPECT_EQ(posix_spawn(&id_, argv[0], &files, nullptr, argv.data(), environ), 0);
    posix_spawn_file_actions_destroy(&files);
  }
  ~Process() {
    if (!status_) {
      kill(id_, SIGKILL);
      (void)wait();
    }
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void send(int signal) const { kill(id_, signal); }
  /// Its child process, of which there is at most one; 0 if there is none.
  pid_t child() const {
    std::ifstream in("/proc/" + std::to_string(id_) + "/task/" + std::to_string(id_) + "/children");
    pid_t id = 0;
    in >> id;
    return id;
  }

  /// A line of /proc/ID/status, without its name; empty if the process has ended.
  std::string state(const std::string& name) const {
    std::ifstream in("/proc/" + std::to_string(id_) + "/status");
    for (std::string line; std::getline(in, line);)
      if (line.starts_with(name + ":")) return line.substr(name.size() + 1);
    return "";
  }
  /// True once main() has installed the handlers.
  bool handles_signals() const {
    const std::string caught = state("SigCgt");
    if (caught.empty()) return false;
    const unsigned long long set = std::stoull(caught, nullptr, 16);
    return (set >> (SIGINT - 1) & 1) != 0 && (set >> (SIGTERM - 1) & 1) != 0;
  }
  void wait_for_main() {
    while (!handles_signals() && !ended()) wait_a_moment();
  }
  bool ended() {
    if (status_) return true;
    int code = 0;
    if (waitpid(id_, &code, WNOHANG) != id_) return false;
    keep(code);
    return true;
  }
  int wait() {
    int code = 0;
    if (!status_ && waitpid(id_, &code, 0) == id_) keep(code);
    return status_.value_or(-1);
  }
  /// Stops the process and waits until it is stopped.
  /// \return false if it ended before
  bool stop() {
    send(SIGSTOP);
    while (!ended()) {
      if (state("State").find('T') != std::string::npos) return true;
      wait_a_moment();
    }
    return false;
  }

 private:
  void keep(int code) { status_ = WIFEXITED(code) ? WEXITSTATUS(code) : 1000 + WTERMSIG(code); }

  pid_t id_ = 0;
  std::optional<int> status_;
};

}  // namespace tetwright
