// SPDX-License-Identifier: Apache-2.0

// Tests the values of images through the program: fields, masks, spaces, bins and moduli.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>

#include "tests/tools/program.h"
#include "tetwright/io.h"

namespace tetwright::values_test {
namespace {

constexpr std::array<int, 3> grid_size{14, 13, 12};

LabelVolume volume_of(const std::function<MaterialTag(const Vec3&)>& value) {
  LabelVolume volume;
  volume.size = grid_size;
  volume.space = "left-posterior-superior";
  volume.origin = Vec3(3, -2, 5);
  volume.directions = Vec3(1, 1, 0.8).asDiagonal();
  for (int z = 0; z < grid_size[2]; ++z)
    for (int y = 0; y < grid_size[1]; ++y)
      for (int x = 0; x < grid_size[0]; ++x) volume.labels.push_back(value(Vec3(x, y, z)));
  return volume;
}

/// A ball, of bone in its half towards low x and of flesh in the other one.
MaterialTag label_at(const Vec3& index) {
  return (index - Vec3(6.5, 6, 5.5)).norm() > 4.6 ? 0 : index.x() < 6.5 ? 1 : 2;
}

class Values : public testing::Test {
 protected:
  Values() {
    write_label_volume(volume_of(label_at), path("labels.nrrd"));
    write_file_atomically(path("names.txt"), "1 bone\n2 flesh\n");
    write_image("ramp.nrrd", [](const Vec3& index) { return 100 * index.x() + 7 * index.z(); });
    write_image("ct.nrrd", [](const Vec3& index) { return label_at(index) == 1 ? 1000 : -1000; });
  }
  std::string path(const std::string& file) const { return folder_ / file; }
  LabelVolume write_image(const std::string& file, const std::function<double(const Vec3&)>& value) const {
    LabelVolume image = volume_of([&](const Vec3& p) { return static_cast<MaterialTag>(value(p)); });
    write_label_volume(image, path(file));
    return image;
  }
  Answer prepare(const std::string& more, const std::string& out = "out.vtu") const {
    return run("prepare " + path("labels.nrrd") + " --label-names " + path("names.txt") +
               " --target-tets 800 -o " + path(out) + " --stats " + path("s.json") + " " + more);
  }
  nlohmann::json stats() const { return nlohmann::json::parse(contents(path("s.json"))); }
  TetMesh mesh(const std::string& file = "out.vtu") const { return read_tet_mesh(path(file)).mesh; }

