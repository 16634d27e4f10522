// SPDX-License-Identifier: Apache-2.0

// Tests --bricks and --scratch through the program.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <thread>

#include "tests/tools/app/brick_calls.h"

namespace tetwright::bricks_test {
namespace {

TEST_F(Bricks, GiveTheSameBytesByAnyMeans) {
  const std::string mesh = expected();
  EXPECT_EQ(bricks().at("cells"), 32);
  EXPECT_EQ(bricks().at("count"), brick_count);
  EXPECT_EQ(bricks().at("resumed"), 0);
  EXPECT_EQ(bricks().at("scratch_bytes"), 0);
  const Answer three = run(line(words("three.vtu")) + " --threads 3");
  EXPECT_EQ(three.status, 0) << three.err;
  EXPECT_NE(three.out.find("3 bricks of 32 cells (--bricks 32): "), std::string::npos) << three.out;
  EXPECT_TRUE(contents(path("three.vtu")) == mesh);
  EXPECT_EQ(expect_resumed(mesh), 0u);
  EXPECT_GT(bricks().at("scratch_bytes"), 1000);
  const Answer check = run("check " + path("expected.vtu") + " --quiet");
  EXPECT_EQ(check.status, 0) << check.out;
}

TEST_F(Bricks, FacesOnTheBorderHaveTheNamesOfTheWhole) {
  // The volume has no outside: labels reach all of its sides.
  const auto names_with = [&](const std::string& bricks) {
    const std::string file = path("names" + bricks + ".msh");
    const Answer a = run("prepare " + path("long.nrrd") + " --target-tets 1000 --voxel-size 1 --bricks " +
                         bricks + " -o " + file);
    EXPECT_EQ(a.status, 0) << a.err;
    std::set<std::string> names;
    for (const auto& [patch, group] : read_tet_mesh(file).mesh.patch_groups) names.insert(group.name);
    return names;
  };
  const std::set<std::string> names = names_with("32");
  EXPECT_EQ(names.count("border_x_min"), 1u);          // one label
  EXPECT_EQ(names.count("label_2:border_y_min"), 1u);  // among others
  EXPECT_EQ(names, names_with("off"));
}

TEST_F(Bricks, AKilledRunGoesOn) {
  const std::string mesh = expected();
  for (std::size_t count = 1; count <= brick_count; ++count) {
    kill_after(count);
    ASSERT_TRUE(std::filesystem::exists(scratch("tetwright-job.json")));
    EXPECT_FALSE(std::filesystem::exists(path("killed.vtu")));
  }
  EXPECT_EQ(expect_resumed(mesh), brick_count);
}

TEST_F(Bricks, AnInterruptedRunSaysThatItGoesOn) {
  constexpr int interrupted = 130;
  int status = 0;
  for (int attempt = 0; attempt < 20 && status != interrupted; ++attempt)
    status = end_when([&] { return finished().size() > 0; }, SIGTERM);
  ASSERT_EQ(status, interrupted);
  EXPECT_NE(
      contents(path("err")).find("interrupted; the same call goes on from the bricks that are finished"),
      std::string::npos)
      << contents(path("err"));
}

TEST_F(Bricks, ARunKilledAtAnyMomentGoesOn) {
  const auto begin = std::chrono::steady_clock::now();
  const std::string mesh = expected();
  const auto life = std::chrono::steady_clock::now() - begin;
  for (int i = 1; i < 4; ++i) {
    const auto start = std::chrono::steady_clock::now();
    // The folder remains, so each run begins where the one before ended.
    kill_when([&] { return std::chrono::steady_clock::now() - start > life * i / 8; });
  }
  expect_resumed(mesh);
}

TEST_F(Bricks, DamagedAndLostBricksAreMadeAgain) {
  const std::string mesh = expected();
  ASSERT_NO_FATAL_FAILURE(kill_after(brick_count));
  const std::string whole = contents(brick(1)), other = contents(brick(0));
  std::string flipped = whole;
  flipped[flipped.size() / 2] ^= 1;
  // All bricks of a run are damaged in different ways.
  put(brick(0), other.substr(0, other.size() / 2));
  put(brick(1), flipped);
  std::filesystem::remove(brick(2));
  put(scratch(".tetwright-0-0.tmp"), "half a brick");
  EXPECT_EQ(expect_resumed(mesh), 0u);
  ASSERT_NO_FATAL_FAILURE(kill_after(2));
  const std::vector<std::size_t> left = finished();
  put(brick(left.front()), "");
  EXPECT_EQ(expect_resumed(mesh), left.size() - 1);
}

TEST_F(Bricks, ForeignFilesOfTheFolderStay) {
  std::filesystem::create_directory(path("scratch"));
  put(scratch("notes.txt"), "precious");
  const Answer a = run(line(words_with_scratch("a.vtu")));
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_EQ(contents(scratch("notes.txt")), "precious");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(path("scratch")), {}), 1);
}

