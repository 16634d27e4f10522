// SPDX-License-Identifier: Apache-2.0
#include "tetwright/mesher_input.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "common/random.h"
#include "tests/common/io/expect_error.h"
#include "tests/mesher/label_volumes.h"
#include "tetwright/resources.h"

namespace tetwright::label_input_test {
namespace {

/// One row of voxels, starting at (10, 20, 30) with steps of 2 along the y axis.
LabelVolume volume_of(const std::vector<MaterialTag>& labels) {
  LabelVolume volume;
  volume.size = {static_cast<int>(labels.size()), 1, 1};
  volume.origin = {10, 20, 30};
  volume.directions << 0, 1, 0, 2, 0, 0, 0, 0, 3;
  volume.space = "RAS";
  volume.labels = labels;
  return volume;
}

LabelInput prepare(const std::vector<MaterialTag>& labels, const LabelChoice& choice) {
  return make_label_input(std::make_unique<MemoryLabelSource>(volume_of(labels)), "scan.nrrd", choice,
                          nullptr);
}

LabelChoice unmerged() {
  LabelChoice choice;
  choice.min_voxels = 0;
  return choice;
}

template <class E>
std::string refusal(const std::vector<MaterialTag>& labels, const LabelChoice& choice) {
  return error_of<E>([&] { prepare(labels, choice); });
}

std::vector<std::string> findings_of(const LabelInput& prepared) {
  std::vector<std::string> all;
  for (const Diagnostic& f : prepared.findings) {
    EXPECT_EQ(f.file, "scan.nrrd");
    all.push_back(std::to_string(f.count) + " " + f.what + ": " + f.done);
  }
  return all;
}

using Regions = std::vector<RegionIndex>;
using Texts = std::vector<std::string>;

TEST(LabelInput, SpacingThatTheFileDoesNotGiveIsNoted) {
  LabelVolume volume = volume_of({0, 1, 2});
  volume.spacing_assumed = true;
  EXPECT_EQ(findings_of(make_label_input(std::make_unique<MemoryLabelSource>(volume), "scan.nrrd", unmerged(),
                                         nullptr)),
            (Texts{"1 volume whose file gives no spacing: each voxel has the size 1"}));
}

TEST(LabelInput, AllLabelsButTheOutsideOneAreMeshed) {
  LabelChoice choice = unmerged();
  choice.names = {{5, "liver"}, {6, "not there"}};
  const LabelInput p = prepare({0, 5, 5, -3, 2147483647, 0, 5}, choice);
  EXPECT_EQ(voxels_of(p.regions), (Regions{0, 2, 2, 1, 3, 0, 2}));
  ASSERT_EQ(p.materials.size(), 3u);
  EXPECT_EQ(p.materials[0].name, "label_-3");
  EXPECT_EQ(p.materials[0].tag, -3);
  EXPECT_EQ(p.materials[1].name, "liver");
  EXPECT_EQ(p.materials[1].voxels, 3u);
  EXPECT_EQ(p.materials[1].voxels_in_file, 3u);
  EXPECT_EQ(p.materials[2].name, "label_2147483647");
  EXPECT_EQ(p.materials[2].tag, 2147483647);
  EXPECT_EQ(p.file, "scan.nrrd");
  EXPECT_EQ(p.size, (std::array<int, 3>{7, 1, 1}));
  EXPECT_EQ(p.origin, Vec3(10, 20, 30));
  EXPECT_EQ(p.directions, volume_of({}).directions);
  EXPECT_EQ(p.space, "RAS");
  EXPECT_EQ(findings_of(p), Texts());
}

TEST(LabelInput, AnotherOutsideLabel) {
  LabelChoice choice = unmerged();
  choice.outside_label = -7;
  const LabelInput p = prepare({0, -7, 1}, choice);
  EXPECT_EQ(voxels_of(p.regions), (Regions{1, 0, 2}));
  EXPECT_EQ(p.materials[0].name, "label_0");
}

TEST(LabelInput, WithoutOutsideAllIsMeshed) {
  const LabelInput p = prepare({1, 1, 2}, unmerged());
  EXPECT_EQ(voxels_of(p.regions), (Regions{1, 1, 2}));
  EXPECT_EQ(findings_of(p), Texts{"3 voxels, none of them outside (label 0): all meshed, up to the border of "
                                  "the volume"});
}

TEST(LabelInput, WhatIsNotChosenIsOutside) {
  LabelChoice choice = unmerged();
  choice.labels = {{8, 9}, {-4, -3}, {5, 8}, {6, 6}};
  const LabelInput p = prepare({0, 1, 5, 7, -3, 9, 10, -5, 6, 4}, choice);
  EXPECT_EQ(voxels_of(p.regions), (Regions{0, 0, 2, 4, 1, 5, 0, 0, 3, 0}));
  EXPECT_EQ(p.materials.size(), 5u);
  choice.labels = {{1, 2147483647}};
  EXPECT_EQ(voxels_of(prepare({0, 1, 5, -7}, choice).regions), (Regions{0, 1, 2, 0}));
}

TEST(LabelInput, ChosenLabelsThatAreNotThere) {
  LabelChoice choice = unmerged();
  choice.labels = {{1, 1}, {7, 7}};
  EXPECT_EQ(refusal<InputError>({0, 1, 5, -3}, choice), "scan.nrrd: there is no label 7; there are -3, 1, 5");
  choice.labels = {{2, 4}};
  EXPECT_EQ(refusal<InputError>({0, 1, 5}, choice),
            "scan.nrrd: there are none of the labels 2 to 4; there are 1, 5");
  std::vector<MaterialTag> many;
  for (MaterialTag i = 100; i > 0; --i) many.push_back(i);
  choice.labels = {{101, 101}};
  std::string message = refusal<InputError>(many, choice);
  EXPECT_NE(message.find("there are 1, 2, 3"), std::string::npos) << message;
  EXPECT_NE(message.find(", 29, 30, ..."), std::string::npos) << message;
  many.erase(many.begin(), many.end() - 30);
  message = refusal<InputError>(many, choice);
  EXPECT_NE(message.find(", 29, 30"), std::string::npos) << message;
  EXPECT_EQ(message.find("..."), std::string::npos) << message;
}

TEST(LabelInput, TheOutsideLabelCantBeChosen) {
  for (const auto& range : {std::pair(3, 3), std::pair(1, 5)}) {
    LabelChoice choice;
    choice.outside_label = 3;
    choice.labels = {{9, 9}, range};
    const std::string message = refusal<UsageError>({1, 3, 9}, choice);
    EXPECT_NE(message.find("label 3 of --labels is the outside label"), std::string::npos) << message;
  }
  LabelChoice choice;
  choice.labels = {{5, 2}};
  EXPECT_NE(refusal<UsageError>({1, 3}, choice).find("5 to 2"), std::string::npos);
}

TEST(LabelInput, TwoLabelsOfOneName) {
  LabelChoice choice = unmerged();
  choice.names = {{1, "bone"}, {2, "skin"}, {9, "bone"}, {4, "label_5"}};
  const std::string message = refusal<UsageError>({1, 2, 9}, choice);
  EXPECT_NE(message.find("labels 1 and 9 are both called 'bone'"), std::string::npos) << message;
  EXPECT_NE(refusal<UsageError>({5, 4}, choice).find("labels 4 and 5"), std::string::npos);
  EXPECT_EQ(prepare({0, 1, 2, 4}, choice).materials.size(),
            3u);  // the 9 would be refused, but does not occur
  // Names from a file are refused at the later of their lines.
  choice.names_file = "names.txt";
  choice.name_lines = {{1, 8}, {2, 1}, {9, 3}, {4, 2}};
  EXPECT_EQ(refusal<InputError>({1, 2, 9}, choice),
            "names.txt: line 8: labels 1 and 9 are both called 'bone'; give one another name");
  EXPECT_EQ(refusal<InputError>({5, 4}, choice).rfind("names.txt: line 2: labels 4 and 5", 0), 0u);
}

TEST(LabelInput, NoLabelIsCalledOutsideButTheOutsideLabel) {
  LabelChoice choice = unmerged();
  choice.names = {{0, "outside"}, {3, "outside"}};
  const std::string message = refusal<UsageError>({0, 1, 3}, choice);
  EXPECT_NE(message.find("label 3 is called 'outside'"), std::string::npos) << message;
  EXPECT_EQ(prepare({0, 1}, choice).materials.size(), 1u);
}

TEST(LabelInput, NothingToMesh) {
  EXPECT_NE(
      refusal<NothingToMeshError>({0, 0}, unmerged()).find("scan.nrrd: all voxels have the outside label 0"),
      std::string::npos);
  LabelChoice choice;
  choice.labels = {{1, 1}};
  refusal<NothingToMeshError>({0, 0}, choice);
  choice.labels.clear();
  choice.min_voxels = 3;
  const std::string message = refusal<NothingToMeshError>({0, 0, 0, 1, 1, 0, 0, 0, 2}, choice);
  EXPECT_NE(message.find("fewer than 3 voxels"), std::string::npos) << message;
}

TEST(LabelInput, TooManyLabels) {
  std::vector<MaterialTag> labels;
  for (MaterialTag i = 0; i <= 60000; ++i) labels.push_back(i * 30000);
  EXPECT_EQ(prepare(labels, unmerged()).materials.size(), 60000u);
  EXPECT_EQ(prepare(labels, unmerged()).regions[60000], 60000u);
  labels.push_back(7);
  EXPECT_NE(refusal<InputError>(labels, unmerged()).find("more than 60000 labels"), std::string::npos);
  LabelChoice choice = unmerged();
  choice.labels = {{1, 100000}};
  EXPECT_EQ(prepare(labels, choice).materials.size(), 4u);
  // Few labels in each part of a large volume.
  labels.resize(600000);
  for (std::size_t i = 0; i < labels.size(); ++i) labels[i] = static_cast<MaterialTag>(i / 9);
  EXPECT_NE(refusal<InputError>(labels, unmerged()).find("more than 60000 labels"), std::string::npos);
}

TEST(LabelInput, IslandsAreMergedAndReported) {
  LabelChoice choice;
  choice.min_voxels = 3;
  choice.names = {{7, "fat"}};
  // Voxel i is at (10, 20 + 2 i, 30).
  const LabelInput p = prepare(
      {0, 0, 0, 5, 5, 5, 7, 5, 5, 5, 9, 9, 9, 9, 0, 9, 9, 9, 5, 5, 9, 9, 5, 9, 8, 8, 9, 9, 9}, choice);
  EXPECT_EQ(voxels_of(p.regions),
            (Regions{0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2}));
  ASSERT_EQ(p.materials.size(), 2u);
  EXPECT_EQ(p.materials[0].tag, 5);
  EXPECT_EQ(p.materials[0].voxels, 7u);
  EXPECT_EQ(p.materials[0].voxels_in_file, 9u);
  EXPECT_EQ(p.materials[1].tag, 9);
  EXPECT_EQ(p.materials[1].voxels, 19u);
  EXPECT_EQ(p.materials[1].voxels_in_file, 13u);
  ASSERT_EQ(p.lost.size(), 2u);
  EXPECT_EQ(p.lost[0].tag, 7);
  EXPECT_EQ(p.lost[0].name, "fat");
  EXPECT_EQ(p.lost[0].voxels, 1u);
  EXPECT_EQ(p.lost[0].place, Vec3(10, 32, 30));
  EXPECT_EQ(p.lost[1].tag, 8);
  EXPECT_EQ(p.lost[1].place, Vec3(10, 68, 30));
  EXPECT_EQ(p.lost[1].voxels, 2u);
  EXPECT_EQ(p.merged_islands, 5u);
  EXPECT_EQ(p.merged_voxels, 7u);
  EXPECT_EQ(findings_of(p),
            (Texts{"1 islands of outside (1 voxel): merged into what they touch most",
                   "2 islands of 'label_5' (3 voxels): merged into what they touch most",
                   "1 islands of 'fat' (1 voxel), all there is of it: merged into what they touch most; this "
                   "label is lost",
                   "1 islands of 'label_8' (2 voxels), all there is of it: merged into what they touch most; "
                   "this label is lost"}));
  EXPECT_EQ(p.findings[0].places.at(0), Vec3(10, 48, 30));
  EXPECT_EQ(p.findings[1].places.at(0), Vec3(10, 56, 30));
}

TEST(LabelInput, ManyLabelsWithIslandsShareAFinding) {
  std::vector<MaterialTag> labels;
  for (MaterialTag l = 1; l <= 23; ++l) labels.insert(labels.end(), {l, l, 0, 0, l, 0, 0});
  LabelChoice choice;
  choice.min_voxels = 2;
  const Texts findings = findings_of(prepare(labels, choice));
  ASSERT_EQ(findings.size(), 21u);
  EXPECT_EQ(findings[0], "1 islands of 'label_1' (1 voxel): merged into what they touch most");
  EXPECT_EQ(findings[20], "3 islands of 3 other labels (3 voxels): merged into what they touch most");
}

TEST(LabelInput, NothingIsMergedWhereNoIslandIsLarge) {
  const LabelInput p = prepare({0, 1, 1, 2}, LabelChoice());
  EXPECT_EQ(voxels_of(p.regions), (Regions{0, 1, 1, 2}));
  EXPECT_EQ(findings_of(p), Texts{"3 islands of voxels, none of which has 8: kept as they are"});
  EXPECT_EQ(p.merged_islands, 0u);
}

TEST(LabelInput, MergedVoxelsAreThoseWhoseLabelChanged) {
  Random random(3);
  for (int round = 0; round < 200; ++round) {
    LabelVolume volume = volume_of({});
    volume.size = {9, 8, 7};
    for (int i = 0; i < 504; ++i)
      volume.labels.push_back(static_cast<MaterialTag>(random.below(4)) * 5000000);
    const std::vector<MaterialTag> before = volume.labels;
    LabelChoice choice;
    choice.min_voxels = 2 + random.below(12);
    LabelInput first;
    for (unsigned threads : {1u, 4u}) {
      const ThreadLimit limit(threads);
      const LabelInput p =
          make_label_input(std::make_unique<MemoryLabelSource>(volume), "scan.nrrd", choice, nullptr);
      std::size_t changed = 0;
      std::vector<std::size_t> counts(p.materials.size() + 1, 0);
      for (std::size_t i = 0; i < before.size(); ++i) {
        ++counts[p.regions[i]];
        changed += (p.regions[i] ? p.materials[p.regions[i] - 1u].tag : 0) != before[i];
      }
      EXPECT_EQ(p.merged_voxels, changed);
      for (std::size_t m = 0; m < p.materials.size(); ++m) EXPECT_EQ(p.materials[m].voxels, counts[m + 1]);
      if (threads > 1) {
        EXPECT_EQ(voxels_of(p.regions), voxels_of(first.regions));
      }
      first = p;
    }
  }
}

/// Serves a volume in blocks; boxes from slice `first_bad` on fail.
class BlockedSource final : public LabelSource {
 public:
  BlockedSource(const LabelVolume& volume, const VoxelIndex& block, int first_bad)
      : LabelSource(volume), volume_(volume), block_(block), first_bad_(first_bad) {}
  VoxelIndex block() const override { return block_; }

