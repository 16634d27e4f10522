// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/tools/process.h"
#include "tests/tools/program.h"

namespace tetwright::batch_test {
namespace {

class Batch : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(run("sample cube -o " + (f / "c.ply")).status, 0); }
  std::string job(const std::string& id, const std::string& tets, const std::string& input = "c.ply") {
    return nlohmann::json{
               {"id", id},
               {"args",
                {"prepare", f / input, "--resolution", "8", "--target-tets", tets, "-o", f / (id + ".vtu")}}}
               .dump() +
           "\n";
  }
  /// Lines of the results by id; each id must occur once.
  std::map<std::string, nlohmann::json> results() {
    std::map<std::string, nlohmann::json> lines;
    std::istringstream in(contents(f / "jobs.results.jsonl"));
    for (std::string line; std::getline(in, line);) {
      const auto j = nlohmann::json::parse(line);
      EXPECT_TRUE(lines.emplace(j["id"], j).second) << line;
    }
    return lines;
  }
  Answer batch(const std::string& options = "") { return run("batch " + (f / "jobs.jsonl") + " " + options); }

  TemporaryFolder f;
};

TEST_F(Batch, EachJobHasItsStatusAndStatistics) {
  put(f / "jobs.jsonl", job("few", "300") + "\n" + job("more", "600") + job("lost", "300", "nowhere.ply") +
                            R"({"id": "typo", "args": ["prepare", "--frobnicate"]})" + "\n" +
                            R"({"args": ["check", ")" + (f / "few2.vtu") + R"("]})" + "\n");
  const Answer a = batch("--threads 2");
  EXPECT_EQ(a.status, 1);
  auto lines = results();
  ASSERT_EQ(lines.size(), 5u);
  EXPECT_EQ(lines["few"]["status"], 0);
  EXPECT_NEAR(lines["few"]["stats"]["result"]["tets"].get<double>(), 300, 3);
  EXPECT_NEAR(lines["more"]["stats"]["result"]["tets"].get<double>(), 600, 6);
  EXPECT_EQ(lines["lost"]["status"], 3);
  EXPECT_NE(lines["lost"]["messages"][0].get<std::string>().find("nowhere.ply"), std::string::npos);
  EXPECT_EQ(lines["typo"]["status"], 2);
  EXPECT_EQ(lines["6"]["status"], 3);  // the id is its line number
  EXPECT_NE(a.err.find("3 of 5 jobs"), std::string::npos) << a.err;
  // Gives the same bytes as a separate run.
  ASSERT_EQ(
      run("prepare " + (f / "c.ply") + " --resolution 8 --target-tets 300 -o " + (f / "alone.vtu")).status,
      0);
  EXPECT_EQ(contents(f / "few.vtu"), contents(f / "alone.vtu"));
}

TEST_F(Batch, GoesOnWhereItEnded) {
  put(f / "jobs.jsonl", job("a", "300") + job("b", "300"));
  ASSERT_EQ(batch().status, 0);
  const std::string first = contents(f / "jobs.results.jsonl");
  put(f / "a.vtu", "touched");
  // Part of a line, as left by a kill.
  put(f / "jobs.results.jsonl", first + R"({"args":["prep)");
  put(f / "jobs.jsonl", job("a", "300") + job("b", "300") + job("c", "400"));
  ASSERT_EQ(batch().status, 0);
  EXPECT_EQ(contents(f / "a.vtu"), "touched");
  EXPECT_EQ(contents(f / "jobs.results.jsonl").rfind(first, 0), 0u);
  EXPECT_EQ(results().size(), 3u);
  // A complete line without its line end, as editors may leave it, also counts.
  const std::string whole = contents(f / "jobs.results.jsonl");
  put(f / "jobs.results.jsonl", whole.substr(0, whole.size() - 1));
  ASSERT_EQ(batch().status, 0);
  EXPECT_EQ(contents(f / "jobs.results.jsonl"), whole);
  // Different arguments make it a different job.
  put(f / "jobs.jsonl", job("a", "500"));
  ASSERT_EQ(batch().status, 0);
  EXPECT_NE(contents(f / "a.vtu"), "touched");
}