TEST_F(Bricks, TheFolderOfAnotherJobIsRefused) {
  ASSERT_NO_FATAL_FAILURE(kill_after(1));
  const std::size_t first = finished().front();
  const std::string before = contents(brick(first));
  const std::string call = line(words_with_scratch("a.vtu")) + " --quiet";
  write_label_volume(make_volume({72, 6, 6}, [](int x, int, int) { return x < 41 ? 1 : 2; }),
                     path("other.nrrd"));
  const auto replaced = [&](const std::string& word, const std::string& by) {
    std::string other = call;
    return other.replace(other.find(word), word.size(), by);
  };
  expect_refused(replaced("--target-tets 1000", "--target-tets 1001"), 2,
                 {"scratch", "another job", "--target-tets", "1001"});
  expect_refused(replaced("long.nrrd", "other.nrrd"), 2, {"scratch", "another job"});
  expect_refused(call + " --seed 2", 2, {"scratch", "another job", "--seed"});
  expect_refused(replaced("--bricks 32", "--bricks 64"), 2, {"scratch", "another job", "--bricks"});
  expect_refused(call + " --min-voxels 200", 2, {"scratch", "another job"});  // merges labels
  put(scratch("tetwright-job.json"), "{");
  expect_refused(call, 2, {"tetwright-job.json", "no description of a job"});
  EXPECT_EQ(contents(brick(first)), before);
  EXPECT_FALSE(std::filesystem::exists(path("a.vtu")));
}

TEST_F(Bricks, AFolderInUseIsRefused) {
  bool stopped = false;
  // On a busy machine the program may end before it is stopped.
  for (int attempt = 0; attempt < 20 && !stopped; ++attempt) {
    Process process(words_with_scratch("a.vtu"), path("err"));
    while (!std::filesystem::exists(scratch("tetwright-job.json")) && !process.ended()) wait_a_moment();
    stopped = process.stop();
    if (!stopped) continue;
    expect_refused(line(words_with_scratch("b.vtu")) + " --quiet", 2, {"scratch", "another process"});
    process.send(SIGCONT);
    EXPECT_EQ(process.wait(), 0) << contents(path("err"));
    EXPECT_FALSE(std::filesystem::exists(path("scratch")));
  }
  EXPECT_TRUE(stopped);
}

TEST_F(Bricks, AFullDiskIsStatusFiveAndFinishedBricksStay) {
  const std::string mesh = expected();
  ASSERT_NO_FATAL_FAILURE(kill_after(brick_count));
  std::uintmax_t smallest = std::filesystem::file_size(brick(1));
  for (const std::size_t b : {1, 2}) {
    smallest = std::min(smallest, std::filesystem::file_size(brick(b)));
    std::filesystem::remove(brick(b));
  }
  // A limit on the size of files acts like a full disk. The shell's unit is 512 bytes.
  std::string call = line(words_with_scratch("a.vtu")) + " --quiet";
  const std::string statistics = "--stats " + path("s.json");  // would not fit either
  call.erase(call.find(statistics), statistics.size());
  expect_refused(call, 5, {"brick-"}, "ulimit -f " + std::to_string(smallest / 2 / 512) + ";");
  EXPECT_EQ(finished(), std::vector<std::size_t>{0});
  EXPECT_EQ(expect_resumed(mesh), 1u);
}

TEST_F(Bricks, AutomaticBricksAreThoseOfTheFolder) {
  const std::string mesh = expected();
  ASSERT_NO_FATAL_FAILURE(kill_after(1));
  std::string call = line(words_with_scratch("a.vtu"));
  call.replace(call.find("--bricks 32"), 11, "--bricks auto");
  const Answer a = run(call);
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_GE(bricks().at("resumed"), 1);
  EXPECT_TRUE(contents(path("a.vtu")) == mesh);
}

