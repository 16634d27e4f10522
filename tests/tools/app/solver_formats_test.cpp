// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/message_text.h"
#include "tests/tools/program.h"
#include "tetwright/io.h"
#include "tetwright/mesh_quality.h"

namespace tetwright::solver_formats_test {
namespace {

class SolverFormats : public ::testing::Test {
 protected:
  static void expect_status(const std::string& arguments, int status) {
    const Answer a = run(arguments);
    EXPECT_EQ(a.status, status) << arguments << "\n" << a.err;
  }

  SolverFormats() { expect_status("sample two_materials -o " + (f / "in.vtu"), 0); }
  Answer simplified(const std::string& out, const std::string& more = "") {
    return run("simplify " + (f / "in.vtu") + " --target-tets 200 -o " + (f / out) + " " + more);
  }

  TemporaryFolder f;
};

TEST_F(SolverFormats, EveryFormatIsWrittenAndReadAgain) {
  (void)simplified("reference.vtu");
  const TetMesh reference = read_tet_mesh(f / "reference.vtu").mesh;
  for (const TetFormatInfo& format : written_tet_formats()) {
    SCOPED_TRACE(format.name);
    const std::string out = format.name + format.extension;
    const Answer a = simplified(out, "--output-format " + format.name);
    if (a.status == 2 && a.err.find("was built without the netCDF library") != std::string::npos) continue;
    EXPECT_TRUE(a.status == 0 || a.status == 1) << a.err;
    if (file_kind(f / out) == FileKind::unknown) continue;
    const TetMesh back = read_tet_mesh(f / out).mesh;
    EXPECT_EQ(back.points.size(), reference.points.size());
    EXPECT_EQ(back.tets.size(), reference.tets.size());
    EXPECT_EQ(a.err.find("names of materials") == std::string::npos, format.names) << a.err;
    if (format.names && format.name != "tetgen") {
      EXPECT_EQ(back.material_names, reference.material_names);
    }
  }
}

TEST_F(SolverFormats, SecondOrderFollowsTheSurface) {
  expect_status("sample sphere -o " + (f / "ball.ply"), 0);
  const std::string made = "prepare " + (f / "ball.ply") + " --target-tets 1500 --order 2 -o " +
                           (f / "ball.vtu") + " --stats " + (f / "s.json");
  expect_status(made, 0);
  const auto stats = nlohmann::json::parse(contents(f / "s.json"));
  const auto& second = stats.at("second_order");
  EXPECT_GT(second.at("on_surface").get<int>(), 9 * second.at("surface_edges").get<int>() / 10);
  EXPECT_EQ(second.at("surface_edges").get<int>(), second.at("on_surface").get<int>() +
                                                       second.at("part_way").get<int>() +
                                                       second.at("straight").get<int>());
  expect_refused("simplify " + (f / "in.vtu") + " --target-tets 100 --order 2 -o " + (f / "m.mesh"), 2,
                 {"--order 2", "ten-node"});
  expect_refused("simplify " + (f / "in.vtu") + " --target-tets 100 --order 3 -o " + (f / "m.vtu"), 2,
                 {"--order"});
}

TEST_F(SolverFormats, TheBoundaryAsASurfaceAndAMeshWithoutIt) {
  (void)simplified("with.msh", "--boundary " + (f / "b.vtp"));
  (void)simplified("without.msh", "--no-boundary");
  const TriangleMesh boundary = read_surface(f / "b.vtp");
  const TetMesh with = read_tet_mesh(f / "with.msh").mesh;
  EXPECT_EQ(read_tet_mesh(f / "without.msh").mesh.tets, with.tets);
  EXPECT_NE(contents(f / "with.msh").find("\"left|right\""), std::string::npos);
  EXPECT_EQ(contents(f / "without.msh").find("\"left|right\""), std::string::npos);
  std::vector<std::string> names;
  for (const SurfaceRegion& g : boundary.groups) names.push_back(g.name);
  EXPECT_EQ(names, (std::vector<std::string>{"left|outside", "left|right", "right|outside"}));
}

TEST_F(SolverFormats, WhatAFormatChangesIsSaid) {
  TetMesh mesh = read_tet_mesh(f / "in.vtu").mesh;
  for (MaterialTag& tag : mesh.materials) tag = tag == 1 ? -5 : tag;
  mesh.material_names = {{-5, "same"}, {2, "same"}};
  mesh.interfaces = find_interfaces(mesh);
  for (InterfaceTriangle& t : mesh.interfaces) {
    if (t.pair() != MaterialPair{-5, std::nullopt}) continue;
    t.patch = 1;
    mesh.patch_groups[{t.pair(), 1}] = {7, "in let"};
  }
  write_tet_mesh(mesh, f / "odd.msh");
  const auto said = [&](const std::string& out, const std::string& more = "") {
    const Answer a = run("simplify " + (f / "odd.msh") + " --target-tets 200 -o " + (f / out) + " " + more);
    EXPECT_LE(a.status, 1) << a.err;
    return a.err;
  };
  const auto expect_said = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text << "lacks: " << part;
  };
  const std::string bdf = said("out.bdf");
  expect_said(bdf, "1 tags of materials (changed, as .bdf cannot hold it: -5 -> 1)");
  expect_said(bdf, "1 names of materials (changed, as .bdf cannot hold it: \"same\" -> \"same_2\")");
  expect_said(said("out.mesh"),
              "1 names of patches (changed, as .mesh cannot hold it: \"in let\" -> \"in_let\")");
  expect_said(said("out.meshb"), "1 names of patches (not written; .meshb cannot hold them");
  EXPECT_EQ(said("out.meshb", "--boundary " + (f / "b.vtp")).find("names of patches"), std::string::npos);
  expect_said(said("out.meshb", "--boundary " + (f / "b.off")),
              "1 names of patches (not written; .meshb cannot hold them, nor can .off");
  EXPECT_EQ(said("out.msh", "--boundary " + (f / "b.off")).find("patches"), std::string::npos);
  expect_said(said("out.msh", "--boundary " + (f / "b.obj")),
              "1 names of patches (changed, as .obj cannot hold it: \"in let\" -> \"in_let\")");
  EXPECT_EQ(said("out.msh").find("changed, as"), std::string::npos);
  EXPECT_EQ(read_tet_mesh(f / "out.mesh").mesh.patch_groups.begin()->second, (SurfaceRegion{7, "in_let"}));
}

TEST_F(SolverFormats, NamesThatBecomeEqualStayApart) {
  TetMesh mesh = read_tet_mesh(f / "in.vtu").mesh;
  mesh.interfaces = find_interfaces(mesh);
  for (InterfaceTriangle& t : mesh.interfaces) {
    if (t.other) continue;
    t.patch = 1;
    mesh.patch_groups[{t.pair(), 1}] = {0, t.material == 1 ? "in let" : "in_let"};
  }
  for (const char* extension : {".stl", ".obj", ".ply", ".vtp"}) {
    const std::string file = f / (std::string("b") + extension);
    write_interfaces(mesh, file);
    const bool words = std::string(extension) == ".stl" || std::string(extension) == ".obj";
    std::vector<std::string> names;
    for (const SurfaceRegion& group : read_surface(file).groups) names.push_back(group.name);
    // The name that the format can hold stays.
    EXPECT_EQ(names, words ? (std::vector<std::string>{"left|right", "in_let_2", "in_let"})
                           : (std::vector<std::string>{"left|right", "in let", "in_let"}))
        << extension;
    EXPECT_EQ(written_interface_name_changes(mesh, file).size(), words ? 1u : 0u) << extension;
  }
}

TEST_F(SolverFormats, NamesOfFieldsThatAreChangedAreSaid) {
  TetMesh mesh = read_tet_mesh(f / "in.vtu").mesh;
  for (const char* name : {"surface", "material", "a \"b\"", "a _b_", "same", "same", "two\nlines"})
    mesh.cell_fields.push_back({name, 1, false, std::vector<double>(mesh.tets.size(), 1.5)});
  mesh.point_fields.push_back({"material", 1, false, std::vector<double>(mesh.points.size(), 2.5)});
  for (const TetFormatInfo& format : written_tet_formats()) {
    const std::string file = f / (format.name + format.extension);
    if (!format.fields || file_kind(file) == FileKind::unknown) continue;
    SCOPED_TRACE(format.name);
    write_tet_mesh(mesh, file, nullptr, format.name);
    const TetMesh back = read_tet_mesh(file).mesh;
    ASSERT_EQ(back.cell_fields.size(), mesh.cell_fields.size());
    std::map<std::string, std::string> changed;
    for (std::size_t i = 0; i < mesh.cell_fields.size(); ++i)
      if (mesh.cell_fields[i].name != back.cell_fields[i].name)
        changed[in_quotes(mesh.cell_fields[i].name)] = in_quotes(back.cell_fields[i].name);
    std::map<std::string, std::string> said;
    for (const NameChange& change : written_name_changes(mesh, file, format.name).fields)
      said[change.own] = change.written;
    EXPECT_EQ(said, changed);
    EXPECT_GE(said.size(), 2u);
  }
}

TEST_F(SolverFormats, SizesThatNothingCanBeComputedForAreRefused) {
  TetMesh mesh = read_tet_mesh(f / "in.vtu").mesh;
  for (Vec3& p : mesh.points) p *= 1e150;
  write_tet_mesh(mesh, f / "huge.vtu");
  for (const std::string& call :
       {"check " + (f / "huge.vtu"), "improve " + (f / "huge.vtu") + " -o " + (f / "x.vtu")})
    expect_refused(call, 3, {"huge.vtu: ", "scale the mesh to between 1e-50 and 1e50"});
}

TEST_F(SolverFormats, NoFileReplacesAnother) {
  const std::string call = "simplify " + (f / "in.vtu") + " --target-tets 100 -o ";
  expect_refused(call + (f / "m.vtu") + " --boundary " + (f / "m.vtu"), 2, {"for a surface"});
  expect_refused(call + (f / "m.vtu") + " --boundary " + (f / "m.xyz"), 2, {".xyz", ".vtp"});
  expect_refused(call + (f / "m.vtu") + " --output-format inp", 2, {"\"inp\"", "abaqus"});
  expect_refused(call + (f / "no") + "/m.node", 5, {"no"});
  expect_refused(call + (f / "m.vtk") + " --output-format xdmf", 2,
                 {"m.vtk: xdmf writes several files", ".xdmf"});
  // The other files of an output are checked, too.
  expect_status("sample two_materials -o " + (f / "x.ele"), 0);
  expect_refused("prepare " + (f / "x.ele") + " --target-tets 9 -o " + (f / "x.node"), 2, {"x.ele"});
  // An input may be replaced by -o of simplify; fields that a format cannot hold are reported.
  EXPECT_NE(run("simplify " + (f / "x.node") + " --target-tets 100 -o " + (f / "x.node")).status, 2);
}

}  // namespace
}  // namespace tetwright::solver_formats_test