TEST_F(Batch, RetriesWhatFailed) {
  put(f / "jobs.jsonl", job("a", "300", "later.ply"));
  EXPECT_EQ(batch().status, 1);
  ASSERT_EQ(run("sample cube -o " + (f / "later.ply")).status, 0);
  EXPECT_EQ(batch().status, 1);  // finished with an input error
  EXPECT_EQ(batch("--retry").status, 0);
}

TEST_F(Batch, RefusesWhatIsNoBatch) {
  const std::string jobs = f / "jobs.jsonl";
  const auto refused = [&](const std::string& text, const std::vector<std::string>& said) {
    put(jobs, text);
    expect_refused("batch " + jobs, 3, said);
    EXPECT_FALSE(f.has("jobs.results.jsonl"));
  };
  refused("", {"no job"});
  refused(job("a", "300") + "{\"id\": 3\n", {"line 2", "column"});
  refused("[1]\n", {"line 1", "not a JSON object"});
  refused(R"({"id": "a", "arguments": []})", {"line 1", "'arguments'"});
  refused(R"({"id": [1], "args": ["check", "x.vtu"]})", {"line 1", "\"id\""});
  refused(R"({"args": ["check", ["x.vtu"]]})", {"line 1", "neither text nor a number"});
  refused(
      R"({"id": )" + std::string(200000, '[') + std::string(200000, ']') + R"(, "args": ["check", "x.vtu"]})",
      {"line 1", "\"id\""});
  refused(R"({"args": ["check", 1e400]})", {"line 1", "number"});
  refused(R"({"args": ["check", "x.vtu\u0000.msh"]})", {"line 1", "NUL"});
  refused(job("a", "300") + job("a", "400"), {"line 2", "'a'", "line 1"});
  refused(job("a", "300") + R"({"args": ["improve", "x.vtu", "-o", ")" + (f / ".") + R"(/a.vtu"]})",
          {"a.vtu", "give each its own"});
  refused(job("a", "300") + R"({"args": ["improve", ")" + (f / "a.vtu") + R"(", "-o", "b.vtu"]})",
          {"reads", "'a' writes"});
  refused(job("a", "300") + R"({"args": ["check", "x.vtu", "--before", ")" + (f / "a.vtu") + R"("]})",
          {"reads", "'a' writes"});
  // Two jobs write the same file, which does not exist yet; one of them through a link.
  std::filesystem::create_symlink("real.vtu", f / "link.vtu");
  refused(R"({"args": ["improve", "x.vtu", "-o", ")" + (f / "link.vtu") + R"("]})" + "\n" +
              R"({"args": ["improve", "x.vtu", "-o", ")" + (f / "real.vtu") + R"("]})",
          {"real.vtu", "give each its own"});
  put(jobs, R"({"args": ["check", "x.vtu", "--stats", ")" + (f / "r.json") + R"("]})");
  expect_refused("batch " + jobs + " --results " + (f / "r.json"), 3, {"r.json", "a file of the batch"});
  put(jobs, job("a", "300"));
  expect_refused("batch - --results " + jobs, 2, {"cannot be -"});
  expect_refused("batch " + jobs + " --results " + jobs, 2, {"also an input"});
  expect_refused("batch " + jobs + " --stats " + (f / "s.json"), 2, {"--stats"});
  // A file with other contents is not written to.
  put(f / "jobs.results.jsonl", "my notes\n");
  expect_refused("batch " + jobs, 3, {"jobs.results.jsonl", "line 1"});
  EXPECT_EQ(contents(f / "jobs.results.jsonl"), "my notes\n");
  for (const std::string text : {"my notes", "{\"id\": 7}", "[]"}) {
    put(f / "jobs.results.jsonl", text);
    expect_refused("batch " + jobs, 3, {"jobs.results.jsonl", "line 1"});
    EXPECT_EQ(contents(f / "jobs.results.jsonl"), text);
  }
}

/// Waits until a process reads the pipe, and returns the end to write to.
int open_when_read(const std::string& pipe, Process& process) {
  int file = -1;
  while ((file = open(pipe.c_str(), O_WRONLY | O_NONBLOCK)) < 0 && !process.ended()) wait_a_moment();
  return file;
}

