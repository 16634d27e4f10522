// SPDX-License-Identifier: Apache-2.0
#include "tools/batch/child_process.h"

#include <gtest/gtest.h>
#include <pthread.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <thread>

namespace tetwright::child_process_test {
namespace {

TEST(ChildProcess, EndsWithTheStatusOfItsWork) {
  const ProcessEnd end = run_in_child_process([] { return 7; });
  EXPECT_EQ(end.status, 7);
  EXPECT_EQ(end.signal, 0);
  EXPECT_NE(end.id, getpid());
}

TEST(ChildProcess, DiesAlone) {
  const ProcessEnd end = run_in_child_process([] { return raise(SIGKILL); });
  EXPECT_EQ(end.signal, SIGKILL);
}

TEST(ChildProcess, IsWaitedForAlsoWhereChildrenAreIgnored) {
  const auto before = std::signal(SIGCHLD, SIG_IGN);
  EXPECT_EQ(run_in_child_process([] { return 7; }).status, 7);
  std::signal(SIGCHLD, before);
}

TEST(ChildProcess, GetsTheSignalsOfItsParent) {
  // The child's own handler ends it; the parent continues.
  struct sigaction before {
  }, ending{};
  ending.sa_handler = [](int) { _exit(130); };
  sigaction(SIGTERM, &ending, &before);
  const ProcessEnd end = run_in_child_process([] {
    kill(getppid(), SIGTERM);
    for (;;) pause();
    return 0;
  });
  sigaction(SIGTERM, &before, nullptr);
  EXPECT_EQ(end.status, 130);
}

TEST(ChildProcess, GetsASignalThatAnotherThreadReceivesBeforeForkReturns) {
  struct sigaction before {
  }, ending{};
  ending.sa_handler = [](int) { _exit(130); };
  sigaction(SIGTERM, &ending, &before);
  static std::atomic<bool> waits = true;
  pthread_atfork(
      nullptr,
      [] {
        if (waits) std::this_thread::sleep_for(std::chrono::milliseconds(50));
      },
      nullptr);
  // This thread blocks no signal, so the system delivers to it those that the other one blocks.
  std::atomic<bool> done = false;
  std::thread another([&] {
    while (!done) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  });
  const ProcessEnd end = run_in_child_process([] {
    kill(getppid(), SIGTERM);
    for (;;) pause();
    return 0;
  });
  waits = false;
  done = true;
  another.join();
  sigaction(SIGTERM, &before, nullptr);
  EXPECT_EQ(end.status, 130);
}

TEST(ChildProcess, ASignalThatFindsItDyingIsNotLost) {
  struct sigaction before {
  }, noting{};
  static volatile std::sig_atomic_t seen = 0;
  noting.sa_handler = [](int) { seen = 1; };
  sigaction(SIGTERM, &noting, &before);
  const ProcessEnd end = run_in_child_process([] {
    sigset_t term;
    sigemptyset(&term);
    sigaddset(&term, SIGTERM);
    sigprocmask(SIG_BLOCK, &term, nullptr);  // the signal has no effect in this process
    kill(getppid(), SIGTERM);
    return raise(SIGKILL);
  });
  sigaction(SIGTERM, &before, nullptr);
  EXPECT_EQ(end.signal, SIGKILL);
  EXPECT_EQ(seen, 1);
}

TEST(JobStates, AreSharedWithTheChild) {
  JobStates states(3);
  EXPECT_EQ(states[1], JobState::waiting);
  run_in_child_process([&] {
    states.begin(1);
    states.set(2, JobState::ended);
    return 0;
  });
  EXPECT_EQ(states[0], JobState::waiting);
  EXPECT_EQ(states[1], JobState::running);
  EXPECT_EQ(states[2], JobState::ended);
  EXPECT_GE(states.seconds(1), 0);
  EXPECT_LT(states.seconds(1), 60);
}

}  // namespace
}  // namespace tetwright::child_process_test
