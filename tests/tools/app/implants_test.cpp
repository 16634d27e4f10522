// SPDX-License-Identifier: Apache-2.0

// Tests of surfaces in segmented volumes, through the program.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/mesher/test_surfaces.h"
#include "tests/tools/program.h"
#include "tetwright/io.h"
#include "tetwright/mesh_quality.h"

namespace tetwright::implants_test {
namespace {

class Implants : public testing::Test {
 protected:
  /// Two labels, 3 below and 7 above, in a block of 16^3 voxels with outside around it.
  std::string volume() const {
    LabelVolume made;
    made.size = {20, 20, 20};
    made.space = "right-anterior-superior";
    for (int z = 0; z < 20; ++z)
      for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 20; ++x) {
          const bool inside = std::min({x, y, z}) >= 2 && std::max({x, y, z}) < 18;
          made.labels.push_back(!inside ? 0 : z < 10 ? 3 : 7);
        }
    write_label_volume(made, folder_ / "labels.nrrd");
    return folder_ / "labels.nrrd";
  }
  std::string box(const std::string& name, const Vec3& low, const Vec3& high) const {
    write_surface(make_box(low, high), folder_ / name);
    return folder_ / name;
  }
  std::string block() const { return box("block.stl", Vec3(5.3, 6.2, 5.1), Vec3(12.7, 11.9, 13.8)); }
  Answer mesh(const std::string& words, const std::string& out = "out.vtu") const {
    return run("mesh " + words + " -o " + (folder_ / out) + " --stats " + (folder_ / "s.json"));
  }
  nlohmann::json stats() const { return nlohmann::json::parse(contents(folder_ / "s.json")); }
  std::map<std::string, double> volumes() const {
    std::map<std::string, double> all;
    const nlohmann::json read = stats();
    for (const nlohmann::json& m : read.at("dense").at("materials")) all[m.at("name")] = m.at("volume");
    return all;
  }

