// SPDX-License-Identifier: Apache-2.0

// Tests segmented volumes through the program.
#include <gtest/gtest.h>

#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/samples/samples.h"
#include "tests/tools/program.h"
#include "tetwright/io.h"

namespace tetwright::volumes_test {
namespace {

class Volumes : public testing::Test {
 protected:
  Volumes() { write_label_volume(std::get<LabelVolume>(make_sample("organs")), path("organs.nrrd")); }
  std::string path(const std::string& name) const { return folder_ / name; }
  std::string mesh(const std::string& inputs) const {
    return "mesh " + inputs + " -o " + path("out.vtu") + " --stats " + path("s.json");
  }

  /// Expects the status, one line on stderr that contains each of `said`, and no new file except statistics.
  void expect_refused(const std::string& inputs, int status, const std::vector<std::string>& said) const {
    std::filesystem::remove(path("s.json"));
    const std::size_t files = folder_.entries();
    const Answer a = run(mesh(inputs));
    EXPECT_EQ(a.status, status) << inputs << '\n' << a.err;
    EXPECT_EQ(a.out, "") << inputs;
    EXPECT_EQ(a.err.rfind("tetwright: ", 0), 0u) << a.err;
    EXPECT_EQ(std::count(a.err.begin(), a.err.end(), '\n'), 1) << a.err;
    for (const std::string& s : said) EXPECT_NE(a.err.find(s), std::string::npos) << a.err << "lacks: " << s;
    std::filesystem::remove(path("s.json"));
    EXPECT_EQ(folder_.entries(), files) << inputs;
  }

  /// Writes an NRRD of 2 x 2 x 2 voxels of one byte, with header lines replaced or added.
  std::string write_small(const std::string& name, const std::string& type, const std::string& more,
                          const std::string& body) const {
    put(path(name), "NRRD0004\ntype: " + type + "\nencoding: raw\nendian: little\n" + more + "\n" + body);
    return path(name);
  }