TEST_F(Batch, AJobThatCrashesEndsAlone) {
  for (const int signal : {SIGABRT, SIGKILL}) {
    const std::string pipe = f / ("pipe" + std::to_string(signal) + ".ply");
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    put(f / "jobs.jsonl",
        job("a", "300") + job("crash", "300", pipe.substr(pipe.rfind('/') + 1)) + job("b", "300"));
    std::filesystem::remove(f / "jobs.results.jsonl");
    Process process({"batch", f / "jobs.jsonl", "--jobs", "1"}, f / "err");
    const int end = open_when_read(pipe, process);
    ASSERT_GE(end, 0) << contents(f / "err");
    ASSERT_GT(process.child(), 0);
    // A temporary file, as left by a process killed while writing.
    const std::string left = f / (".tetwright-" + std::to_string(process.child()) + "-7.tmp");
    put(left, "part of a mesh");
    kill(process.child(), signal);
    EXPECT_EQ(process.wait(), 1);
    close(end);
    EXPECT_FALSE(std::filesystem::exists(left));
    auto lines = results();
    EXPECT_EQ(lines.size(), 3u);
    EXPECT_EQ(lines["a"]["status"], 0);
    EXPECT_EQ(lines["b"]["status"], 0);
    EXPECT_EQ(lines["crash"]["status"], signal == SIGKILL ? 5 : 70);
    const std::string said = lines["crash"]["messages"][0];
    EXPECT_NE(said.find("was killed by signal " + std::to_string(signal)), std::string::npos) << said;
    EXPECT_NE(contents(f / "err").find(said), std::string::npos);
    EXPECT_GT(lines["crash"]["seconds"], 0);
  }
}

TEST_F(Batch, WhatRanBesideACrashIsDoneAgain) {
  const std::vector<std::string> pipes{f / "p.ply", f / "q.ply"};
  for (const std::string& pipe : pipes) ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  put(f / "jobs.jsonl", job("p", "300", "p.ply") + job("q", "300", "q.ply") + job("a", "300"));
  Process process({"batch", f / "jobs.jsonl", "--jobs", "2"}, f / "err");
  std::vector<int> ends;
  for (const std::string& pipe : pipes) ends.push_back(open_when_read(pipe, process));
  const pid_t first = process.child();
  ASSERT_GT(first, 0);
  kill(first, SIGKILL);
  for (const int end : ends) close(end);
  // Until it has ended it may still read.
  while ((process.child() == first || process.child() == 0) && !process.ended()) wait_a_moment();
  // Each alone: the second pipe is read once the first job has ended.
  for (const std::string& pipe : pipes) close(open_when_read(pipe, process));
  EXPECT_EQ(process.wait(), 1) << contents(f / "err");
  auto lines = results();
  EXPECT_EQ(lines.size(), 3u);
  for (const char* id : {"p", "q"}) EXPECT_EQ(lines[id]["status"], 3) << lines[id];  // an empty file
  EXPECT_EQ(lines["a"]["status"], 0);
}

TEST_F(Batch, ASecondCrashLeavesTheOthersTheirTurn) {
  std::vector<std::string> pipes;
  std::string jobs;
  for (const std::string id : {"p", "q", "r"}) {
    pipes.push_back(f / (id + ".ply"));
    ASSERT_EQ(mkfifo(pipes.back().c_str(), 0600), 0);
    jobs += job(id, "300", id + ".ply");
  }
  put(f / "jobs.jsonl", jobs);
  Process process({"batch", f / "jobs.jsonl", "--jobs", "3", "--threads", "3"}, f / "err");
  const auto kill_child = [&](const std::vector<int>& ends) {
    const pid_t child = process.child();
    ASSERT_GT(child, 0);
    kill(child, SIGKILL);
    for (const int end : ends) close(end);
    while ((process.child() == child || process.child() == 0) && !process.ended()) wait_a_moment();
  };
  std::vector<int> ends;
  for (const std::string& pipe : pipes) ends.push_back(open_when_read(pipe, process));
  kill_child(ends);
  kill_child({open_when_read(pipes[0], process)});
  // The two remaining jobs must not run concurrently.
  const int q = open_when_read(pipes[1], process);
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_LT(open(pipes[2].c_str(), O_WRONLY | O_NONBLOCK), 0);
  close(q);
  close(open_when_read(pipes[2], process));
  EXPECT_EQ(process.wait(), 1);
  auto lines = results();
  EXPECT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines["p"]["status"], 5);
  for (const char* id : {"q", "r"}) EXPECT_EQ(lines[id]["status"], 3) << lines[id];
}