 protected:
  void read_box(const VoxelIndex& low, const VoxelIndex& high, std::span<MaterialTag> out) const override {
    if (high[2] > first_bad_) throw InputError("slices before " + std::to_string(high[2]));
    volume_.read(low, high, out);
  }

 private:
  MemoryLabelSource volume_;
  VoxelIndex block_;
  int first_bad_;
};

TEST(LabelInput, VolumesAreReadInBlocksOfAnyShape) {
  Random random(5);
  LabelVolume volume = volume_of({});
  volume.size = {90, 80, 150};
  MaterialTag label = 0;
  for (int i = 0; i < 90 * 80 * 150; ++i) {
    if (random.below(30) == 0) label = static_cast<MaterialTag>(random.below(60)) - 20;
    volume.labels.push_back(label);
  }
  const LabelInput whole =
      make_label_input(std::make_unique<MemoryLabelSource>(volume), "scan.nrrd", unmerged(), nullptr);
  for (std::size_t i = 0; i < volume.labels.size(); ++i) {
    const RegionIndex region = whole.regions[i];
    ASSERT_EQ(region == outside_region ? 0 : whole.materials[region - 1u].tag, volume.labels[i]);
  }
  for (const VoxelIndex& block :
       {VoxelIndex{1, 1, 1}, {64, 64, 64}, {90, 80, 1}, {1000, 1000, 1000}, {7, 90, 45}})
    for (const unsigned threads : {1u, 4u}) {
      const ThreadLimit limit(threads);
      const LabelInput p = make_label_input(std::make_unique<BlockedSource>(volume, block, 150), "scan.nrrd",
                                            unmerged(), nullptr);
      EXPECT_EQ(voxels_of(p.regions), voxels_of(whole.regions));
      ASSERT_EQ(p.materials.size(), whole.materials.size());
      for (std::size_t m = 0; m < p.materials.size(); ++m) {
        EXPECT_EQ(p.materials[m].tag, whole.materials[m].tag);
        EXPECT_EQ(p.materials[m].voxels, whole.materials[m].voxels);
      }
      EXPECT_EQ(error_of<InputError>([&] {
                  (void)make_label_input(std::make_unique<BlockedSource>(volume, VoxelIndex{90, 80, 20}, 70),
                                         "scan.nrrd", unmerged(), nullptr);
                }),
                "slices before 80");
    }
}

TEST(LabelInput, LayersThatDoNotFitInMemoryAreRefused) {
  LabelVolume volume = volume_of({});
  volume.size = {200, 200, 10};
  volume.labels.resize(400000, 1);
  const MemoryLimit limit(1e6);
  EXPECT_NE(error_of<OutputError>([&] {
              (void)make_label_input(std::make_unique<MemoryLabelSource>(volume), "scan.nrrd", unmerged(),
                                     nullptr);
            }).find("the labels of scan.nrrd would take"),
            std::string::npos);
}

TEST(LabelInput, CanBeInterrupted) {
  Progress progress;
  progress.cancel();
  EXPECT_THROW(make_label_input(std::make_unique<MemoryLabelSource>(volume_of({0, 1})), "scan.nrrd",
                                LabelChoice(), &progress),
               Interrupted);
}

}  // namespace
}  // namespace tetwright::label_input_test
