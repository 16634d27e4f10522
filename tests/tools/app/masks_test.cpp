// SPDX-License-Identifier: Apache-2.0

// Tests masks as inputs through the program: files, folders and overlapping segments.
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/tools/program.h"
#include "tetwright/io.h"

namespace tetwright::masks_test {
namespace {

/// A ball of three labels.
LabelVolume ball() {
  LabelVolume volume;
  volume.size = {20, 18, 16};
  volume.space = "left-posterior-superior";
  for (int z = 0; z < 16; ++z)
    for (int y = 0; y < 18; ++y)
      for (int x = 0; x < 20; ++x)
        volume.labels.push_back(Vec3(x - 9.5, y - 8.5, z - 7.5).norm() > 7 ? 0 : z < 6 ? 1 : x < 10 ? 2 : 3);
  return volume;
}

class Masks : public testing::Test {
 protected:
  Masks() : organs_(ball()) {
    std::filesystem::create_directory(folder_ / "masks");
    write_label_volume(organs_, path("organs.nrrd"));
    std::string names;
    for (const MaterialTag tag : std::set<MaterialTag>(organs_.labels.begin(), organs_.labels.end())) {
      if (tag == 0) continue;
      tags_.push_back(tag);
      write_mask("masks/" + name(tag) + ".nrrd", [&](MaterialTag label) { return label == tag; });
      names += std::to_string(tag) + " " + name(tag) + "\n";
    }
    write("names.txt", names);
  }

  static std::string name(MaterialTag tag) { return "part" + std::to_string(tag); }
  std::string path(const std::string& file) const { return folder_ / file; }
  void write(const std::string& file, const std::string& text) const {
    write_file_atomically(path(file), text);
  }
  /// Writes the voxels whose labels `is_in` accepts.
  template <class IsIn>
  void write_mask(const std::string& file, const IsIn& is_in) const {
    LabelVolume mask = organs_;
    for (MaterialTag& label : mask.labels) label = is_in(label) ? 1 : 0;
    write_label_volume(mask, path(file));
  }
  Answer prepare(const std::string& words) const {
    return run("prepare " + words + " --target-tets 1500 -o " + path("out.vtu") + " --stats " +
               path("s.json"));
  }
  Answer mesh(const std::string& words) const { return run("mesh " + words + " -o " + path("out.vtu")); }
  nlohmann::json stats() const { return nlohmann::json::parse(contents(path("s.json"))); }

