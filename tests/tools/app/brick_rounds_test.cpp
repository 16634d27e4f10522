// SPDX-License-Identifier: Apache-2.0

// Tests --brick-rounds through the program.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "tests/tools/app/brick_calls.h"

namespace tetwright::bricks_test {
namespace {

/// Calls for the same volume in several rounds.
class BrickRounds : public Bricks {
 protected:
  /// A call with this many rounds.
  std::string call(const std::string& rounds, const std::string& mesh, const std::string& more) const {
    return line(words(mesh)) + " --brick-rounds " + rounds + " " + more;
  }
  std::string in_scratch(const std::string& mesh) const {
    return call("2", mesh, "--threads 1 --scratch " + path("scratch"));
  }
  /// Files of the second round.
  std::vector<std::string> second_round() const {
    std::vector<std::string> files;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(path("scratch"), error))
      if (const std::string name = entry.path().filename().string();
          name.starts_with("brick-") && name.find("-round-2") != std::string::npos)
        files.push_back(entry.path().string());
    std::sort(files.begin(), files.end());
    return files;
  }
  /// Kills the job when so many bricks of the second round are finished.
  void kill_in_second_round(std::size_t count) const {
    std::vector<std::string> words = words_with_scratch("killed.vtu");
    words.insert(words.end(), {"--brick-rounds", "2"});
    for (int attempt = 0; attempt < 20; ++attempt) {
      Process process(words, path("err"));
      while (second_round().size() < count && !process.ended()) wait_a_moment();
      process.send(SIGKILL);
      if (process.wait() == 1000 + SIGKILL && second_round().size() >= count) return;
    }
    FAIL() << "never killed in time: " << contents(path("err"));
  }
};

TEST_F(BrickRounds, GiveTheSameBytesByAnyMeans) {
  const std::string once = expected();
  EXPECT_EQ(bricks().at("rounds"), 1);
  const double coarse_tets = bricks().at("coarse_tets");
  const nlohmann::json dense = read_json(path("s.json")).at("dense");
  ASSERT_EQ(run(call("1", "one.vtu", "--threads 1")).status, 0);
  EXPECT_TRUE(contents(path("one.vtu")) == once);
  for (const std::string rounds : {"2", "3"}) {
    const Answer memory = run(call(rounds, "a.vtu", "--threads 1"));
    ASSERT_EQ(memory.status, 0) << memory.err;
    EXPECT_NE(memory.out.find("(--bricks 32), in " + rounds + " rounds"), std::string::npos) << memory.out;
    const std::string mesh = contents(path("a.vtu"));
    EXPECT_FALSE(mesh == once);
    EXPECT_EQ(bricks().at("rounds"), std::stoi(rounds));
    EXPECT_LT(bricks().at("coarse_tets"), 0.8 * coarse_tets);
    nlohmann::json again = read_json(path("s.json")).at("dense"), first = dense;
    for (nlohmann::json* d : {&again, &first}) d->erase("bricks");
    EXPECT_EQ(differences(first, again), std::vector<std::string>());
    ASSERT_EQ(run(call(rounds, "b.vtu", "--threads 3")).status, 0);
    EXPECT_TRUE(contents(path("b.vtu")) == mesh);
    ASSERT_EQ(run(call(rounds, "c.vtu", "--threads 2 --scratch " + path("scratch"))).status, 0);
    EXPECT_TRUE(contents(path("c.vtu")) == mesh);
    EXPECT_FALSE(std::filesystem::exists(path("scratch")));
    EXPECT_EQ(run("check " + path("a.vtu") + " --quiet").status, 0);
  }
}

TEST_F(BrickRounds, AKilledRunGoesOn) {
  ASSERT_EQ(run(call("2", "expected.vtu", "--threads 1")).status, 0);
  const std::string mesh = contents(path("expected.vtu"));
  ASSERT_NO_FATAL_FAILURE(kill_in_second_round(2));
  // One brick is damaged, and made again.
  const std::vector<std::string> files = second_round();
  put(files.front(), contents(files.front()).substr(0, 100));
  // The folder decides about the rounds as well as the bricks.
  std::string resumed = line(words_with_scratch("resumed.vtu"));
  resumed.replace(resumed.find("--bricks 32"), 11, "--bricks auto");
  const Answer a = run(resumed);
  ASSERT_EQ(a.status, 0) << a.err;
  EXPECT_TRUE(contents(path("resumed.vtu")) == mesh);
  EXPECT_EQ(bricks().at("rounds"), 2);
  EXPECT_EQ(bricks().at("resumed"), brick_count + files.size() - 1);
  EXPECT_FALSE(std::filesystem::exists(path("scratch")));
}

TEST_F(BrickRounds, OtherRoundsAreAnotherJob) {
  ASSERT_NO_FATAL_FAILURE(kill_in_second_round(1));
  expect_refused(call("3", "a.vtu", "--quiet --scratch " + path("scratch")), 2,
                 {"scratch", "another job", "--brick-rounds is \"2\", here \"3\""});
}

TEST_F(BrickRounds, WrongCallsAreStatusTwo) {
  for (const std::string rounds : {"0", "4", "two", "''", "1.5"})
    expect_refused(call(rounds, "a.vtu", "--quiet"), 2, {"--brick-rounds"});
  expect_refused(
      "prepare " + path("long.nrrd") + " --target-tets 900 --bricks off --brick-rounds 2 -o " + path("a.vtu"),
      2, {"--brick-rounds is for bricks", "--bricks off"});
  put(path("body.off"), tetrahedron_off);
  expect_refused("prepare " + path("body.off") + " --target-tets 100 --brick-rounds 2 -o " + path("a.vtu"), 2,
                 {"--brick-rounds", "segmented volumes"});
}

// The memory suffices for the bricks, but not for all of them coarsened once.
TEST_F(BrickRounds, FollowFromTheMemory) {
  write_label_volume(std::get<LabelVolume>(make_sample("foam")), path("foam.nrrd"));
  const auto announced = [&](const std::string& limit) {
    Process process(
        {"prepare", path("foam.nrrd"), "--target-tets", "100000", "--voxel-size", "1", "--bricks", "32",
         "--threads", "1", "--memory-limit", limit, "--scratch", path("scratch"), "-o", path("a.vtu")},
        path("err"));
    while (contents(path("err")).find(" GB in ") == std::string::npos && !process.ended()) wait_a_moment();
    process.send(SIGKILL);
    process.wait();
    std::filesystem::remove_all(path("scratch"));
    return contents(path("err"));
  };
  const std::string enough = announced("8"), less = announced("0.19");
  EXPECT_NE(enough.find("bricks of 32 cells need about"), std::string::npos) << enough;
  EXPECT_NE(less.find("bricks of 32 cells in 2 rounds need about"), std::string::npos) << less;
}

}  // namespace
}  // namespace tetwright::bricks_test