  TemporaryFolder folder_;
};

const MeshField* field(const std::vector<MeshField>& fields, const std::string& name) {
  for (const MeshField& f : fields)
    if (f.name == name) return &f;
  return nullptr;
}

Vec3 centroid(const TetMesh& mesh, std::size_t t) {
  Vec3 sum = Vec3::Zero();
  for (const Index p : mesh.tets[t]) sum += mesh.points[p] / 4;
  return sum;
}

/// Value of ramp.nrrd.
double ramp(const Vec3& p) { return 100 * (p.x() - 3) + 7 * (p.z() - 5) / 0.8; }

void expect_ramp(const TetMesh& mesh, const std::string& name) {
  const MeshField* tets = field(mesh.cell_fields, name);
  const MeshField* points = field(mesh.point_fields, name);
  ASSERT_TRUE(tets && points);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    EXPECT_NEAR(tets->values[t], ramp(centroid(mesh, t)), 1e-6);
  for (std::size_t p = 0; p < mesh.points.size(); ++p)
    EXPECT_NEAR(points->values[p], ramp(mesh.points[p]), 1e-6);
}

TEST_F(Values, AreFieldsOfEveryTetAndPoint) {
  const Answer a = prepare("--values hu=" + path("ramp.nrrd") + " --values-statistics min,max,deviation");
  ASSERT_EQ(a.status, 0) << a.err;
  EXPECT_EQ(a.err.find("note"), std::string::npos) << a.err;
  expect_ramp(mesh(), "hu");
  const TetMesh result = mesh();
  for (std::size_t t = 0; t < result.tets.size(); ++t) {
    const auto at = [&](const char* name) { return field(result.cell_fields, name)->values[t]; };
    EXPECT_LE(at("hu_min"), at("hu"));
    EXPECT_GE(at("hu_max"), at("hu"));
    EXPECT_GT(at("hu_deviation"), 0);
  }
  const nlohmann::json values = stats().at("values").at(0);
  EXPECT_EQ(values.at("name"), "hu");
  EXPECT_EQ(values.at("partly_outside").at("count"), 0);
  EXPECT_EQ(values.at("image_max"), 100 * 13 + 7 * 11);
  EXPECT_NEAR(values.at("mean").get<double>(), 100 * 6.5 + 7 * 5.5, 20);
}

TEST_F(Values, CanBeAddedToAMeshThatStaysAsItIs) {
  ASSERT_EQ(prepare("--values before=" + path("ct.nrrd")).status, 0);
  const TetMesh before = mesh();
  const Answer a = run("values " + path("out.vtu") + " " + path("ramp.nrrd") + " hu=" + path("ramp.nrrd") +
                       " -o " + path("added.vtu") + " --stats " + path("s.json"));
  ASSERT_EQ(a.status, 0) << a.err;
  EXPECT_EQ(a.err.find("space"), std::string::npos) << a.err;  // both name the same one
  const TetMesh after = mesh("added.vtu");
  EXPECT_EQ(after.points, before.points);
  EXPECT_EQ(after.tets, before.tets);
  EXPECT_EQ(after.materials, before.materials);
  ASSERT_TRUE(field(after.cell_fields, "before"));
  EXPECT_EQ(field(after.cell_fields, "before")->values, field(before.cell_fields, "before")->values);
  expect_ramp(after, "hu");
  expect_ramp(after, "ramp");
  EXPECT_EQ(stats().at("command"), "values");
  // The output may be the input, and a field of the same name is replaced.
  ASSERT_EQ(
      run("values " + path("out.vtu") + " before=" + path("ramp.nrrd") + " -o " + path("out.vtu")).status, 0);
  expect_ramp(mesh(), "before");
}

TEST_F(Values, OfASimplifiedMeshAreThoseOfItsTets) {
  ASSERT_EQ(prepare("").status, 0);
  for (const std::string& command : {std::string("simplify --target-tets 400 "), std::string("improve ")}) {
    const Answer a =
        run(command + path("out.vtu") + " --values hu=" + path("ramp.nrrd") + " -o " + path("less.vtu"));
    ASSERT_EQ(a.status, 0) << a.err;
    expect_ramp(mesh("less.vtu"), "hu");
  }
  ASSERT_EQ(
      run("mesh " + path("labels.nrrd") + " --values hu=" + path("ramp.nrrd") + " -o " + path("dense.vtu"))
          .status,
      0);
  expect_ramp(mesh("dense.vtu"), "hu");
}

TEST_F(Values, CountOnlyVoxelsOfTheMask) {
  const auto range_in_bone = [&](const std::string& more) {
    const Answer a = prepare("--values hu=" + path("ct.nrrd") + more);
    EXPECT_EQ(a.status, 0) << a.err;
    const TetMesh result = mesh();
    std::pair<double, double> range(1e9, -1e9);
    for (std::size_t t = 0; t < result.tets.size(); ++t) {
      if (result.materials[t] != 1) continue;
      const double value = field(result.cell_fields, "hu")->values[t];
      range = {std::min(range.first, value), std::max(range.second, value)};
    }
    return range;
  };
  EXPECT_LT(range_in_bone("").first, 500);
  EXPECT_EQ(range_in_bone(" --values-mask labels"), std::pair(1000.0, 1000.0));
  write_image("bone.nrrd", [](const Vec3& index) { return label_at(index) == 1 ? 9 : 0; });
  EXPECT_EQ(range_in_bone(" --values-mask " + path("bone.nrrd")), std::pair(1000.0, 1000.0));
  const Answer flesh = prepare("--values hu=" + path("ct.nrrd") + " --values-mask " + path("bone.nrrd"));
  EXPECT_NE(
      flesh.err.find("tets without a voxel that counts (they have the value of the nearest one of the mask)"),
      std::string::npos)
      << flesh.err;
  EXPECT_GT(stats().at("values").at(0).at("nearest").at("count"), 0);
  EXPECT_EQ(stats().at("values").at(0).at("nearest").at("first").size(), 3u);
}

TEST_F(Values, AreTakenInTheSpaceOfTheMesh) {
  LabelVolume image =
      volume_of([](const Vec3& p) { return static_cast<MaterialTag>(100 * p.x() + 7 * p.z()); });
  ASSERT_TRUE(change_space(image, "right-anterior-superior"));
  write_label_volume(image, path("ras.nrrd"));
  const Answer a = prepare("--values hu=" + path("ras.nrrd"));
  ASSERT_EQ(a.status, 0) << a.err;
  EXPECT_NE(a.err.find("(brought into that of the mesh, left-posterior-superior)"), std::string::npos)
      << a.err;
  expect_ramp(mesh(), "hu");
}

TEST_F(Values, OfAnImageElsewhereAreRefused) {
  LabelVolume image = volume_of([](const Vec3&) { return 1; });
  image.origin.x() += 100;
  write_label_volume(image, path("far.nrrd"));
  expect_refused("prepare " + path("labels.nrrd") +
                     " --quiet --target-tets 800 --values hu=" + path("far.nrrd") + " -o " + path("no.vtu"),
                 3, {"far.nrrd", "no part of the image is in ", "(102.5, -2.5, 4.6) to (116.5, 10.5, 14.2)"});
  EXPECT_FALSE(std::filesystem::exists(path("no.vtu")));
  // Half of it.
  image.origin.x() = 12;
  write_label_volume(image, path("half.nrrd"));
  const Answer half = prepare("--values hu=" + path("half.nrrd"));
  EXPECT_EQ(half.status, 0);
  EXPECT_NE(half.err.find("tets with a part outside the image (this part does not count)"), std::string::npos)
      << half.err;
  EXPECT_NE(half.err.find("tets without a voxel that counts (they have the value of the nearest one)"),
            std::string::npos);
  const TetMesh result = mesh();
  for (const double value : field(result.cell_fields, "hu")->values) EXPECT_EQ(value, 1);
}

TEST_F(Values, DivideTheTetsIntoBins) {
  const std::string bins = "--values hu=" + path("ramp.nrrd") + " --bins hu=4";
  ASSERT_EQ(prepare(bins).status, 0);
  const nlohmann::json all = stats().at("bins").at(0);
  EXPECT_EQ(all.at("values"), "hu");
  ASSERT_EQ(all.at("each").size(), 8u);
  std::size_t tets = 0;
  double mean = -1e9;
  for (const nlohmann::json& bin : all.at("each")) {
    tets += bin.at("tets").get<std::size_t>();
    if (bin.at("bin") == 1) mean = -1e9;
    EXPECT_GT(bin.at("mean"), mean);
    mean = bin.at("mean");
    EXPECT_LE(bin.at("low"), mean);
    EXPECT_GE(bin.at("high"), mean);
  }
  EXPECT_EQ(tets, mesh().tets.size());
  ASSERT_TRUE(field(mesh().cell_fields, "hu_bin"));
  const std::string table = contents(path("out_bins.csv"));
  EXPECT_EQ(table.rfind("name,material,bin,low,high,tets,volume,mean\nbone_001,bone,1,", 0), 0u) << table;
  // Materials and surfaces in other formats are as without bins.
  const Answer abaqus = prepare(bins + " --modulus hu=6850,1.49,0.001,0.05 --min-modulus 10", "out.inp");
  EXPECT_EQ(abaqus.status, 0) << abaqus.err;
  const std::string text = contents(path("out.inp"));
  for (const char* part :
       {"ELSET=bone\n", "*ELSET, ELSET=bone_004\n", "*SOLID SECTION, ELSET=flesh_001, MATERIAL=flesh_001\n",
        "*SURFACE, NAME=bone_flesh, TYPE=ELEMENT\n"})
    EXPECT_NE(text.find(part), std::string::npos) << part;
  EXPECT_EQ(text.find("NAME=bone_001_"), std::string::npos);
  EXPECT_NE(contents(path("out_bins.csv")).find(",modulus,poisson\n"), std::string::npos);
  EXPECT_NEAR(
      stats().at("bins").at(0).at("each").at(0).at("modulus").get<double>(),
      6850 *
          std::pow(0.001 * stats().at("bins").at(0).at("each").at(0).at("mean").get<double>() + 0.05, 1.49),
      1e-6);
  const Answer medit = prepare(bins, "out.mesh");
  EXPECT_NE(medit.err.find("8 sets of bins (not written; .mesh cannot hold them, but the table can)"),
            std::string::npos)
      << medit.err;
  const Answer vtu = prepare(bins + " --modulus hu=1,1");
  EXPECT_NE(vtu.err.find("8 elastic moduli of bins (not written"), std::string::npos) << vtu.err;
}

TEST_F(Values, DivideTheTetsOfEachMaterialByEachImage) {
  const std::string more = "--values hu=" + path("ramp.nrrd") + " --values ct=" + path("ct.nrrd") +
                           " --bins ct=0.0 --bins hu=3 --modulus hu=1,1 --min-modulus 1";
  const Answer a = prepare(more, "out.inp");
  ASSERT_EQ(a.status, 0) << a.err;
  ASSERT_EQ(stats().at("bins").size(), 2u);
  EXPECT_EQ(stats().at("bins").at(0).at("values"), "ct");
  EXPECT_FALSE(stats().at("bins").at(0).contains("poisson"));
  EXPECT_EQ(stats().at("bins").at(1).at("each").at(0).at("name"), "bone_hu_001");
  const std::string text = contents(path("out.inp"));
  for (const char* part : {"*ELSET, ELSET=bone_ct_001\n", "*ELSET, ELSET=flesh_hu_003\n",
                           "*SOLID SECTION, ELSET=bone_hu_001, MATERIAL=bone_hu_001\n"})
    EXPECT_NE(text.find(part), std::string::npos) << part;
  EXPECT_EQ(text.find("MATERIAL=bone_ct"), std::string::npos);
  EXPECT_NE(contents(path("out_bins.csv")).find("\nbone_hu_001,hu,bone,1,"), std::string::npos);
  ASSERT_EQ(prepare(more).status, 0);
  EXPECT_TRUE(field(mesh().cell_fields, "hu_bin") && field(mesh().cell_fields, "ct_bin"));
  const Answer msh = prepare(more + " --output-format msh22", "out.msh");
  EXPECT_NE(msh.err.find("sets of bins of ct (not written; an element is in one group"), std::string::npos)
      << msh.err;
}

TEST_F(Values, ImpossibleOnesEndTheCallBeforeItMeshes) {
  const auto stage_of_error = [&](const std::string& more, int status, const std::string& text) {
    const Answer a = prepare(more, "no.inp");
    EXPECT_EQ(a.status, status) << more << a.err;
    EXPECT_NE(a.err.find(text), std::string::npos) << a.err;
    return stats().at("error").at("stage").get<std::string>();
  };
  const std::string values = "--values hu=" + path("ramp.nrrd");
  EXPECT_EQ(stage_of_error(values + " --bins hu=3 --modulus hu=1,1,0,-5", 2, "have moduli from 0 to 0"),
            "read");
  // Only voxels of the labels count, whose values are above 0 or below.
  EXPECT_EQ(stage_of_error("--values hu=" + path("ct.nrrd") + " --labels 2 --values-mask labels --bins hu=2" +
                               " --modulus hu=1,1",
                           2, "from -1000 to -1000"),
            "read");
  write_image("empty.nrrd", [](const Vec3&) { return 0; });
  EXPECT_EQ(stage_of_error(values + " --values-mask " + path("empty.nrrd"), 3, "has no voxel other than 0"),
            "read images");
  LabelVolume far = volume_of([](const Vec3&) { return 1; });
  far.origin.x() += 100;
  write_label_volume(far, path("far.nrrd"));
  EXPECT_EQ(stage_of_error(values + " --values-mask " + path("far.nrrd"), 3, "has no voxel that counts"),
            "read");
  // Some values have no modulus: whether a bin has such a mean is known after meshing.
  const Answer some = prepare(values + " --bins hu=3 --modulus hu=1,1,1,-400", "no.inp");
  EXPECT_EQ(some.status, 2);
  EXPECT_NE(some.err.find("bone_001"), std::string::npos) << some.err;
  EXPECT_NE((some.out + some.err).find("have moduli from 0 to "), std::string::npos) << some.out << some.err;
}

TEST_F(Values, DoNotReplaceFieldsOfOtherNames) {
  const std::string values = "--values q=" + path("ramp.nrrd") + " --values q_bin=" + path("ct.nrrd");
  EXPECT_EQ(prepare(values).status, 0);
  const Answer both = prepare(values + " --bins q=3");
  EXPECT_EQ(both.status, 2);
  EXPECT_NE(both.err.find("'q_bin' would belong both"), std::string::npos) << both.err;
  // Nor those of a mesh, unless it has the values, too.
  ASSERT_EQ(prepare("--values q_bin=" + path("ct.nrrd")).status, 0);
  for (const std::string& command :
       {"values " + path("out.vtu") + " q=" + path("ramp.nrrd"),
        "simplify " + path("out.vtu") + " --target-tets 400 --quiet --values q=" + path("ramp.nrrd")})
    expect_refused(command + " --bins q=3 -o " + path("no.vtu"), 2, {"has a field 'q_bin' already", "q_2="});
  ASSERT_EQ(prepare("--values q=" + path("ramp.nrrd") + " --bins q=3").status, 0);
  const Answer again =
      run("values " + path("out.vtu") + " q=" + path("ct.nrrd") + " --bins q=2 -o " + path("out.vtu"));
  EXPECT_EQ(again.status, 0);
  EXPECT_NE(again.err.find("cell field 'q_bin' (replaced by the bins of "), std::string::npos) << again.err;
}

TEST_F(Values, DoNotDependOnTheNumberOfThreads) {
  const std::string more =
      "--values hu=" + path("ct.nrrd") + " --values-mask labels --bins hu=3 --values-statistics deviation";
  ASSERT_EQ(prepare(more + " --threads 1", "a.inp").status, 0);
  ASSERT_EQ(prepare(more + " --threads 4", "b.inp").status, 0);
  EXPECT_TRUE(contents(path("a.inp")) == contents(path("b.inp")));
  EXPECT_EQ(contents(path("a_bins.csv")), contents(path("b_bins.csv")));
}

TEST_F(Values, WrongCallsAreRefused) {
  const std::string call = "prepare " + path("labels.nrrd") + " --label-names " + path("names.txt") +
                           " --quiet --target-tets 800 -o " + path("no.inp") + " ";
  const std::string values = call + "--values hu=" + path("ramp.nrrd") + " ";
  expect_refused(call + "--bins hu=3", 2, {"--bins is for the values of an image; give --values NAME=IMAGE"});
  expect_refused(values + "--bins ct=3", 2, {"--bins ct: no image has this name"});
  expect_refused(values + "--bins hu=0", 2, {"--bins"});
  expect_refused(values + "--bins hu=3,2", 2, {"must ascend"});
  expect_refused(values + "--modulus hu=1,1", 2, {"give --bins"});
  expect_refused(values + "--bins hu=3 --modulus hu=1", 2, {"is not A,B or A,B,S,T"});
  expect_refused(values + "--bins hu=3 --min-modulus 1", 2, {"--min-modulus is for --modulus"});
  expect_refused(values + "--bins hu=3 --modulus hu=-1,1", 2, {"--modulus", "'-1'"});
  expect_refused(values + "--bins hu=3 --modulus hu=1,1 --modulus ct=1,1", 2,
                 {"--modulus", "only one is possible in a call"});
  expect_refused(values + "--bins hu=3 --bins hu=2", 2, {"--bins hu was given twice"});
  expect_refused(values + "--values hu=" + path("ct.nrrd"), 2,
                 {"ramp.nrrd and ", "ct.nrrd are two images called 'hu'", " hu_2="});
  expect_refused(values + "--values-statistics mean", 2, {"'mean' is not one of min, max, deviation"});
  expect_refused(call + "--values hu=" + path("absent.nrrd"), 3, {"absent.nrrd"});
  ASSERT_EQ(prepare("").status, 0);
  expect_refused(
      "values " + path("out.vtu") + " " + path("ct.nrrd") + " --values-mask labels -o " + path("no.vtu"), 2,
      {"--values-mask labels is for the segmented volume"});
  expect_refused("values " + path("out.vtu") + " -o " + path("no.vtu"), 2, {"IMAGE"});
  // The table of bins would replace an input.
  std::filesystem::copy_file(path("out.vtu"), path("no_bins.csv"));
  expect_refused(call + "--values hu=" + path("no_bins.csv") + " --bins hu=2", 2, {"no_bins.csv"});
}

}  // namespace
}  // namespace tetwright::values_test