TEST_F(Bricks, WrongCallsAreStatusTwo) {
  const std::string call = "prepare " + path("long.nrrd") + " --target-tets 900 -o " + path("a.vtu");
  const std::string with = call + " --bricks 32 ";
  for (const std::string other :
       {"--uniform", "--tolerance 1", "--min-edge 1", "--max-edge 5", "--schedule paper"}) {
    const std::string option = other.substr(0, other.find(' '));
    expect_refused(with + other, 2, {"--bricks does not work with " + option});
  }
  put(path("sizes.txt"), "0 0 0 1\n");
  expect_refused(with + "--size-field " + path("sizes.txt"), 2, {"--bricks does not work with --size-field"});
  for (const std::string cells :
       {"33", "16", "2048", "0", "abc", "32.5", "''", "1e2", "99999999999999999999"})
    expect_refused(call + " --bricks " + cells, 2,
                   {"--bricks", "auto, off or a power of two from 32 to 1024"});
  expect_refused(call + " --bricks=-5", 2, {"--bricks", "'-5'"});
  expect_refused(call + " --bricks off --scratch " + path("scratch"), 2, {"--scratch", "--bricks off"});
  put(path("body.off"), tetrahedron_off);
  const std::string surface = "prepare " + path("body.off") + " --target-tets 100 -o " + path("a.vtu");
  expect_refused(surface + " --bricks 32", 2, {"--bricks", "segmented volumes"});
  expect_refused(surface + " --scratch " + path("scratch"), 2, {"--scratch", "segmented volumes"});
  expect_refused("mesh " + path("long.nrrd") + " --bricks 32 -o " + path("a.vtu"), 2, {"--bricks"});
  put(path("file"), "precious");
  for (const std::string wrong : {"file", "file/below"})
    expect_refused(with + "--quiet --scratch " + path(wrong), 5, {"file", "folder", "--scratch"});
  EXPECT_EQ(contents(path("file")), "precious");
  EXPECT_FALSE(std::filesystem::exists(path("a.vtu")));
  EXPECT_FALSE(std::filesystem::exists(path("scratch")));
}

/// Makes the mesh of a volume whole and in bricks of 32 cells, which must have equal statistics, the same
/// status and a valid result.
/// \return the answers of check --json to both results
std::array<nlohmann::json, 2> compare_with_whole(const TemporaryFolder& folder, const std::string& call) {
  std::array<nlohmann::json, 2> stats, checks;
  std::array<int, 2> status{};
  const std::string rounds = " --brick-rounds 2";
  const std::string of_whole = call.ends_with(rounds) ? call.substr(0, call.size() - rounds.size()) : call;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string out = folder / (i == 0 ? "whole.vtu" : "bricks.vtu");
    const Answer a = run((i == 0 ? of_whole + " --bricks off" : call + " --bricks 32") + " --threads 1 -o " +
                         out + " --stats " + (folder / "s.json"));
    EXPECT_TRUE(a.status == 0 || a.status == 1) << a.err;
    status[i] = a.status;
    stats[i] = read_json(folder / "s.json");
    const Answer check = run("check --json --quiet " + out);
    EXPECT_EQ(check.status, 0) << check.out;
    checks[i] = nlohmann::json::parse(check.out);
    EXPECT_EQ(checks[i].at("mesh").at("materials").size(), stats[0].at("dense").at("materials").size());
  }
  EXPECT_EQ(status[0], status[1]);
  EXPECT_EQ(stats[0].at("shortfall"), stats[1].at("shortfall"));
  EXPECT_GT(stats[1].at("dense").at("bricks").at("count"), 1);
  stats[1]["dense"].erase("bricks");
  for (nlohmann::json& s : stats) s["dense"].erase("histogram");  // relative to each brick's mean volume
  for (const std::string& name : differences(stats[0].at("dense"), stats[1].at("dense")))
    ADD_FAILURE() << name << ": " << stats[0]["dense"][nlohmann::json::json_pointer(name)] << " and "
                  << stats[1]["dense"][nlohmann::json::json_pointer(name)];
  return checks;
}

/// Compares a part of a sample, so that the test is short.
void expect_dense_mesh_of_the_whole(const std::string& sample, const std::array<int, 3>& low,
                                    const std::array<int, 3>& high, const std::string& options) {
  const TemporaryFolder f;
  write_label_volume(slab(sample, low, high), f / "part.nrrd");
  const auto checks = compare_with_whole(f, "prepare " + (f / "part.nrrd") + options);
  EXPECT_EQ(checks[0].at("topology"), checks[1].at("topology"));
}

TEST(BricksOfSamples, FoamHasTheDenseMeshOfTheWhole) {
  expect_dense_mesh_of_the_whole("foam", {0, 20, 20}, {48, 32, 28}, " --target-tets 2000 --voxel-size 1");
}

TEST(BricksOfSamples, AgainCoarsenedFoamHasTheDenseMeshOfTheWhole) {
  expect_dense_mesh_of_the_whole("foam", {0, 20, 20}, {48, 32, 28},
                                 " --target-tets 2000 --voxel-size 1 --brick-rounds 2");
}

TEST(BricksOfSamples, OrgansHaveTheDenseMeshOfTheWhole) {
  expect_dense_mesh_of_the_whole("organs", {0, 18, 20}, {48, 28, 27},
                                 " --target-tets 2500 --voxel-size 1.05");
}

