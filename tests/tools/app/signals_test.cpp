// SPDX-License-Identifier: Apache-2.0

// Tests signals at any time of a run: the status is 130, and the files that the program writes are either
// complete or unchanged. Whether a signal arrives in time is read from the state of the process, never
// inferred from a delay.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include "tests/tools/process.h"
#include "tests/tools/program.h"
#include "tetwright/io.h"

namespace tetwright::signals_test {
namespace {

constexpr int interrupted = 130;
const std::string nothing_written = "tetwright: interrupted, nothing was written\n";

std::size_t temporary_files(const std::string& folder) {
  std::size_t n = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    n += entry.path().filename().string().starts_with(".tetwright-");
  return n;
}

constexpr int ending_signals[] = {SIGINT, SIGTERM, SIGHUP};

class Signals : public ::testing::Test {
 protected:
  std::string in(const std::string& name) const { return folder_ / name; }
  std::string err() const { return contents(logs_ / "err"); }
  Process start(const std::vector<std::string>& arguments) const { return {arguments, logs_ / "err"}; }

  TemporaryFolder folder_, logs_;
};

TEST_F(Signals, BeforeTheWorkBegins) {
  ASSERT_EQ(mkfifo(in("pipe.off").c_str(), 0600), 0);
  ASSERT_EQ(mkfifo(in("pipe.msh").c_str(), 0600), 0);
  for (const int signal : ending_signals)
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"mesh", in("pipe.off"), "-o", in("out.vtu")},
          std::vector<std::string>{"check", in("pipe.msh")}}) {
      // No process writes to the pipe: the program is waiting for it or has not opened it yet.
      Process process = start(arguments);
      process.wait_for_main();
      process.send(signal);
      EXPECT_EQ(process.wait(), interrupted) << signal;
      EXPECT_EQ(err(), nothing_written);
    }
  EXPECT_EQ(folder_.entries(), 2u);
}

TEST_F(Signals, WhileAPipeIsRead) {
  ASSERT_EQ(mkfifo(in("pipe.off").c_str(), 0600), 0);
  for (const int signal : ending_signals) {
    Process process = start({"mesh", in("pipe.off"), "-o", in("out.vtu")});
    std::ofstream writer(in("pipe.off"));  // opens once the program does
    writer << "OFF\n4 4 6\n" << std::flush;
    process.send(signal);
    EXPECT_EQ(process.wait(), interrupted) << signal;
    EXPECT_EQ(err(), nothing_written);
  }
  EXPECT_EQ(folder_.entries(), 1u);
}

TEST_F(Signals, AnIgnoredHangUpStaysIgnored) {
  ASSERT_EQ(run("sample sphere -o " + in("s.off")).status, 0);
  ASSERT_EQ(mkfifo(in("pipe.off").c_str(), 0600), 0);
  std::signal(SIGHUP, SIG_IGN);  // inherited by child processes
  Process process =
      start({"mesh", in("pipe.off"), "-o", in("out.vtu"), "--resolution", "8", "--accept-changes"});
  std::signal(SIGHUP, SIG_DFL);
  process.wait_for_main();
  process.send(SIGHUP);
  std::ofstream(in("pipe.off")) << contents(in("s.off"));
  EXPECT_EQ(process.wait(), 0) << err();
}

/// Signals at times distributed over a whole run: either all files are unchanged, or all are complete.
TEST_F(Signals, AtManyMoments) {
  ASSERT_EQ(run("sample torus -o " + in("torus.off")).status, 0);
  const std::vector<std::string> call{
      "mesh",    in("torus.off"), "-o",           in("out.msh"), "--write-sdf",     in("out.vdb"),
      "--stats", in("out.json"),  "--resolution", "28",          "--accept-changes"};
  const auto begin = std::chrono::steady_clock::now();
  Process whole = start(call);
  ASSERT_EQ(whole.wait(), 0) << err();
  const auto life = std::chrono::steady_clock::now() - begin;
  const std::string mesh = contents(in("out.msh")), fields = contents(in("out.vdb"));
  ASSERT_FALSE(mesh.empty());

  constexpr int moments = 12;
  int ended_early = 0;
  for (int i = 0; i < moments; ++i) {
    for (const char* name : {"out.msh", "out.vdb", "out.json"}) put(in(name), "old");
    Process process = start(call);
    process.wait_for_main();
    std::this_thread::sleep_for(life * i / moments);
    process.send(ending_signals[i % 3]);
    const int status = process.wait();
    ASSERT_TRUE(status == interrupted || status == 0) << status << err();
    ended_early += status == interrupted && err() == nothing_written;
    if (err() == nothing_written) {
      for (const char* name : {"out.msh", "out.vdb", "out.json"}) ASSERT_EQ(contents(in(name)), "old") << i;
    } else {
      ASSERT_EQ(contents(in("out.msh")), mesh) << i;
      ASSERT_EQ(contents(in("out.vdb")), fields) << i;
      ASSERT_EQ(contents(in("out.json")).substr(0, 1), "{") << i;
    }
    ASSERT_EQ(folder_.entries(), 4u) << i;
  }
  EXPECT_GT(ended_early, 0);
}

/// The program is stopped as soon as it has begun to write, receives its signals, and continues.
TEST_F(Signals, WhileAFileIsWritten) {
  ASSERT_EQ(run("sample sphere -o " + in("s.off")).status, 0);
  for (const char* extension : {"vtu", "msh"})
    for (const int signal : ending_signals) {
      const std::string out = in(std::string("out.") + extension);
      int caught = 0;
      // The program may have finished its file before it is stopped; it is then run again.
      for (int attempt = 0; attempt < 50 && caught == 0; ++attempt) {
        put(out, "old");
        // One thread, so that the test has a processor to observe it from.
        Process process = start({"mesh", in("s.off"), "-o", out, "--resolution", "48", "--threads", "1"});
        while (temporary_files(in("")) == 0 && !process.ended()) std::this_thread::yield();
        if (process.stop()) {
          const bool writing = temporary_files(in("")) == 1;
          process.send(signal);
          process.send(signal == SIGINT ? SIGTERM : SIGINT);  // a second signal changes nothing
          process.send(SIGCONT);
          const int status = process.wait();
          EXPECT_EQ(status, interrupted) << extension << " " << signal << " " << err();
          if (err() == nothing_written) {
            EXPECT_EQ(contents(out), "old");
          }
          caught += writing && err() == nothing_written;
        }
        EXPECT_EQ(temporary_files(in("")), 0u);
      }
      EXPECT_EQ(caught, 1) << extension << " " << signal;
    }
}

}  // namespace
}  // namespace tetwright::signals_test
