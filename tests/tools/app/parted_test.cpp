// SPDX-License-Identifier: Apache-2.0

// Tests --split-interface and --cohesive through the program.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "tests/tools/program.h"
#include "tetwright/io.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/parted_interfaces.h"

namespace tetwright::parted_test {
namespace {

/// A box as OBJ.
std::string box(const Vec3& low, const Vec3& high) {
  std::ostringstream out;
  for (int i = 0; i < 8; ++i)
    out << "v " << (i & 1 ? high : low).x() << ' ' << (i & 2 ? high : low).y() << ' '
        << (i & 4 ? high : low).z() << '\n';
  out << "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  return out.str();
}

/// Three boxes that meet in an edge, in files `bone.obj`, `implant.obj` and `skin.obj`.
class PartedBoxes : public testing::Test {
 protected:
  PartedBoxes() {
    save("bone.obj", box({0, 0, 0}, {2, 2, 1}));
    save("implant.obj", box({0, 0, 1}, {2, 2, 2}));
    save("skin.obj", box({2, 0, 0}, {3, 2, 2}));
  }
  std::string path(const std::string& name) const { return folder_ / name; }
  void save(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name) << bytes;
  }
  std::string boxes(const std::string& more, const std::string& out) const {
    return "prepare " + path("bone.obj") + " " + path("implant.obj") + " " + path("skin.obj") +
           " --target-tets 600 --quiet -o " + path(out) + " --stats " + path("stats.json") + " " + more;
  }
  nlohmann::json parted() const { return nlohmann::json::parse(contents(path("stats.json"))).at("parted"); }
  static std::set<std::string> groups(const std::string& file) {
    std::set<std::string> names;
    for (const auto& [patch, group] : read_tet_mesh(file).mesh.patch_groups) names.insert(group.name);
    return names;
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(PartedBoxes, AllInterfacesPart) {
  ASSERT_EQ(run(boxes("--split-interface all", "m.msh")).status, 0);
  EXPECT_EQ(groups(path("m.msh")),
            (std::set<std::string>{"bone|implant:bone", "bone|implant:implant", "bone|skin:bone",
                                   "bone|skin:skin", "implant|skin:implant", "implant|skin:skin"}));
  ASSERT_EQ(parted().size(), 3u);
  std::size_t pairs = 0;
  for (const auto& p : parted()) {
    EXPECT_FALSE(p.at("cohesive").get<bool>());
    EXPECT_GT(p.at("faces").get<int>(), 0);
    pairs += p.at("pairs").get<std::size_t>();
  }
  const std::string table = contents(path("m_pairs.csv"));
  EXPECT_EQ(static_cast<std::size_t>(std::count(table.begin(), table.end(), '\n')), pairs + 1);
  EXPECT_EQ(table.rfind("interface,first,second\n\"bone|implant\",", 0), 0u) << table.substr(0, 80);
  const Answer check = run("check " + path("m.msh"));
  EXPECT_EQ(check.status, 0) << check.out;
  EXPECT_NE(check.err.find("parted interfaces (\"bone|implant\", \"bone|skin\""), std::string::npos)
      << check.err;
}

// Parted interfaces stay so when the mesh is simplified or improved, in another format.
TEST_F(PartedBoxes, OtherCommandsKeepThem) {
  ASSERT_EQ(run(boxes("--split-interface bone,skin --cohesive implant,bone", "m.msh")).status, 0);
  const auto expect_kept = [&](const std::string& file) {
    ReadTetMesh read = read_tet_mesh(path(file));
    const std::size_t wedges = read.mesh.wedges.size();
    EXPECT_GT(wedges, 0u);
    const JoinedInterfaces joined = join_parted_interfaces(read.mesh);
    EXPECT_EQ(std::set<std::string>(joined.names.begin(), joined.names.end()),
              (std::set<std::string>{"bone|implant", "bone|skin"}));
    for (std::size_t i = 0; i < joined.parts.size(); ++i)
      EXPECT_EQ(joined.parts[i].cohesive, joined.names[i] == "bone|implant");
    EXPECT_EQ(run("check " + path(file) + " --quiet --before " + path("m.msh")).status, 0);
  };
  expect_kept("m.msh");
  const std::string quiet = " --quiet -o ";
  ASSERT_EQ(run("simplify " + path("m.msh") + " --target-tets 400" + quiet + path("s.vtu")).status, 0);
  expect_kept("s.vtu");
  ASSERT_EQ(run("improve " + path("s.vtu") + quiet + path("i.inp")).status, 0);
  expect_kept("i.inp");
  ASSERT_EQ(run("simplify " + path("i.inp") + " --target-tets 300" + quiet + path("t.xdmf")).status, 0);
  expect_kept("t.xdmf");
  // More of them part, and formats without wedges say so.
  const Answer more = run("simplify " + path("m.msh") + " --target-tets 400 --split-interface all -o " +
                          path("u.mesh") + " --stats " + path("stats.json"));
  EXPECT_EQ(more.status, 0) << more.err;
  EXPECT_EQ(parted().size(), 3u);
  EXPECT_NE(more.err.find("cohesive elements (not written; .mesh cannot hold them)"), std::string::npos)
      << more.err;
}

TEST_F(PartedBoxes, WhatIsNotThereIsAShortfall) {
  const Answer a = run(boxes("--split-interface bone,implnt --split-interface skin,bone", "m.vtu"));
  EXPECT_EQ(a.status, 1);
  EXPECT_NE(a.err.find(
                "tetwright: --split-interface \"bone,implnt\": no faces to part; there are \"bone,implant\""),
            std::string::npos)
      << a.err;
  EXPECT_EQ(parted().size(), 1u);
  EXPECT_TRUE(std::filesystem::exists(path("m.vtu")));
}

// Groups come before the materials that they lie between, whatever they are called.
TEST_F(PartedBoxes, GroupsStayAmongMaterials) {
  ASSERT_EQ(run(boxes("", "m.msh")).status, 0);
  TetMesh mesh = read_tet_mesh(path("m.msh")).mesh;
  mesh.interfaces = find_interfaces(mesh);
  for (InterfaceTriangle& t : mesh.interfaces)
    if (t.other == 2 && mesh.points[t.ids[0]].x() + mesh.points[t.ids[1]].x() + mesh.points[t.ids[2]].x() < 3)
      t.patch = 1;
  for (const std::string group : {"Aglue", "zglue"}) {
    mesh.patch_groups = {{{{1, 2}, 1}, {0, group}}};
    write_tet_mesh(mesh, path("g.msh"));
    ASSERT_EQ(run("improve " + path("g.msh") + " --split-interface all --split-interface " + group +
                  " --quiet -o " + path("h.msh"))
                  .status,
              0);
    ASSERT_EQ(
        run("improve " + path("h.msh") + " --quiet -o " + path("i.msh") + " --stats " + path("stats.json"))
            .status,
        0);
    std::set<std::string> names;
    for (const auto& p : parted()) names.insert(p.at("name"));
    EXPECT_EQ(names, (std::set<std::string>{"bone|implant", "bone|skin", "implant|skin", group}));
    EXPECT_TRUE(std::filesystem::exists(path("i_pairs.csv")));
  }
  // Names of materials are lost in .mesh, but not those of sides.
  ASSERT_EQ(run(boxes("--split-interface all", "n.mesh")).status, 0);
  EXPECT_EQ(run("check " + path("n.mesh") + " --quiet").status, 0);
}

TEST_F(PartedBoxes, TagsAreNamesToo) {
  ASSERT_EQ(run(boxes("--split-interface 2,1", "m.vtu")).status, 0);
  EXPECT_EQ(parted().at(0).at("name"), "bone|implant");
}

TEST_F(PartedBoxes, SecondOrderPartsWithItsMidsideNodes) {
  ASSERT_EQ(run(boxes("--split-interface all --order 2", "m.msh")).status, 0);
  const Answer check = run("check " + path("m.msh") + " --quiet");
  EXPECT_EQ(check.status, 0) << check.err;
  // Midside nodes are doubled, too: there are as many as edges of the tets, whose points are doubled.
  const TetMesh mesh = read_tet_mesh(path("m.msh")).mesh;
  const std::string text = contents(path("m.msh"));
  const std::size_t nodes = std::stoul(text.substr(text.find("$Nodes\n") + 7));
  EXPECT_EQ(nodes, mesh.points.size() + straight_midside_nodes(mesh).edges.size());
}

TEST_F(PartedBoxes, WhatCannotBeHeldIsRefused) {
  expect_refused(boxes("--cohesive all --order 2", "m.msh"), 2,
                 {"--cohesive", "leave out either it or --order 2"});
  expect_refused(boxes("--cohesive all", "m.mesh"), 2, {"would be in a format without wedges", ".vtu .msh"});
  expect_refused(boxes("--cohesive all --parts 2", "m.msh"), 2, {"--cohesive does not work with --parts"});
  expect_refused(boxes("--split-interface all --no-boundary", "m.msh"), 2,
                 {"--no-boundary leaves out the faces"});
  expect_refused(boxes("--split-interface \"\"", "m.msh"), 2, {"--split-interface without a name"});
  EXPECT_FALSE(std::filesystem::exists(path("m.msh")));
  ASSERT_EQ(run(boxes("--cohesive all", "m.vtu")).status, 0);
  expect_refused("improve " + path("m.vtu") + " --order 2 -o " + path("n.vtu"), 2, {"has cohesive elements"});
}

TEST_F(PartedBoxes, SelectionsAreGroupsInFiles) {
  ASSERT_EQ(run(boxes("--select \"top=plane:z=max and normal:0,0,1,5\" --select seat=patch-at:1,1,-1 "
                      "--split-interface bone,implant",
                      "m.inp"))
                .status,
            0);
  const std::string inp = contents(path("m.inp"));
  for (const char* line : {"*SURFACE, NAME=top, TYPE=ELEMENT\n", "*NSET, NSET=top\n", "*NSET, NSET=seat\n"})
    EXPECT_NE(inp.find(line), std::string::npos) << line;
  const auto selections = nlohmann::json::parse(contents(path("stats.json"))).at("selections");
  EXPECT_NEAR(selections.at(0).at("area").get<double>(), 6, 1e-9);
  EXPECT_NEAR(selections.at(1).at("area").get<double>(), 4, 1e-9);
  EXPECT_NE(
      contents(path("stats.json")).find("the point of \\\"patch-at:1,1,-1\\\" is 1 from the nearest face"),
      std::string::npos);
  const std::set<std::string> names = groups(path("m.inp"));
  EXPECT_TRUE(names.contains("top") && names.contains("seat") && names.contains("bone|implant:bone"));
  // Meshes are selected from, too; the mesh is written although a rule selects nothing.
  const Answer a =
      run("simplify " + path("m.inp") + " --target-tets 400 --select none=plane:z=9 -o " + path("n.msh"));
  EXPECT_EQ(a.status, 1) << a.err;
  EXPECT_NE(a.err.find("tetwright: --select none: no face; the nearest face misses \"plane:z=9\" by 6.99"),
            std::string::npos)
      << a.err;
  EXPECT_TRUE(groups(path("n.msh")).contains("seat"));
  const Answer b = run("improve " + path("n.msh") + " --select top2=plane:z=max -o " + path("o.vtu"));
  EXPECT_EQ(b.status, 0) << b.err;
  EXPECT_NE(b.err.find("faces of the group \"top\" (now in \"top2\")"), std::string::npos) << b.err;
  EXPECT_NE(b.err.find("named patches (not written; .vtu cannot hold them"), std::string::npos) << b.err;
  expect_refused(boxes("--select top=plane:z", "q.msh"), 2, {"--select top: \"plane:z\" has no ="});
  expect_refused(boxes("--select plane:z=1", "q.msh"), 2, {"--select"});
}

// `values` leaves patches, sides and wedges as they are.
TEST_F(PartedBoxes, ValuesKeepPatchesAndSides) {
  save("im.nhdr",
       "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 4\nencoding: ascii\nspacings: 1 1 1\nendian: little\n"
       "data file: im.txt\n");
  std::string voxels;
  for (int i = 0; i < 64; ++i) voxels += std::to_string(i) + " ";
  save("im.txt", voxels);
  ASSERT_EQ(run(boxes("--cohesive bone,implant --select top=plane:z=max", "m.msh")).status, 0);
  const Answer a = run("values " + path("m.msh") + " T=" + path("im.nhdr") + " -o " + path("v.msh"));
  ASSERT_EQ(a.status, 0) << a.err;
  EXPECT_EQ(groups(path("v.msh")), groups(path("m.msh")));
  EXPECT_EQ(read_tet_mesh(path("v.msh")).mesh.wedges, read_tet_mesh(path("m.msh")).mesh.wedges);
  EXPECT_EQ(run("check " + path("v.msh") + " --quiet").status, 0);
}

// Wedges that were changed by hand are noticed.
TEST_F(PartedBoxes, MissingAndRepeatedWedgesAreCounted) {
  ASSERT_EQ(run(boxes("--cohesive bone,implant", "m.vtu")).status, 0);
  TetMesh mesh = read_tet_mesh(path("m.vtu")).mesh;
  ASSERT_GT(mesh.wedges.size(), 3u);
  mesh.wedges.pop_back();
  mesh.wedges.back() = mesh.wedges.front();
  write_tet_mesh(mesh, path("n.vtu"));
  const Answer check = run("check " + path("n.vtu"));
  EXPECT_NE(check.err.find("1 repeated cohesive elements (dropped)"), std::string::npos) << check.err;
  EXPECT_NE(check.err.find("2 faces without a cohesive element"), std::string::npos) << check.err;
}

// The table may not overwrite another file of the call.
TEST_F(PartedBoxes, TheTableHasAFileOfItsOwn) {
  expect_refused(boxes("--split-interface all --log-file " + path("m_pairs.csv"), "m.vtu"), 2,
                 {"is also the file of --split-interface"});
}

TEST_F(PartedBoxes, PartsOfAMeshArePartedToo) {
  ASSERT_EQ(run(boxes("--split-interface all --parts 2", "m.pvtu")).status, 0);
  const Answer check = run("check " + path("m.pvtu"));
  EXPECT_EQ(check.status, 0) << check.out;
  EXPECT_NE(check.err.find("\"implant|skin\""), std::string::npos) << check.err;
}

}  // namespace
}  // namespace tetwright::parted_test