/// Number of face-connected components of each label but 0.
std::map<MaterialTag, int> components(const LabelVolume& volume) {
  const int nx = volume.size[0], ny = volume.size[1], nz = volume.size[2];
  std::vector<std::uint8_t> seen(volume.labels.size(), 0);
  const auto index = [&](int x, int y, int z) {
    return static_cast<std::size_t>(x) +
           static_cast<std::size_t>(nx) *
               (static_cast<std::size_t>(y) + static_cast<std::size_t>(ny) * static_cast<std::size_t>(z));
  };
  std::map<MaterialTag, int> count;
  for (int z = 0; z < nz; ++z)
    for (int y = 0; y < ny; ++y)
      for (int x = 0; x < nx; ++x) {
        const MaterialTag label = volume.labels[index(x, y, z)];
        if (label == 0 || seen[index(x, y, z)]) continue;
        ++count[label];
        seen[index(x, y, z)] = 1;
        std::vector<std::array<int, 3>> open{{x, y, z}};
        while (!open.empty()) {
          const std::array<int, 3> at = open.back();
          open.pop_back();
          for (std::size_t a = 0; a < 3; ++a)
            for (const int step : {-1, 1}) {
              std::array<int, 3> next = at;
              next[a] += step;
              if (next[a] < 0 || next[a] >= volume.size[a]) continue;
              const std::size_t i = index(next[0], next[1], next[2]);
              if (seen[i] || volume.labels[i] != label) continue;
              seen[i] = 1;
              open.push_back(next);
            }
        }
      }
  return count;
}

/// Expects the mesh in bricks to have the components of the voxels' labels.
void expect_components(const LabelVolume& volume) {
  const TemporaryFolder f;
  write_label_volume(volume, f / "v.nrrd");
  const auto checks = compare_with_whole(
      f, "prepare " + (f / "v.nrrd") + " --target-tets 2000 --voxel-size 1 --min-voxels 1");
  std::map<MaterialTag, int> found;
  for (const nlohmann::json& material : checks[1].at("topology").at("materials"))
    found[material.at("tag")] = material.at("components");
  EXPECT_EQ(found, components(volume));
}

// Gaps and slabs one voxel thick, one after another, so that the cut runs along one of them wherever it is.
TEST(ThinLabels, KeepTheirComponentsAlongTheCut) {
  expect_components(make_volume({44, 8, 8}, [](int x, int, int) {
    if (x < 26) return 1;
    if (x >= 39) return 3;
    return x % 2 == 0 ? 0 : 2;
  }));
}

// Slabs and gaps one voxel thick.
TEST(ThinLabels, KeepTheirComponentsAcrossTheCut) {
  expect_components(make_volume({44, 10, 6}, [](int, int y, int) {
    constexpr std::array<MaterialTag, 10> rows{1, 1, 0, 1, 1, 2, 3, 3, 0, 4};
    return rows[static_cast<std::size_t>(y)];
  }));
}

// A gap of a voxel that winds around the plane between two bricks, whose boundaries move by more than that.
TEST(BricksThatMeet, AreMadeAgainWithTheirBoundary) {
  const TemporaryFolder folder;
  const auto gap = [](int x, int y, int z) {
    const double at = 32 + 3 * std::sin(y / 3.5) * std::cos(z / 3.85);
    if (std::min({x, y, z}) < 3 || std::max(y, z) > 28 || x > 60) return 0;
    return x < at - 0.5 ? 1 : x > at + 0.5 ? 2 : 0;
  };
  write_label_volume(make_volume({64, 32, 32}, gap), folder / "gap.nrrd");
  const std::string call = "prepare " + (folder / "gap.nrrd") +
                           " --target-tets 150 --voxel-size 1 --bricks 32 --quiet --threads 1 --stats " +
                           (folder / "s.json");
  const Answer made = run(call + " -o " + (folder / "made.vtu"));
  EXPECT_LE(made.status, 1) << made.err;
  EXPECT_EQ(read_json(folder / "s.json").at("dense").at("bricks").at("surfaces_kept"), 2);
  EXPECT_EQ(run("check " + (folder / "made.vtu") + " --quiet").status, 0);
  const Answer more = run(call + " --brick-rounds 2 -o " + (folder / "more.vtu"));
  EXPECT_LE(more.status, 1) << more.err;
  EXPECT_GE(read_json(folder / "s.json").at("dense").at("bricks").at("surfaces_kept"), 2);
  EXPECT_EQ(run("check " + (folder / "more.vtu") + " --quiet").status, 0);
  const Answer again = run(call + " --scratch " + (folder / "scratch") + " -o " + (folder / "again.vtu"));
  EXPECT_EQ(again.status, made.status);
  EXPECT_TRUE(contents(folder / "again.vtu") == contents(folder / "made.vtu"));
}

}  // namespace
}  // namespace tetwright::bricks_test
