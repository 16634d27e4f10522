// SPDX-License-Identifier: Apache-2.0
#include "tetwright/label_masks.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/common/io/expect_error.h"

namespace tetwright::label_masks_test {
namespace {

using Labels = std::vector<MaterialTag>;
using Texts = std::vector<std::string>;

LabelVolume row(const Labels& labels) {
  LabelVolume volume;
  volume.size = {static_cast<int>(labels.size()), 1, 1};
  volume.origin = {10, 20, 30};
  volume.directions << 2, 0, 0, 0, 2, 0, 0, 0, 2;
  volume.space = "right-anterior-superior";
  volume.labels = labels;
  return volume;
}

/// Three masks: a has voxels 0 to 3, b 2 to 5, c 3.
LabelMasks three(OverlapRule rule) {
  LabelMasks masks(rule);
  masks.add(row({1, 1, 1, 1, 0, 0, 0}), "a.nii", {{1, {"a", 1}}}, 0);
  masks.add(row({0, 0, 255, 255, 255, 255, 0}), "b.nii", {{255, {"b", 2}}}, 0);
  masks.add(row({0, 0, 0, 1, 0, 0, 0}), "c.nii", {{1, {"c", 3}}}, 0);
  return masks;
}

Texts texts_of(const std::vector<Diagnostic>& findings) {
  Texts all;
  for (const Diagnostic& f : findings) all.push_back(std::to_string(f.count) + " " + f.what + ": " + f.done);
  return all;
}

TEST(LabelMasks, LaterMasksCarveEarlierOnes) {
  const LabelMasks::Joined joined = three(OverlapRule::later).join("masks");
  EXPECT_EQ(joined.volume.labels, (Labels{1, 1, 2, 3, 2, 2, 0}));
  EXPECT_EQ(joined.volume.names, (std::map<MaterialTag, std::string>{{1, "a"}, {2, "b"}, {3, "c"}}));
  ASSERT_EQ(joined.overlaps.size(), 2u);
  EXPECT_EQ(joined.overlaps[0].first + joined.overlaps[0].second + joined.overlaps[0].owner, "abb");
  EXPECT_EQ(joined.overlaps[0].volume, 16);  // two voxels of 2 x 2 x 2
  EXPECT_EQ(joined.overlaps[0].place, Vec3(14, 20, 30));
  EXPECT_EQ(joined.overlaps[1].first + joined.overlaps[1].second, "bc");
  EXPECT_EQ(texts_of(joined.findings), (Texts{"2 voxels in several masks, in 2 pairs, most in 'a' and 'b' "
                                              "(2): they belong to the later one"}));
}

TEST(LabelMasks, OtherRules) {
  EXPECT_EQ(three(OverlapRule::first).join("masks").volume.labels, (Labels{1, 1, 1, 1, 2, 2, 0}));
  const LabelMasks::Joined shared = three(OverlapRule::material).join("masks");
  EXPECT_EQ(shared.volume.labels, (Labels{1, 1, 4, 5, 2, 2, 0}));
  EXPECT_EQ(shared.volume.names.at(4), "a+b");
  EXPECT_EQ(shared.volume.names.at(5), "a+b+c");
  EXPECT_EQ(error_of<InputError>([] { three(OverlapRule::error); }),
            "b.nii: the masks 'a' and 'b' overlap in 2 voxels, the first at (14, 20, 30); separate them, or "
            "let the later one keep them with --on-overlap later");
}

TEST(LabelMasks, MaterialsOfOverlapsHaveNamesAndTagsOfTheirOwn) {
  const auto joined = [](const std::map<std::string, MaterialTag>& tags, MaterialTag second) {
    LabelMasks masks(OverlapRule::material, tags);
    masks.add(row({1, 1, 0}), "a.nii", {{1, {"a", 1}}}, 0);
    masks.add(row({0, 1, 0}), "b.nii", {{1, {"b", second}}}, 0);
    masks.add(row({0, 0, 1}), "c.nii", {{1, {"a+b", 3}}}, 0);
    const LabelMasks::Joined all = std::move(masks).join("masks");
    EXPECT_EQ(all.overlaps.size(), 1u);
    EXPECT_EQ(all.overlaps.front().owner, "a+b_2");
    return all.volume;
  };
  const LabelVolume unnamed = joined({}, 2);
  EXPECT_EQ(unnamed.labels, (Labels{1, 4, 3}));
  EXPECT_EQ(unnamed.names.at(4), "a+b_2");
  EXPECT_EQ(joined({{"liver", 9}}, 2).labels, (Labels{1, 10, 3}));
  EXPECT_EQ(joined({{"a+b_2", 7}}, 2).labels, (Labels{1, 7, 3}));
  EXPECT_NE(error_of<InputError>([&] { joined({{"a+b_2", 3}}, 2); }), "");
  EXPECT_EQ(error_of<InputError>([&] {
              joined({{"a+b_2", 0}}, 2);
            }),
            "masks: the label 0 of the material 'a+b_2', where masks overlap, must be above 0");
  EXPECT_EQ(
      error_of<InputError>([&] { joined({}, std::numeric_limits<MaterialTag>::max()); }),
      "masks: no label above 2147483647 is left for the material 'a+b_2', where masks overlap; give the "
      "masks smaller labels");
  // A mask inside another one is not lost.
  LabelMasks nested(OverlapRule::material);
  nested.add(row({1, 1, 1}), "a.nii", {{1, {"a", 1}}}, 0);
  nested.add(row({0, 1, 0}), "b.nii", {{1, {"b", 2}}}, 0);
  EXPECT_EQ(std::move(nested).join("masks").findings.size(), 1u);
}

TEST(LabelMasks, EmptyAndCoveredMasksAreNoted) {
  LabelMasks masks(OverlapRule::later);
  masks.add(row({0, 1, 0}), "a.nii", {{1, {"a", 1}}}, 0);
  masks.add(row({0, 0, 0}), "b.nii", {{0, {"b", 2}}}, 0);
  masks.add(row({5, 5, 0}), "c.nii", {{5, {"c", 3}}}, 0);
  const LabelMasks::Joined joined = std::move(masks).join("masks");
  EXPECT_EQ(joined.volume.labels, (Labels{3, 3, 0}));
  EXPECT_EQ(
      texts_of(joined.findings),
      (Texts{"1 voxel in several masks, in 1 pair, most in 'a' and 'c' (1): they belong to the later one",
             "1 mask without a voxel: 'b': not in the mesh",
             "1 mask without a voxel that does not belong to others: 'a': not in the mesh"}));
  LabelMasks none(OverlapRule::later);
  none.add(row({0, 0, 0}), "b.nii", {{0, {"b", 2}}}, 0);
  EXPECT_EQ(error_of<NothingToMeshError>([&] { std::move(none).join("masks"); }),
            "masks: no mask has a voxel");
}

TEST(LabelMasks, GridsMustBeEqualToRounding) {
  LabelMasks masks(OverlapRule::later);
  masks.add(row({1, 0, 0}), "a.nii", {{1, {"a", 1}}}, 0);
  LabelVolume close = row({0, 1, 0});
  close.origin[0] += 1e-3;
  masks.add(close, "b.nii", {{1, {"b", 2}}}, 0);
  LabelVolume shifted = row({0, 0, 1});
  shifted.directions(0, 0) += 2e-3;
  EXPECT_EQ(
      error_of<InputError>([&] {
        masks.add(shifted, "c.nii", {{1, {"c", 3}}}, 0);
      }),
      "c.nii: its grid, 3 x 1 x 1 voxels from (10, 20, 30) in steps of (2.002, 0, 0), (0, 2, 0), (0, 0, "
      "2), is not that of a.nii, 3 x 1 x 1 voxels from (10, 20, 30) in steps of (2, 0, 0), (0, 2, 0), "
      "(0, 0, 2); resample one of them to the grid of the other");
  EXPECT_NE(error_of<InputError>([&] { masks.add(row({0, 1}), "d.nii", {{1, {"d", 4}}}, 0); }), "");
}

TEST(LabelMasks, OtherSpacesAreConverted) {
  LabelMasks masks(OverlapRule::later);
  masks.add(row({1, 0, 0}), "a.nii", {{1, {"a", 1}}}, 0);
  LabelVolume other = row({0, 1, 0});
  other.space = "left-posterior-superior";
  other.origin = {-10, -20, 30};
  other.directions << -2, 0, 0, 0, -2, 0, 0, 0, 2;
  masks.add(other, "b.nrrd", {{1, {"b", 2}}}, 0);
  const LabelMasks::Joined joined = std::move(masks).join("masks");
  EXPECT_EQ(joined.volume.labels, (Labels{1, 2, 0}));
  EXPECT_EQ(texts_of(joined.findings),
            (Texts{"1 input in another space, left-posterior-superior: brought into that of the first one, "
                   "right-anterior-superior"}));
  LabelVolume unknown = row({0, 0, 1});
  unknown.space = "scanner-xyz";
  LabelMasks taken(OverlapRule::later);
  taken.add(row({1, 0, 0}), "a.nii", {{1, {"a", 1}}}, 0);
  taken.add(unknown, "b.nrrd", {{1, {"b", 2}}}, 0);
  EXPECT_EQ(
      texts_of(std::move(taken).join("masks").findings),
      (Texts{"1 input in another space, scanner-xyz: taken as they are, since it cannot be compared with "
             "that of the first one, right-anterior-superior"}));
  // Equal numbers are another position there.
  LabelVolume mirrored = row({0, 1, 0});
  mirrored.space = "left-posterior-superior";
  LabelMasks again(OverlapRule::later);
  again.add(row({1, 0, 0}), "a.nii", {{1, {"a", 1}}}, 0);
  EXPECT_NE(error_of<InputError>([&] { again.add(mirrored, "b.nrrd", {{1, {"b", 2}}}, 0); }), "");
}

TEST(LabelMasks, AMaskHasOneLabel) {
  EXPECT_EQ(label_of_mask(row({0, 7, 7}), 0, "a.nii"), 7);
  EXPECT_EQ(label_of_mask(row({7, 7, 7}), 7, "a.nii"), 7);
  EXPECT_EQ(error_of<InputError>([] {
              label_of_mask(row({0, 7, 3}), 0, "a.nii");
            }),
            "a.nii: has the labels 7 and 3, but a mask has one besides 0; give a volume of labels alone and "
            "without a name, or a mask for each label");
}

}  // namespace
}  // namespace tetwright::label_masks_test
