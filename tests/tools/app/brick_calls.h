// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/samples/samples.h"
#include "tests/tools/process.h"
#include "tests/tools/program.h"
#include "tetwright/io.h"

/// Calls of the program that make bricks.
namespace tetwright::bricks_test {

using Labels = std::function<MaterialTag(int, int, int)>;

inline LabelVolume make_volume(const std::array<int, 3>& size, const Labels& label) {
  LabelVolume volume;
  volume.size = size;
  for (int z = 0; z < size[2]; ++z)
    for (int y = 0; y < size[1]; ++y)
      for (int x = 0; x < size[0]; ++x) volume.labels.push_back(label(x, y, z));
  return volume;
}

/// A long volume of three bricks, of which the second one has the most labels.
inline LabelVolume long_volume() {
  return make_volume({72, 6, 6},
                     [](int x, int y, int z) { return x < 40 || x >= 56 ? 1 : 2 + y / 3 + 2 * (z / 3); });
}

/// The part of a sample between these voxels.
inline LabelVolume slab(const std::string& sample, const std::array<int, 3>& low,
                        const std::array<int, 3>& high) {
  const auto volume = std::get<LabelVolume>(make_sample(sample));
  LabelVolume part = volume;
  part.labels.clear();
  for (std::size_t a = 0; a < 3; ++a) part.size[a] = high[a] - low[a];
  for (int z = low[2]; z < high[2]; ++z)
    for (int y = low[1]; y < high[1]; ++y)
      for (int x = low[0]; x < high[0]; ++x)
        part.labels.push_back(
            volume.labels[static_cast<std::size_t>(x + volume.size[0] * (y + volume.size[1] * z))]);
  return part;
}

inline nlohmann::json read_json(const std::string& file) { return nlohmann::json::parse(contents(file)); }

/// The keys whose values differ, numbers by more than rounding.
inline std::vector<std::string> differences(const nlohmann::json& a, const nlohmann::json& b,
                                            const std::string& name = "") {
  std::vector<std::string> all;
  if (a.is_number_float() && b.is_number_float()) {
    const double x = a, y = b;
    if (std::fabs(x - y) > 1e-9 * std::max(std::fabs(x), std::fabs(y))) all.push_back(name);
  } else if (a.is_structured() && a.type() == b.type() && a.size() == b.size()) {
    for (auto i = a.begin(), j = b.begin(); i != a.end(); ++i, ++j) {
      const auto more = differences(*i, *j, a.is_object() ? name + "/" + i.key() : name);
      all.insert(all.end(), more.begin(), more.end());
      if (a.is_object() && i.key() != j.key()) all.push_back(name + "/" + i.key());
    }
  } else if (a != b) {
    all.push_back(name);
  }
  return all;
}

inline constexpr std::size_t brick_count = 3;

/// Calls for a volume of three bricks.
class Bricks : public testing::Test {
 protected:
  Bricks() { write_label_volume(long_volume(), path("long.nrrd")); }

  std::string path(const std::string& name) const { return folder_ / name; }
  /// Path of a file of the scratch folder.
  std::string scratch(const std::string& name) const { return path("scratch/" + name); }
  std::string brick(std::size_t b) const { return scratch("brick-" + std::to_string(b) + ".tetwright"); }

  /// Words of the call that makes the mesh of the long volume.
  std::vector<std::string> words(const std::string& mesh) const {
    return {"prepare", path("long.nrrd"), "--target-tets", "1000", "--voxel-size", "1", "--bricks",
            "32",      "--stats",         path("s.json"),  "-o",   path(mesh)};
  }
  std::vector<std::string> words_with_scratch(const std::string& mesh) const {
    std::vector<std::string> all = words(mesh);
    for (const std::string& word :
         {std::string("--scratch"), path("scratch"), std::string("--threads"), std::string("1")})
      all.push_back(word);
    return all;
  }
  static std::string line(const std::vector<std::string>& words) {
    std::string all;
    for (const std::string& word : words) all += (all.empty() ? "" : " ") + word;
    return all;
  }
  /// Statistics of the bricks of the last run.
  nlohmann::json bricks() const { return read_json(path("s.json")).at("dense").at("bricks"); }

  /// Makes the mesh in memory.
  std::string expected() const {
    const Answer a = run(line(words("expected.vtu")) + " --threads 1");
    EXPECT_EQ(a.status, 0) << a.err;
    return contents(path("expected.vtu"));
  }
  /// Runs the job until `enough` says so and ends it then.
  /// \return its status, or 1000 and the signal, see Process
  int end_when(const std::function<bool()>& enough, int signal) const {
    Process process(words_with_scratch("killed.vtu"), path("err"));
    while (!enough() && !process.ended()) wait_a_moment();
    process.send(signal);
    return process.wait();
  }
  /// Likewise with SIGKILL.
  /// \return whether it was killed before it ended
  bool kill_when(const std::function<bool()>& enough) const {
    return end_when(enough, SIGKILL) == 1000 + SIGKILL;
  }
  /// The finished bricks.
  std::vector<std::size_t> finished() const {
    std::vector<std::size_t> all;
    for (std::size_t b = 0; b < brick_count; ++b)
      if (std::filesystem::exists(brick(b))) all.push_back(b);
    return all;
  }
  /// Runs the job until so many bricks are finished and kills it then. On a busy machine it may end before,
  /// without leaving anything, and is run again.
  void kill_after(std::size_t count) const {
    const auto enough = [&] { return finished().size() >= count; };
    for (int attempt = 0; attempt < 20; ++attempt) {
      if (kill_when(enough) && enough()) return;
      std::filesystem::remove(path("killed.vtu"));
    }
    FAIL() << "never killed in time: " << contents(path("err"));
  }
  /// Expects a run with the scratch folder to give the mesh and to remove the folder.
  /// \return the number of bricks that were finished before
  std::size_t expect_resumed(const std::string& mesh) const {
    const Answer a = run(line(words_with_scratch("resumed.vtu")));
    EXPECT_EQ(a.status, 0) << a.err;
    EXPECT_TRUE(contents(path("resumed.vtu")) == mesh);
    EXPECT_FALSE(std::filesystem::exists(path("scratch")));
    return a.status == 0 ? bricks().at("resumed").get<std::size_t>() : 0;
  }

  TemporaryFolder folder_;
};

}  // namespace tetwright::bricks_test