TEST_F(Batch, EndsWithTheProcessThatWasStarted) {
  const std::string pipe = f / "p.ply";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  put(f / "jobs.jsonl", job("a", "300") + job("p", "300", "p.ply"));
  for (const int signal : {SIGTERM, SIGKILL}) {
    Process process({"batch", f / "jobs.jsonl", "--jobs", "1"}, f / "err");
    const int end = open_when_read(pipe, process);
    process.send(signal);
    EXPECT_EQ(process.wait(), signal == SIGKILL ? 1000 + SIGKILL : 130);
    // No process reads any more, although one writes.
    int reader = 0;
    for (int moments = 0; moments < 20000 && (reader = open(pipe.c_str(), O_WRONLY | O_NONBLOCK)) >= 0;
         ++moments) {
      close(reader);
      wait_a_moment();
    }
    EXPECT_LT(reader, 0);
    close(end);
    EXPECT_EQ(results().size(), 1u);
  }
}

TEST_F(Batch, JobsOfOneLibraryDoNotMeet) {
  // HDF5 shares open files of the same name between threads.
  std::string jobs;
  for (const int tets : {200, 300, 400, 500, 600, 700}) {
    const std::string name = std::to_string(tets);
    ASSERT_EQ(run("prepare " + (f / "c.ply") + " --resolution 8 --target-tets " + name + " -o " +
                  (f / ("in" + name + ".xdmf")))
                  .status,
              0);
    ASSERT_EQ(run("improve " + (f / ("in" + name + ".xdmf")) + " -o " + (f / (name + "alone.xdmf"))).status,
              0);
    jobs +=
        nlohmann::json{{"id", name},
                       {"args", {"improve", f / ("in" + name + ".xdmf"), "-o", f / (name + "batch.xdmf")}}}
            .dump() +
        "\n";
  }
  put(f / "jobs.jsonl", jobs);
  const Answer a = batch("--jobs 6 --threads 6");
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_EQ(a.err.find("HDF5"), std::string::npos) << a.err;
  for (const auto& [id, line] : results())
    EXPECT_EQ(contents(f / (id + "alone.h5")), contents(f / (id + "batch.h5"))) << id;
}

TEST_F(Batch, LimitsAreThoseOfTheJobs) {
  const std::string call =
      nlohmann::json{{"args", {"mesh", f / "c.ply", "-o", f / "o.vtu", "--time-limit", 1e-6}}}.dump();
  put(f / "jobs.jsonl", call + "\n");
  EXPECT_EQ(batch().status, 1);
  EXPECT_EQ(results()["1"]["status"], 5);
  EXPECT_NE(results()["1"]["messages"][0].get<std::string>().find("in stage '"), std::string::npos);
  EXPECT_EQ(results()["1"]["messages"][0].get<std::string>().find("in stage ''"), std::string::npos);
  // The memory is divided among concurrent jobs.
  put(f / "jobs.jsonl", job("a", "300") + job("b", "300"));
  EXPECT_EQ(batch("--memory-limit 0.05 --jobs 2 --threads 2").status, 1);
  const std::map<std::string, nlohmann::json> shares = results();
  EXPECT_EQ(shares.at("a")["status"], 5) << shares.at("a");
  EXPECT_NE(shares.at("a")["messages"][0].get<std::string>().find("are available"), std::string::npos);
}

TEST_F(Batch, HasItsResultsAlone) {
  put(f / "jobs.jsonl", job("a", "300"));
  const int other = open((f / "jobs.results.jsonl").c_str(), O_RDWR | O_CREAT, 0666);
  ASSERT_EQ(flock(other, LOCK_EX), 0);
  expect_refused("batch " + (f / "jobs.jsonl"), 5, {"another batch"});
  close(other);
  EXPECT_EQ(batch().status, 0);
}

}  // namespace
}  // namespace tetwright::batch_test