  TemporaryFolder folder_;
  LabelVolume organs_;
  std::vector<MaterialTag> tags_;  ///< of its labels, ascending
};

TEST_F(Masks, OfAllLabelsGiveTheBytesOfTheVolume) {
  ASSERT_EQ(mesh(path("organs.nrrd") + " --label-names " + path("names.txt")).status, 0);
  const std::string expected = contents(path("out.vtu"));
  const Answer folder = mesh(path("masks"));
  EXPECT_EQ(folder.status, 0) << folder.err;
  EXPECT_TRUE(contents(path("out.vtu")) == expected);
  std::string forwards, backwards;
  for (const MaterialTag tag : tags_) {
    const std::string file = path("masks/" + name(tag) + ".nrrd");
    forwards += file + " ";
    backwards.insert(0, file + " ");
  }
  EXPECT_EQ(mesh(forwards).status, 0);
  EXPECT_TRUE(contents(path("out.vtu")) == expected);
  // In another order, with the tags of the file of names.
  EXPECT_EQ(mesh(backwards + "--label-names " + path("names.txt")).status, 0);
  EXPECT_TRUE(contents(path("out.vtu")) == expected);
}

TEST_F(Masks, HaveTheNamesOfTheirMaterials) {
  const Answer a = prepare("--material bone=" + path("masks/part2.nrrd"));
  EXPECT_EQ(a.status, 0) << a.err;
  const nlohmann::json materials = stats().at("result").at("materials");
  ASSERT_EQ(materials.size(), 1u);
  EXPECT_NE(materials.dump().find("\"bone\""), std::string::npos) << materials;
}

TEST_F(Masks, OfOneNameAreRefused) {
  std::filesystem::create_directory(folder_ / "others");
  std::filesystem::copy_file(path("masks/part2.nrrd"), path("others/part1.nrrd"));
  const std::string both = path("masks/part1.nrrd") + " " + path("others/part1.nrrd");
  const Answer a = prepare(both);
  EXPECT_EQ(a.status, 2);
  for (const std::string& part :
       {path("masks/part1.nrrd") + " and " + path("others/part1.nrrd"),
        std::string("two masks called 'part1'"), "--material part1_2=" + path("others/part1.nrrd")})
    EXPECT_NE(a.err.find(part), std::string::npos) << part << "\n" << a.err;
  EXPECT_EQ(prepare("--material left=" + path("masks/part1.nrrd") +
                    " --material right=" + path("others/part1.nrrd"))
                .status,
            0);
}

TEST_F(Masks, ThatOverlapAreReported) {
  write_mask("all.nrrd", [](MaterialTag label) { return label != 0; });
  const std::string both = path("all.nrrd") + " " + path("masks/part2.nrrd");
  const Answer later = prepare(both);
  EXPECT_EQ(later.status, 0) << later.err;
  EXPECT_NE(later.err.find("voxels in several masks, in 1 pair, most in 'all' and 'part2'"),
            std::string::npos)
      << later.err;
  EXPECT_EQ(stats().at("overlaps").size(), 1u);
  const Answer refused = prepare(both + " --on-overlap error");
  EXPECT_EQ(refused.status, 3);
  EXPECT_NE(refused.err.find("the masks 'all' and 'part2' overlap in "), std::string::npos) << refused.err;
  // All of the later one belongs to the first one.
  const Answer first = prepare(both + " --on-overlap first");
  EXPECT_NE(first.err.find("mask without a voxel that does not belong to others: 'part2'"), std::string::npos)
      << first.err;
  EXPECT_EQ(prepare(path("organs.nrrd") + " --on-overlap first").status, 2);
}

TEST_F(Masks, ThatAreEmptyAreNoted) {
  write_mask("masks/absent.nrrd", [](MaterialTag) { return false; });
  write("masks/statistics.json", "{}");
  write("masks/liver.stl", "");
  const Answer a = mesh(path("masks"));
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_NE(a.err.find("1 mask without a voxel: 'absent' (not in the mesh)"), std::string::npos) << a.err;
  EXPECT_NE(a.err.find("1 file that is no mask, liver.stl (not read)"), std::string::npos) << a.err;
  const Answer none = prepare("--material nothing=" + path("masks/absent.nrrd"));
  EXPECT_EQ(none.status, 4);
  EXPECT_NE(none.err.find("no mask has a voxel"), std::string::npos) << none.err;
}

TEST_F(Masks, AFolderMayHavePairsOfFiles) {
  // NIfTI: a header of 348 bytes in one file and 2 x 1 x 1 voxels in the other.
  std::filesystem::create_directory(folder_ / "pairs");
  std::string header(348, '\0');
  const auto set16 = [&](std::size_t at, int value) {
    header[at] = static_cast<char>(value & 0xff);
    header[at + 1] = static_cast<char>(value >> 8);
  };
  set16(0, 348);
  for (const auto& [axis, n] : {std::pair{0, 3}, {1, 8}, {2, 8}, {3, 8}})
    set16(40 + 2 * static_cast<std::size_t>(axis), n);
  set16(70, 2);  // bytes
  set16(72, 8);
  const float one = 1;
  for (std::size_t k = 1; k <= 3; ++k) std::memcpy(header.data() + 76 + 4 * k, &one, sizeof one);
  header.replace(344, 4, std::string("ni1\0", 4));
  const std::string names = "pqrs";
  for (std::size_t k = 0; k < names.size(); ++k) {
    write(std::string("pairs/") + names[k] + ".hdr", header);
    std::string voxels(512, '\0');
    for (std::size_t i = 128 * k; i < 128 * (k + 1); ++i) voxels[i] = 1;
    write(std::string("pairs/") + names[k] + ".img", voxels);
  }
  const Answer a = run("mesh " + path("pairs") + " -o " + path("out.vtu") + " --stats " + path("s.json") +
                       " --on-overlap error");
  EXPECT_EQ(a.status, 0) << a.err;
  const nlohmann::json labels = stats().at("input").at("volume").at("labels");
  ASSERT_EQ(labels.size(), names.size());
  for (std::size_t k = 0; k < names.size(); ++k) EXPECT_EQ(labels[k].at("name"), std::string(1, names[k]));
}

TEST_F(Masks, WrongInputsAreRefused) {
  const std::string mask = path("masks/part1.nrrd");
  const Answer several = prepare(mask + " " + path("organs.nrrd"));
  EXPECT_EQ(several.status, 3);
  EXPECT_NE(several.err.find("organs.nrrd: has the labels "), std::string::npos) << several.err;
  LabelVolume small = organs_;
  small.origin[0] += 1;
  for (MaterialTag& label : small.labels) label = label != 0;
  write_label_volume(small, path("shifted.nrrd"));
  const Answer grids = prepare(mask + " " + path("shifted.nrrd"));
  EXPECT_EQ(grids.status, 3);
  EXPECT_NE(grids.err.find("shifted.nrrd: its grid, "), std::string::npos) << grids.err;
  write("two.txt", "1 part1\n");
  const Answer names = prepare(mask + " " + path("masks/part2.nrrd") + " --label-names " + path("two.txt"));
  EXPECT_EQ(names.status, 3);
  EXPECT_NE(names.err.find("two.txt: has no label called 'part2'"), std::string::npos) << names.err;
  EXPECT_EQ(prepare("--material all=" + path("masks")).status, 2);
  std::filesystem::create_directory(folder_ / "empty");
  const Answer empty = prepare(path("empty"));
  EXPECT_EQ(empty.status, 2);
  EXPECT_NE(empty.err.find("empty: there is no volume in this folder"), std::string::npos) << empty.err;
  write("masks/slice.tif", "");
  const Answer mixed = prepare(path("masks"));
  EXPECT_EQ(mixed.status, 2);
  EXPECT_NE(mixed.err.find("has slices (.tif) and other volumes, such as part1.nrrd"), std::string::npos)
      << mixed.err;
}

TEST_F(Masks, OverlappingSegmentsAreLayers) {
  // As 3D Slicer writes them: two segments in two layers, interleaved.
  const std::string header =
      "NRRD0004\ntype: unsigned char\ndimension: 4\nspace: left-posterior-superior\nsizes: 2 8 8 8\n"
      "space directions: none (1,0,0) (0,1,0) (0,0,1)\nkinds: list domain domain domain\nencoding: raw\n"
      "space origin: (0,0,0)\nSegment0_Name:=liver\nSegment0_LabelValue:=1\nSegment0_Layer:=0\n"
      "Segment1_Name:=tumour\nSegment1_LabelValue:=1\nSegment1_Layer:=1\n\n";
  std::string voxels;
  for (int z = 0; z < 8; ++z)
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x) {
        voxels += static_cast<char>(x < 6);
        voxels += static_cast<char>(x >= 4 && x < 7);
      }
  write("s.seg.nrrd", header + voxels);
  const Answer a = prepare(path("s.seg.nrrd"));
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_NE(a.err.find("128 voxels in several masks, in 1 pair, most in 'liver' and 'tumour' (128)"),
            std::string::npos)
      << a.err;
  nlohmann::json volume = stats().at("input").at("volume");
  ASSERT_EQ(volume.at("labels").size(), 2u);
  EXPECT_EQ(volume.at("labels")[0].at("voxels"), 4 * 64);
  EXPECT_EQ(volume.at("labels")[1].at("voxels"), 3 * 64);
  EXPECT_EQ(prepare("--material organ=" + path("s.seg.nrrd")).status, 2);
  write("cut.seg.nrrd", header + voxels.substr(0, 500));
  EXPECT_EQ(prepare(path("cut.seg.nrrd")).status, 3);
}

}  // namespace
}  // namespace tetwright::masks_test