  TemporaryFolder folder_;
};

/// Cells of almost three voxels, which do not preserve volumes. The tests that use them do not depend on the
/// cell size.
const std::string coarse = " --voxel-size 2 --uniform --accept-changes";
const std::string cube = "dimension: 3\nsizes: 2 2 2\n";

TEST_F(Volumes, NamesOfTheFileAreTaken) {
  const std::string file = write_small(
      "named.seg.nrrd", "uchar",
      cube + "Segment0_Name:=outside\nSegment0_LabelValue:=1\nSegment1_Name:=a\nSegment1_LabelValue:=2\n",
      "\1\1\1\1\2\2\2\2");
  const Answer a = run(mesh(file) + " --min-voxels 1 --accept-changes --resolution 8");
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_NE(a.out.find("2 labels: 1 'outside_2', 2 'a'"), std::string::npos) << a.out;
}

TEST_F(Volumes, PrepareSaysFirstWhatItWillTake) {
  const std::string small = write_small("small.nrrd", "uchar", cube, "\1\1\1\1\2\2\2\2");
  const auto lines = [&](const std::string& command) {
    const std::string expected = " dense tets, which take about ";
    const std::string err = run(command + small + " --min-voxels 1 --resolution 8 -o " + path("out.vtu")).err;
    std::size_t count = 0;
    for (std::size_t at = err.find(expected); at != std::string::npos; at = err.find(expected, at + 1))
      ++count;
    if (count > 0) {
      EXPECT_EQ(err.rfind("tetwright: about ", 0), 0u) << err;
    }
    return count;
  };
  EXPECT_EQ(lines("prepare --target-tets 200 "), 1u);
  EXPECT_EQ(lines("prepare --target-tets 200 --quiet "), 0u);
  EXPECT_EQ(lines("prepare --target-tets 200 --progress json "), 0u);
  EXPECT_EQ(lines("mesh "), 0u);
}

TEST_F(Volumes, ReportAndStatistics) {
  const Answer a = run(mesh(path("organs.nrrd")) + coarse);
  ASSERT_EQ(a.status, 0) << a.err;
  EXPECT_NE(a.out.find("volume 48 x 48 x 48 voxels of 0.75 x 0.75 x 1.25, space left-posterior-superior; "
                       "5 labels: 1 'label_1', "),
            std::string::npos)
      << a.out;
  const auto stats = nlohmann::json::parse(contents(path("s.json")));
  const auto volume = stats["input"]["volume"];
  EXPECT_EQ(volume["size"], nlohmann::json({48, 48, 48}));
  EXPECT_EQ(volume["spacing"], nlohmann::json({0.75, 0.75, 1.25}));
  EXPECT_EQ(volume["directions"], nlohmann::json({{0.75, 0.0, 0.0}, {0.0, 0.75, 0.0}, {0.0, 0.0, 1.25}}));
  EXPECT_EQ(volume["space"], "left-posterior-superior");
  EXPECT_GT(volume["merged_islands"], 0);
  ASSERT_EQ(volume["labels"].size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) {
    const auto label = volume["labels"][i];
    EXPECT_EQ(label["tag"], i + 1);
    const double expected = label["volume"];
    EXPECT_NEAR(expected, label["voxels"].get<double>() * 0.75 * 0.75 * 1.25, 1e-9 * expected);
  }
  // There are interfaces between materials and on the boundary.
  const auto interfaces = stats["result"]["interfaces"];
  EXPECT_EQ(stats["dense"]["interfaces"], interfaces);
  EXPECT_GT(interfaces.size(), 4u);
  EXPECT_GT(stats["result"]["junction_edges"], 0);
  EXPECT_TRUE(std::any_of(interfaces.begin(), interfaces.end(),
                          [](const auto& i) { return i["materials"][1].is_null(); }));
  // `check` counts the same interfaces in the file.
  const auto checked = nlohmann::json::parse(run("check --json " + path("out.vtu")).out)["mesh"];
  EXPECT_EQ(checked["interfaces"], interfaces);
  EXPECT_EQ(checked["junction_edges"], stats["result"]["junction_edges"]);
}

TEST_F(Volumes, TheFieldsThatWereMeshed) {
  // Without the skin: level sets of a sheet thinner than a cell have hardly any volume.
  const std::string cells = " --voxel-size 1 --uniform";
  const std::string organs = mesh(path("organs.nrrd")) + cells + " --labels 1-3,5";
  ASSERT_EQ(run(organs + " --write-sdf " + path("fields.vdb")).status, 0);
  const auto first = nlohmann::json::parse(contents(path("s.json")))["result"]["materials"];
  ASSERT_EQ(run(mesh(path("fields.vdb")) + cells + " --accept-changes").status, 0);
  const auto again = nlohmann::json::parse(contents(path("s.json")))["result"];
  ASSERT_EQ(again["materials"].size(), first.size());
  for (std::size_t m = 0; m < first.size(); ++m) {
    const double volume = first[m]["volume"];
    EXPECT_EQ(again["materials"][m]["name"], first[m]["name"]);
    EXPECT_NEAR(again["materials"][m]["volume"].get<double>(), volume, 0.08 * volume)
        << m;  // ten cells thick
  }
}

TEST_F(Volumes, GridsOfOpenVdb) {
  openvdb::initialize();
  const auto organs = std::get<LabelVolume>(make_sample("organs"));
  const auto grid = openvdb::Int32Grid::create(0);
  std::size_t n = 0;
  for (int k = 0; k < organs.size[2]; ++k)
    for (int j = 0; j < organs.size[1]; ++j)
      for (int i = 0; i < organs.size[0]; ++i) grid->tree().setValue({i, j, k}, organs.labels[n++]);
  openvdb::Mat4d matrix = openvdb::Mat4d::identity();
  for (int a = 0; a < 3; ++a) matrix(a, a) = organs.directions(a, a), matrix(3, a) = organs.origin[a];
  grid->setTransform(openvdb::math::Transform::createLinearTransform(matrix));
  grid->setName("segments");
  const auto write = [&](const openvdb::GridPtrVec& grids) {
    openvdb::io::File(path("organs.vdb")).write(grids);
  };
  write({grid});
  ASSERT_EQ(run(mesh(path("organs.nrrd")) + coarse).status, 0);
  TetMesh as_nrrd = read_tet_mesh(path("out.vtu")).mesh;
  EXPECT_EQ(std::exchange(as_nrrd.space, {}), "left-posterior-superior");  // .vdb files do not name it
  write_tet_mesh(as_nrrd, path("nrrd.vtu"));
  const Answer a = run(mesh(path("organs.vdb")) + coarse + " --labels 1-9");
  ASSERT_EQ(a.status, 0) << a.err;
  EXPECT_TRUE(contents(path("out.vtu")) == contents(path("nrrd.vtu")));
  EXPECT_EQ(nlohmann::json::parse(contents(path("s.json")))["input"]["volume"]["space"], "unknown");
  expect_refused(path("organs.vdb") + " --layer skin=1", 2, {"--layer", "segmented volume"});
  expect_refused(path("organs.vdb") + " " + path("organs.nrrd"), 2, {"cannot be meshed together"});
  expect_refused("--material m=" + path("organs.vdb"), 3, {"no level set", "segments (no class, int32)"});
  const auto other = grid->deepCopy();
  other->setName("others");
  write({grid, other});
  expect_refused(path("organs.vdb"), 3, {"2 grids", "'segments', 'others'"});
  write({openvdb::GridBase::createGrid("Tree_vec3s_5_4_3")});
  expect_refused(path("organs.vdb"), 3, {"no level set", "no grid of whole numbers", "vec3s"});
}

TEST_F(Volumes, BodiesThatDoNotFit) {
  const std::string whole = contents(path("organs.nrrd"));
  for (const double share : {0.1, 0.5, 0.99}) {
    put(path("cut.nrrd"),
        whole.substr(0, static_cast<std::size_t>(share * static_cast<double>(whole.size()))));
    expect_refused(path("cut.nrrd"), 3, {"cut.nrrd"});
  }
  write_small("short.nrrd", "uchar", cube, "1234567");
  expect_refused(path("short.nrrd"), 3, {"short.nrrd", "2 x 2 x 2", "8 bytes", "7", "truncated"});
  write_small("large.nrrd", "uchar", "dimension: 3\nsizes: 2000 2000 2000\n", "12345678");
  expect_refused(path("large.nrrd"), 3, {"large.nrrd", "2000", "voxels"});
  write_small("none.nrrd", "uchar", "dimension: 3\nsizes: 0 2 2\n", "");
  expect_refused(path("none.nrrd"), 3, {"none.nrrd", "0"});
}

TEST_F(Volumes, WhatIsNoLabel) {
  write_small("colours.nrrd", "uchar", "dimension: 4\nsizes: 3 2 2 2\nkinds: RGB-color space space space\n",
              std::string(24, '\1'));
  expect_refused(path("colours.nrrd"), 3, {"colours.nrrd"});
  write_small("complex.nrrd", "complex", cube, std::string(64, '\1'));
  expect_refused(path("complex.nrrd"), 3, {"complex.nrrd", "complex"});
  const float values[8] = {0, 1, 1, 1, 1, 2.5F, 1, 1};
  write_small("scan.nrrd", "float", cube, std::string(reinterpret_cast<const char*>(values), sizeof values));
  expect_refused(path("scan.nrrd"), 3, {"scan.nrrd", "voxel (1, 0, 1)", "2.5", "not a whole number"});
}

TEST_F(Volumes, SpacingAndRawFilesFromOptions) {
  // A cube of 6 x 6 x 6 voxels in the middle of 10 x 10 x 10, as integers of 16 bits in big-endian order.
  std::string voxels;
  for (int z = 0; z < 10; ++z)
    for (int y = 0; y < 10; ++y)
      for (int x = 0; x < 10; ++x) {
        const auto inside = [](int k) { return k >= 2 && k < 8; };
        voxels += std::string(1, '\0') + (inside(x) && inside(y) && inside(z) ? '\3' : '\0');
      }
  put(path("cube.raw"), voxels);
  const std::string raw = path("cube.raw") + " --dimensions 10x10x10 --voxel-type uint16be --accept-changes";
  Answer a = run(mesh(raw + " --spacing 0.5,1,2"));
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_EQ(a.err.find("spacing"), std::string::npos) << a.err;
  const Vec3 size = [&] {
    Eigen::AlignedBox3d box;
    for (const Vec3& p : read_tet_mesh(path("out.vtu")).mesh.points) box.extend(p);
    return Vec3(box.sizes());
  }();
  EXPECT_LT((size - Vec3(3, 6, 12)).cwiseQuotient(Vec3(0.5, 1, 2)).cwiseAbs().maxCoeff(), 1) << size;
  a = run(mesh(raw));
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_NE(a.err.find("1 volume whose file gives no spacing"), std::string::npos) << a.err;
  a = run(mesh(path("organs.nrrd") + coarse + " --spacing 2"));
  EXPECT_NE(a.err.find("1 volume whose file gives another spacing (that of --spacing is used)"),
            std::string::npos)
      << a.err;
  expect_refused(path("cube.raw"), 2, {"cube.raw", "--dimensions NX,NY,NZ and --voxel-type"});
  expect_refused(path("cube.raw") + " --dimensions 10,10,11 --voxel-type uint16", 3,
                 {"10 x 10 x 11 voxels of 2 bytes need 2200 bytes, but the file has 2000"});
  expect_refused(path("cube.raw") + " --dimensions 10,10 --voxel-type uint16", 2,
                 {"--dimensions", "NX,NY,NZ"});
  expect_refused(path("cube.raw") + " --dimensions 10,10,10 --voxel-type int24", 2,
                 {"--voxel-type", "int24"});
  expect_refused(path("organs.nrrd") + " --dimensions 10,10,10", 2, {"--dimensions", "no input is one"});
  expect_refused(path("organs.nrrd") + " --spacing 0", 2, {"--spacing", "'0'"});
}

TEST_F(Volumes, HeadersWithoutSense) {
  write_small("flat.nrrd", "uchar",
              cube + "space: left-posterior-superior\nspace directions: (1,0,0) (0,1,0) (1,1,0)\n",
              std::string(8, '\1'));
  expect_refused(path("flat.nrrd"), 3, {"flat.nrrd", "one plane"});
  put(path("apart.nhdr"), "NRRD0004\ntype: uchar\nencoding: raw\n" + cube + "data file: gone.raw\n\n");
  expect_refused(path("apart.nhdr"), 3, {"gone.raw"});
  put(path("apart.mhd"),
      "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\nElementDataFile = "
      "gone.raw\n");
  expect_refused(path("apart.mhd"), 3, {"gone.raw"});
  expect_refused(path("missing.nii.gz"), 3, {"missing.nii.gz"});
}

TEST_F(Volumes, LabelsThatAreNotThere) {
  expect_refused(path("organs.nrrd") + " --labels 1,77", 3, {"organs.nrrd", "77", "1", "5"});
  write_small("empty.nrrd", "uchar", cube, std::string(8, '\0'));
  expect_refused(path("empty.nrrd"), 4, {"empty.nrrd"});
  write_small("seven.nrrd", "uchar", cube, std::string(8, '\7'));
  expect_refused(path("seven.nrrd") + " --outside-label 7", 4, {"seven.nrrd"});
}

TEST_F(Volumes, ALostLabelIsStatusOneAndNamed) {
  // A block of label 1 with one voxel of label 9.
  std::string body(1000, '\1');
  body[555] = '\11';
  write_small("lost.nrrd", "uchar", "dimension: 3\nsizes: 10 10 10\n", body);
  put(path("names.txt"), "9 tumour\n");
  const Answer a = run(mesh(path("lost.nrrd")) + " --quiet --label-names " + path("names.txt"));
  EXPECT_EQ(a.status, 1);
  EXPECT_EQ(a.err.rfind("tetwright: lost 1 of 2 labels: 9 'tumour' (1 voxel at (5, 5, 5));", 0), 0u) << a.err;
  EXPECT_NE(a.err.find("--min-voxels 8"), std::string::npos) << a.err;
  EXPECT_EQ(std::count(a.err.begin(), a.err.end(), '\n'), 1) << a.err;
  const auto shortfall = nlohmann::json::parse(contents(path("s.json")))["shortfall"];
  ASSERT_EQ(shortfall.size(), 1u);
  EXPECT_EQ(shortfall[0]["what"], "labels");
  EXPECT_EQ(shortfall[0]["asked"], 2);
  EXPECT_EQ(shortfall[0]["reached"], 1);
  EXPECT_TRUE(std::filesystem::exists(path("out.vtu")));
  // It is kept on request, but its volume is not preserved.
  const Answer kept = run(mesh(path("lost.nrrd")) + " --quiet --min-voxels 1");
  EXPECT_EQ(kept.status, 1);
  EXPECT_EQ(kept.err.rfind("tetwright: not the solid of the input: 'label_9' has volume ", 0), 0u)
      << kept.err;
}

TEST_F(Volumes, LabelsAreComparedWithTheirVoxels) {
  // Two blocks, one of them hollow, and a gap of two voxels between them.
  LabelVolume volume;
  volume.size = {26, 14, 14};
  const auto in_box = [](int x, int y, int z, int low, int high) {
    return x >= low && x < high && y >= 2 && y < 12 && z >= 2 && z < 12;
  };
  for (int z = 0; z < 14; ++z)
    for (int y = 0; y < 14; ++y)
      for (int x = 0; x < 26; ++x) {
        const bool hollow = x >= 5 && x < 9 && y >= 5 && y < 9 && z >= 5 && z < 9;
        volume.labels.push_back((in_box(x, y, z, 2, 12) && !hollow) || in_box(x, y, z, 14, 24));
      }
  write_label_volume(volume, path("blocks.nrrd"));
  const auto compared = [&](const std::string& options, int status) {
    const Answer a = run(mesh(path("blocks.nrrd")) + options);
    EXPECT_EQ(a.status, status) << a.err;
    return nlohmann::json::parse(contents(path("s.json")))["fidelity"];
  };
  auto same = compared("", 0);
  ASSERT_EQ(same.size(), 2u);
  EXPECT_EQ(same[0]["against"], "voxels");
  EXPECT_EQ(same[0]["expected"]["components"], nlohmann::json({2, 2}));
  EXPECT_EQ(same[0]["expected"]["volume"], 2000 - 64);
  EXPECT_EQ(same[0]["result"]["components"], 2);
  EXPECT_EQ(same[1]["name"], "outside");
  EXPECT_EQ(same[1]["expected"]["components"], nlohmann::json({1, 1}));
  EXPECT_EQ(same[1]["result"]["components"], 1);
  EXPECT_TRUE(same[1]["same"]);
  // An outside that is meshed is not a cavity.
  EXPECT_EQ(compared(" --keep-outside", 0).size(), 1u);

  // Cells of seven voxels resolve neither the gap nor the cavity.
  const auto different = compared(" --voxel-size 7 --uniform", 1);
  EXPECT_EQ(different[0]["result"]["components"], 1);
  EXPECT_FALSE(different[0]["same"]);
  EXPECT_EQ(different[1]["result"]["components"], 0);
  EXPECT_EQ(different[1]["place"], nlohmann::json({5, 5, 5}));
  const Answer a = run(mesh(path("blocks.nrrd")) + " --voxel-size 7 --uniform");
  EXPECT_NE(a.err.find("'label_1' has 1 component instead of 2"), std::string::npos) << a.err;
  EXPECT_NE(a.err.find("'outside' has 0 parts within the labels instead of 1, the first at (5, 5, 5)"),
            std::string::npos)
      << a.err;
  EXPECT_EQ(run(mesh(path("blocks.nrrd")) + " --voxel-size 7 --uniform --accept-changes").status, 0);
}

TEST_F(Volumes, TheFileOfNamesIsNotReplaced) {
  put(path("names.vtu"), "1 body\n");
  tetwright::expect_refused(
      "mesh " + path("organs.nrrd") + " -o " + path("names.vtu") + " --label-names " + path("names.vtu"), 2,
      {"names.vtu is also an input"});
}

TEST_F(Volumes, TwoLabelsOfOneNameAreRefusedAtTheirLine) {
  put(path("names.txt"), "# organs\n2 liver\n1 body\n77 liver\n3 liver\n");
  expect_refused(path("organs.nrrd") + " --label-names " + path("names.txt"), 3,
                 {"names.txt: line 5: labels 2 and 3 are both called 'liver'", "another name"});
  put(path("names.txt"), "1 body\n2 outside\n");
  expect_refused(path("organs.nrrd") + " --label-names " + path("names.txt"), 3,
                 {"names.txt: line 2: label 2 is called 'outside'"});
}

TEST_F(Volumes, CallsThatDoNotFit) {
  write_surface(std::get<TriangleMesh>(make_sample("sphere")), path("ball.off"));
  const std::string organs = path("organs.nrrd"), ball = path("ball.off");
  for (const std::string& both : {ball + " " + organs, ball + " --material b=" + organs})
    expect_refused(both, 2, {"comes before the volume", "give volumes first"});
  expect_refused(organs + " --layer skin=1", 2, {"--layer"});
  expect_refused(organs + " --nested cavity", 2, {"--nested"});
  expect_refused(organs + " --regions outer", 2, {"--regions"});
  expect_refused(organs + " --region a@1,2,3", 2, {"--region"});
  expect_refused(ball + " --labels 1", 2, {"--labels", "segmented volumes"});
  expect_refused(ball + " --min-voxels 4", 2, {"--min-voxels", "segmented volumes"});
  expect_refused(organs + " --labels 5-1", 2, {"5-1"});
  expect_refused(organs + " --label-names " + path("none.txt"), 3, {"none.txt"});
  for (const std::string& masks : {organs + " " + organs, "--material b=" + organs})
    expect_refused(masks, 3, {"has the labels", "but a mask has one"});
}

}  // namespace
}  // namespace tetwright::volumes_test
