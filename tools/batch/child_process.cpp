// SPDX-License-Identifier: Apache-2.0
#include "tools/batch/child_process.h"

#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <new>
#include <string>

#include "tetwright/error.h"

namespace tetwright {

namespace {

constexpr std::array<int, 3> handed_on{SIGHUP, SIGINT, SIGTERM};

std::atomic<pid_t> child{0};
std::atomic<int> last_signal{0};

/// Async-signal-safe.
void hand_on(int signal) {
  last_signal = signal;
  if (const pid_t id = child) kill(id, signal);
}

/// During its lifetime, signals are forwarded to the child. The previous handling is then restored.
class SignalsOfChild {
 public:
  /// Before the child is started: any thread of this process may receive its signal, however early.
  SignalsOfChild() {
    sigset_t all;
    sigemptyset(&all);
    for (const int signal : handed_on) sigaddset(&all, signal);
    // The child must not receive any before it has restored the handling.
    sigprocmask(SIG_BLOCK, &all, &mask_before_);
    struct sigaction action {};
    action.sa_handler = hand_on;
    for (std::size_t i = 0; i < handed_on.size(); ++i) {
      sigaction(handed_on[i], nullptr, &before_[i]);
      if (before_[i].sa_handler != SIG_IGN) sigaction(handed_on[i], &action, nullptr);
    }
  }
  ~SignalsOfChild() {
    restore();
    child = 0;
  }
  SignalsOfChild(const SignalsOfChild&) = delete;
  SignalsOfChild& operator=(const SignalsOfChild&) = delete;

  void hand_on_to(pid_t id) {
    child = id;
    // One that came before the child's number was known.
    if (const int signal = last_signal) kill(id, signal);
    sigprocmask(SIG_SETMASK, &mask_before_, nullptr);
  }
  /// Restores the handling and the mask, in the child before its work.
  void restore() const {
    for (std::size_t i = 0; i < handed_on.size(); ++i) sigaction(handed_on[i], &before_[i], nullptr);
    sigprocmask(SIG_SETMASK, &mask_before_, nullptr);
  }

 private:
  sigset_t mask_before_{};
  std::array<struct sigaction, handed_on.size()> before_{};
};

}  // namespace

JobStates::JobStates(std::size_t count) : count_(count) {
  void* memory = mmap(nullptr, std::max<std::size_t>(1, count * sizeof(Entry)), PROT_READ | PROT_WRITE,
                      MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw OutputError("not enough memory for the list of jobs; free some");
  entries_ = static_cast<Entry*>(memory);
  for (std::size_t i = 0; i < count; ++i) new (entries_ + i) Entry{JobState::waiting, 0};
}

JobStates::~JobStates() { munmap(entries_, std::max<std::size_t>(1, count_ * sizeof(Entry))); }

void JobStates::begin(std::size_t job) {
  entries_[job].begun = Clock::now().time_since_epoch().count();
  entries_[job].state = JobState::running;
}

double JobStates::seconds(std::size_t job) const {
  return std::chrono::duration<double>(Clock::now().time_since_epoch() - Clock::duration(entries_[job].begun))
      .count();
}

namespace {

ProcessEnd run_and_wait(const std::function<int()>& work) {
  SignalsOfChild signals;
  // If the parent process ignores SIGCHLD, the system does not report how a child ended.
  std::signal(SIGCHLD, SIG_DFL);
  [[maybe_unused]] const pid_t parent = getpid();
  const pid_t id = fork();
  if (id < 0)
    throw OutputError(std::string("cannot start a process for the jobs: ") + std::strerror(errno) +
                      "; free some memory or processes");
  if (id == 0) {
#ifdef __linux__
    // The parent may have ended before the call.
    if (prctl(PR_SET_PDEATHSIG, SIGKILL) == 0 && getppid() != parent) _exit(0);
#endif
    signals.restore();
    const int status = work();
    std::fflush(nullptr);
    _exit(status);
  }
  signals.hand_on_to(id);
  int code = 0;
  while (waitpid(id, &code, 0) < 0)
    if (errno != EINTR)
      throw OutputError(std::string("cannot wait for the process of the jobs: ") + std::strerror(errno));
  if (WIFSIGNALED(code)) return {id, 0, WTERMSIG(code)};
  return {id, WEXITSTATUS(code), 0};
}

}  // namespace

ProcessEnd run_in_child_process(const std::function<int()>& work) {
  std::fflush(nullptr);  // otherwise both processes would write the buffered output
  last_signal = 0;
  const ProcessEnd end = run_and_wait(work);
  if (const int signal = last_signal; signal != 0 && end.signal != 0 && end.signal != signal)
    std::raise(signal);
  return end;
}

}  // namespace tetwright