  static constexpr double block_volume = 7.4 * 5.7 * 8.7;
  TemporaryFolder folder_;
};

TEST_F(Implants, CarveLabels) {
  const Answer a = mesh(volume() + " --material implant=" + block() + " --surface-space RAS");
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_EQ(a.err, "");
  const auto is = volumes();
  EXPECT_NEAR(is.at("implant"), block_volume, 1e-4 * block_volume);
  EXPECT_NEAR(is.at("implant") + is.at("label_3") + is.at("label_7"), 16 * 16 * 16, 0.01 * 16 * 16 * 16);
  const nlohmann::json labels = stats().at("input").at("volume").at("labels");
  EXPECT_NEAR(labels[0].at("carved_voxels"), 7.4 * 5.7 * 4.4, 0.01 * 7.4 * 5.7 * 4.4);
  // The tag follows those of the labels.
  EXPECT_EQ(read_tet_mesh(folder_ / "out.vtu").mesh.material_names.at(8), "implant");
}

TEST_F(Implants, CarveMasks) {
  EXPECT_EQ(mesh(volume() + " --material implant=" + block() + " --surface-space RAS", "labels.vtu").status,
            0);
  const auto of_labels = volumes();
  for (const int label : {3, 7}) {
    LabelVolume mask = read_label_volume(folder_ / "labels.nrrd");
    for (MaterialTag& v : mask.labels) v = v == label ? 1 : 0;
    write_label_volume(mask, folder_ / ("label_" + std::to_string(label) + ".nrrd"));
  }
  EXPECT_EQ(mesh((folder_ / "label_3.nrrd") + " " + (folder_ / "label_7.nrrd") +
                 " --material implant=" + block() + " --surface-space RAS")
                .status,
            0);
  EXPECT_EQ(volumes(), of_labels);
}

TEST_F(Implants, CarveImages) {
  // A ball of radius 7, by its distance.
  std::string values;
  for (int z = 0; z < 20; ++z)
    for (int y = 0; y < 20; ++y)
      for (int x = 0; x < 20; ++x) {
        const auto d = static_cast<float>(7 - (Vec3(x, y, z) - Vec3::Constant(9.5)).norm());
        values.append(reinterpret_cast<const char*>(&d), sizeof d);
      }
  write_file_atomically(folder_ / "ball.raw", values);
  const Answer a =
      mesh((folder_ / "ball.raw") +
           " --dimensions 20,20,20 --voxel-type float32 --spacing 1,1,1 --iso ball=0 --material implant=" +
           block());
  EXPECT_EQ(a.status, 0) << a.err;
  const auto is = volumes();
  EXPECT_NEAR(is.at("implant"), block_volume, 1e-4 * block_volume);
  EXPECT_NEAR(is.at("implant") + is.at("ball"), 4.0 / 3 * M_PI * 343, 0.02 * 4.0 / 3 * M_PI * 343);
}

TEST_F(Implants, AreSimplified) {
  const Answer a = run("prepare " + volume() + " " + block() + " --surface-space RAS --target-tets 3000 -o " +
                       (folder_ / "p.msh") + " --stats " + (folder_ / "s.json"));
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_EQ(stats().at("creases").at("corners"), 8);
  EXPECT_EQ(run("check " + (folder_ / "p.msh")).status, 0);
}

// The interface of the labels crosses the rim of the face that two boxes share.
TEST_F(Implants, ContactsAcrossAnInterfaceStayFlat) {
  const std::string a = box("a.stl", Vec3(5, 5, 5), Vec3(9, 13, 14)),
                    b = box("b.stl", Vec3(9, 5, 5), Vec3(13, 13, 14));
  for (const int tets : {3000, 8000}) {
    const Answer answer =
        run("prepare " + volume() + " --material a=" + a + " --material b=" + b +
            " --surface-space RAS --target-tets " + std::to_string(tets) + " -o " + (folder_ / "p.vtu"));
    EXPECT_EQ(answer.status, 0) << answer.err;
    const TetMesh mesh = read_tet_mesh(folder_ / "p.vtu").mesh;
    double off = 0;
    std::size_t faces = 0;
    for (const InterfaceTriangle& t : find_interfaces(mesh)) {
      if (!t.other || mesh.material_names.at(t.material) != "a" || mesh.material_names.at(*t.other) != "b")
        continue;
      ++faces;
      for (const Index p : t.ids) off = std::max(off, std::fabs(mesh.points[p].x() - 9));
    }
    EXPECT_GT(faces, 0U);
    EXPECT_LT(off, 1e-6) << tets;
  }
}

// The edges of a box pass an interface of labels at a small angle, and its corners are just beyond it.
TEST_F(Implants, EdgesThatHardlyCrossAnInterface) {
  LabelVolume ball;
  ball.size = {20, 20, 20};
  ball.space = "right-anterior-superior";
  for (int z = 0; z < 20; ++z)
    for (int y = 0; y < 20; ++y)
      for (int x = 0; x < 20; ++x) {
        const double r = (Vec3(x, y, z) - Vec3::Constant(9.5)).norm();
        ball.labels.push_back(r < 4.5 ? 2 : r < 8.3 ? 1 : 0);
      }
  write_label_volume(ball, folder_ / "ball.nrrd");
  const Vec3 low(6.5, 7.2, 7.2), high(9.5, 11.8, 11.8);
  for (const int tets : {1500, 5000}) {
    const Answer a = run("prepare " + (folder_ / "ball.nrrd") + " --material box=" + box("b.stl", low, high) +
                         " --surface-space RAS --target-tets " + std::to_string(tets) + " -o " +
                         (folder_ / "p.vtu") + " --stats " + (folder_ / "s.json"));
    EXPECT_EQ(a.status, 0) << a.err;
    const nlohmann::json result = stats().at("result");
    EXPECT_LT(result.at("percent_below_threshold"), 4) << tets;
    const TetMesh mesh = read_tet_mesh(folder_ / "p.vtu").mesh;
    double off = 0;
    for (const InterfaceTriangle& t : find_interfaces(mesh)) {
      if (mesh.material_names.at(t.material) != "box" &&
          !(t.other && mesh.material_names.at(*t.other) == "box"))
        continue;
      for (const Index p : t.ids) {
        const Vec3 beyond = (low - mesh.points[p]).cwiseMax(mesh.points[p] - high);
        off = std::max(off, std::fabs(beyond.maxCoeff()));
      }
    }
    EXPECT_LT(off, 0.01) << tets;
  }
}

// A face of a box is less than a voxel from a parallel interface of labels, which lies at x = 7.5.
TEST_F(Implants, FacesCloseToAnInterface) {
  LabelVolume halves;
  halves.size = {16, 14, 14};
  halves.space = "right-anterior-superior";
  for (int i = 0; i < 16 * 14 * 14; ++i) halves.labels.push_back(i % 16 < 8 ? 1 : 2);
  write_label_volume(halves, folder_ / "halves.nrrd");
  for (const double gap : {0.1, 0.26, 0.46, 0.7}) {
    const Answer a = run("prepare " + (folder_ / "halves.nrrd") +
                         " --material box=" + box("b.stl", {7.5 + gap, 4, 4}, {12.5, 9, 10}) +
                         " --surface-space RAS --target-tets 4000 -o " + (folder_ / "p.vtu") + " --stats " +
                         (folder_ / "s.json"));
    EXPECT_EQ(a.status, 0) << gap << a.err;
    EXPECT_LT(stats().at("result").at("percent_below_threshold"), 1) << gap;
    EXPECT_GT(stats().at("result").at("min_dihedral"), 8) << gap;
    EXPECT_EQ(stats().at("creases").at("lost_corners"), 0) << gap;
  }
}

// A face of a box lies nearly in the border of the volume, and crosses it.
TEST_F(Implants, LabelsStayWithinTheBorder) {
  LabelVolume all;
  all.size = {20, 24, 60};
  all.space = "right-anterior-superior";
  all.labels.assign(20 * 24 * 60, 1);
  write_label_volume(all, folder_ / "all.nrrd");
  TriangleMesh turned = make_box({-0.5, 6.3, 12}, {7.6, 16.7, 46});
  const Eigen::AngleAxisd turn(M_PI / 180, Vec3::UnitY());
  const Vec3 centre(-0.5, 0, 30);
  for (Vec3& p : turned.points) p = centre + turn * (p - centre);
  write_surface(turned, folder_ / "box.stl");
  for (const char* seed : {"1", "2"}) {
    run("prepare " + (folder_ / "all.nrrd") + " --material box=" + (folder_ / "box.stl") +
        " --surface-space RAS --target-tets 6000 --seed " + seed + " -o " + (folder_ / "p.vtu"));
    const TetMesh mesh = read_tet_mesh(folder_ / "p.vtu").mesh;
    std::vector<std::uint8_t> on_body(mesh.points.size(), 0);
    for (std::size_t t = 0; t < mesh.tets.size(); ++t)
      if (mesh.material_names.at(mesh.materials[t]) == "box")
        for (const Index p : mesh.tets[t]) on_body[p] = 1;
    double beyond = 0;
    for (std::size_t p = 0; p < mesh.points.size(); ++p)
      if (!on_body[p]) beyond = std::max(beyond, -0.5 - mesh.points[p].x());
    EXPECT_GT(mesh.tets.size(), 4000U);
    EXPECT_LT(beyond, 1e-6) << seed;
  }
}

// Cells of a voxel would cut 4 % off.
TEST_F(Implants, SmallBallsKeepTheirVolume) {
  constexpr double radius = 4.3;
  write_surface(make_sphere(radius, Vec3(9.2, 9.7, 9.4)), folder_ / "ball.stl");
  const Answer a = run("prepare " + volume() + " --material ball=" + (folder_ / "ball.stl") +
                       " --surface-space RAS --target-tets 6000 -o " + (folder_ / "p.vtu") + " --stats " +
                       (folder_ / "s.json"));
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_LT(stats().at("result").at("percent_below_threshold"), 0.5);
  const double whole = 4.0 / 3 * M_PI * std::pow(radius, 3);
  for (const nlohmann::json& m : stats().at("result").at("materials"))
    if (m.at("name") == "ball") EXPECT_NEAR(m.at("volume"), whole, 0.01 * whole);
}

TEST_F(Implants, ProtectedLabelsStay) {
  const std::string words = volume() + " --material implant=" + block() + " --surface-space RAS ";
  for (const char* list : {"--protect-labels 7", "--protect-labels 5-9", "--protect-labels label_7"}) {
    const Answer a = mesh(words + list);
    EXPECT_EQ(a.status, 0) << list << a.err;
    EXPECT_NEAR(volumes().at("label_7"), 16 * 16 * 8, 0.01 * 16 * 16 * 8) << list;
  }
  for (const auto& [list, message] : {std::pair("4", "label 4"), std::pair("bone", "'bone'"),
                                      std::pair("8-9", "labels from 8 to 9"), std::pair("3,", "empty")}) {
    const Answer a = mesh(words + "--protect-labels " + list);
    EXPECT_EQ(a.status, 2) << list;
    EXPECT_NE(a.err.find(message), std::string::npos) << a.err;
  }
}

TEST_F(Implants, AreNotMirrored) {
  // In LPS: x and y have the other sign.
  const std::string file = box("lps.stl", Vec3(-12.7, -11.9, 5.1), Vec3(-5.3, -6.2, 13.8));
  const Answer a = mesh(volume() + " --material implant=" + file + " --surface-space LPS");
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_NE(a.err.find("brought into"), std::string::npos) << a.err;
  EXPECT_NEAR(volumes().at("implant"), block_volume, 1e-4 * block_volume);
  // Taken as it is the surface misses the volume.
  const Answer apart = mesh(volume() + " --material implant=" + file);
  EXPECT_EQ(apart.status, 3);
  EXPECT_NE(apart.err.find("(-12.7, -11.9, 5.1)"), std::string::npos) << apart.err;
  EXPECT_NE(apart.err.find("--surface-space"), std::string::npos) << apart.err;
}

TEST_F(Implants, BodiesLeaveTheVolumeWhole) {
  const std::string file = box("lead.stl", Vec3(8.2, 8.4, 6.1), Vec3(11.9, 11.7, 27.3));
  const Answer a = mesh(volume() + " --material lead=" + file + " --surface-space RAS");
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_NE(a.err.find("1 body crosses its border"), std::string::npos) << a.err;
  EXPECT_NEAR(volumes().at("lead"), 3.7 * 3.3 * 21.2, 1e-4 * 3.7 * 3.3 * 21.2);
}

TEST_F(Implants, LabelsEndAtABorderThatABodyCrosses) {
  LabelVolume full;
  full.size = {12, 12, 12};
  full.labels.assign(12 * 12 * 12, 1);
  write_label_volume(full, folder_ / "full.nrrd");
  const std::string file = box("lead.stl", Vec3(4.2, 4.4, 4.1), Vec3(7.9, 7.7, 17.3));
  const std::string words = (folder_ / "full.nrrd") + " --material lead=" + file;
  const Answer a = mesh(words);
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_NEAR(volumes().at("label_1"), 12 * 12 * 12 - 3.7 * 3.3 * 7.4, 1e-4 * 12 * 12 * 12);
  const Answer simplified = run("prepare " + words + " --target-tets 2500 -o " + (folder_ / "p.msh") +
                                " --stats " + (folder_ / "s.json"));
  EXPECT_EQ(simplified.status, 0) << simplified.err;
  const TetMesh made = read_tet_mesh(folder_ / "p.msh").mesh;
  double highest = -1;
  for (std::size_t t = 0; t < made.tets.size(); ++t)
    if (made.materials[t] == 1)
      for (const Index p : made.tets[t]) highest = std::max(highest, made.points[p][2]);
  EXPECT_NEAR(highest, 11.5, 1e-9);
  std::set<std::string> groups;
  for (const auto& [patch, group] : made.patch_groups) groups.insert(group.name);
  EXPECT_TRUE(groups.contains("border_z_max"));
}

TEST_F(Implants, TagsAreThoseOfNoLabelOfTheFile) {
  const Answer a = mesh(volume() + " --labels 3 --material implant=" + block() + " --surface-space RAS");
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_EQ(read_tet_mesh(folder_ / "out.vtu").mesh.material_names.at(8), "implant");
}

TEST_F(Implants, OthersThanThoseAtProtectedLabelsAreCompared) {
  const std::string far = box("far.stl", Vec3(4.1, 4.3, 3.2), Vec3(6.6, 6.8, 5.7));
  const std::string near = box("near.stl", Vec3(10.1, 10.3, 7.2), Vec3(13.6, 13.8, 12.7));
  const Answer a = mesh(volume() + " --material far=" + far + " --material near=" + near +
                        " --surface-space RAS --protect-labels 7");
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_NE(a.err.find("'near' was not compared"), std::string::npos) << a.err;
  EXPECT_EQ(a.err.find("'far'"), std::string::npos) << a.err;
}

TEST_F(Implants, CallsThatDoNotFit) {
  const std::string labels = volume(), surface = block();
  for (const auto& [words, message] :
       {std::pair(surface + " " + labels, "give volumes first"),
        std::pair(labels + " " + surface + " --layer skin=1", "--layer"),
        std::pair(labels + " " + surface + " --sheet s=" + surface, "--sheet"),
        std::pair(labels + " --material label_3=" + surface, "both a label"),
        std::pair(labels + " --material outside=" + surface, "'outside'"),
        std::pair(labels + " " + surface + " --uniform --max-refinement 2", "cells of one size"),
        std::pair(labels + " --protect-labels 3", "there is no surface"),
        std::pair(surface + " --protect-labels 3", "no input is a volume"),
        std::pair(labels + " " + surface + " --voxel-size 3", "two voxels")}) {
    const Answer a = mesh(words);
    EXPECT_EQ(a.status, 2) << words;
    EXPECT_NE(a.err.find(message), std::string::npos) << a.err;
  }
  const Answer bricks =
      run("prepare " + labels + " " + surface + " --target-tets 1000 --bricks 64 -o " + (folder_ / "b.vtu"));
  EXPECT_EQ(bricks.status, 2);
  EXPECT_NE(bricks.err.find("--bricks"), std::string::npos) << bricks.err;
}

TEST_F(Implants, WhatSwallowsALabelIsNamed) {
  const std::string file = box("all.stl", Vec3(1, 1, 9), Vec3(18.5, 18.5, 18.5));
  const Answer a = mesh(volume() + " --material all=" + file + " --surface-space RAS");
  EXPECT_EQ(a.status, 3);
  EXPECT_NE(a.err.find("nothing is left of 'label_7'"), std::string::npos) << a.err;
}

TEST_F(Implants, ThreadsDoNotChangeTheBytes) {
  const std::string words = volume() + " --material implant=" + block() + " --quiet ";
  ASSERT_EQ(mesh(words + "--threads 1", "1.vtu").status, 0);
  ASSERT_EQ(mesh(words + "--threads 3", "3.vtu").status, 0);
  EXPECT_EQ(contents(folder_ / "1.vtu"), contents(folder_ / "3.vtu"));
}

}  // namespace
}  // namespace tetwright::implants_test
