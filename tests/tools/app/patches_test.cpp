// SPDX-License-Identifier: Apache-2.0

// Tests named patches and solids, from file to file.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "tests/tools/program.h"
#include "tetwright/io.h"
#include "tetwright/mesh_quality.h"

namespace tetwright::patches_test {
namespace {

/// A box as solids of an STL file; its side z = `high` is the solid `lid`, unless that is empty.
std::string box(double low, double high, const std::string& name, const std::string& lid = "") {
  const auto solid = [&](const std::string& called, std::initializer_list<std::array<int, 4>> quads) {
    std::ostringstream out;
    out << "solid " << called << "\n";
    for (const auto& q : quads)
      for (const auto& [i, k] : {std::pair(1, 2), std::pair(2, 3)}) {
        out << "facet normal 0 0 0\nouter loop\n";
        for (const int p : {q[0], q[static_cast<std::size_t>(i)], q[static_cast<std::size_t>(k)]})
          out << "vertex " << (p & 1) << " " << (p >> 1 & 1) << " " << (p & 4 ? high : low) << "\n";
        out << "endloop\nendfacet\n";
      }
    out << "endsolid\n";
    return out.str();
  };
  if (lid.empty())
    return solid(name, {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}});
  return solid(name, {{0, 2, 3, 1}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) +
         solid(lid, {{4, 5, 7, 6}});
}

void write(const std::string& file, const std::string& text) { std::ofstream(file) << text; }

std::size_t faces_named(const TetMesh& mesh, const std::string& name) {
  return static_cast<std::size_t>(
      std::count_if(mesh.interfaces.begin(), mesh.interfaces.end(), [&](const InterfaceTriangle& t) {
        const auto group = mesh.patch_groups.find({t.pair(), t.patch});
        return group != mesh.patch_groups.end() && group->second.name == name;
      }));
}

TEST(Patches, AreKeptFromScanToSolver) {
  const TemporaryFolder f;
  write(f / "box.stl", box(0, 1, "wall", "inlet"));
  const Answer a = run("prepare " + (f / "box.stl") + " -o " + (f / "a.msh") + " --target-tets 500 --stats " +
                       (f / "s.json"));
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_NE(a.out.find("named patches: inlet ("), std::string::npos) << a.out;
  const nlohmann::json patches = nlohmann::json::parse(contents(f / "s.json")).at("patches");
  ASSERT_EQ(patches.size(), 2U);
  EXPECT_EQ(patches[0].at("name"), "inlet");
  EXPECT_NEAR(patches[0].at("area"), 1, 1e-9);
  EXPECT_NEAR(patches[1].at("area"), 5, 1e-9);
  EXPECT_NE(contents(f / "a.msh").find("2 1 \"inlet\"\n2 2 \"wall\"\n"), std::string::npos);
  for (const char* more : {"", " --feature-angle off"}) {
    const Answer b = run("simplify " + (f / "a.msh") + " -o " + (f / "b.msh") + " --target-tets 200" + more);
    EXPECT_LE(b.status, 1) << b.err;
    const TetMesh mesh = read_tet_mesh(f / "b.msh").mesh;
    EXPECT_GT(faces_named(mesh, "inlet"), 1U);
    EXPECT_EQ(faces_named(mesh, "inlet") + faces_named(mesh, "wall"), mesh.interfaces.size());
    for (const InterfaceTriangle& t : mesh.interfaces) {
      const bool above = std::all_of(t.ids.begin(), t.ids.end(),
                                     [&](Index p) { return std::abs(mesh.points[p].z() - 1) < 1e-6; });
      const auto group = mesh.patch_groups.find({t.pair(), t.patch});
      EXPECT_EQ(group->second.name == "inlet", above);
    }
  }
}

TEST(Patches, ThatAreLostAreSaid) {
  const TemporaryFolder f;
  // The lid lies within the next material.
  write(f / "box.stl", box(0, 1, "wall", "inlet"));
  write(f / "cover.stl", box(0.5, 1.5, "cover"));
  const std::string call =
      "mesh " + (f / "box.stl") + " " + (f / "cover.stl") + " --resolution 12 -o " + (f / "a.msh");
  const Answer a = run(call);
  EXPECT_EQ(a.status, 1);
  EXPECT_NE(a.err.find("lost 1 of 2 named patches: 'inlet' at ("), std::string::npos) << a.err;
  const Answer b = run(call + " --accept-changes");
  EXPECT_EQ(b.status, 0) << b.err;
  EXPECT_NE(b.err.find("lost 1 of 2 named patches: 'inlet' at ("), std::string::npos) << b.err;
}

TEST(Patches, ThatAFormatHasNoPlaceForAreTold) {
  const TemporaryFolder f;
  write(f / "box.stl", box(0, 1, "wall", "inlet"));
  for (const std::string output : {"a.vtu", "a.msh"}) {
    const Answer a = run("mesh " + (f / "box.stl") + " --resolution 8 -o " + (f / output));
    EXPECT_EQ(a.status, 0) << a.err;
    EXPECT_EQ(a.err.find("2 named patches (not written") != std::string::npos, output == "a.vtu") << a.err;
  }
}

TEST(Patches, OfBoxesThatTouchLeaveGoodShapes) {
  const TemporaryFolder f;
  write(f / "box.stl", box(0, 1, "wall", "inlet"));
  write(f / "case.stl", box(1, 2, "side", "outlet"));
  const Answer a =
      run("prepare " + (f / "box.stl") + " " + (f / "case.stl") + " --target-tets 3000 -o " + (f / "a.msh"));
  const TetMesh mesh = read_tet_mesh(f / "a.msh").mesh;
  EXPECT_LT(mesh_statistics(mesh, 0.1).below_percent, 5);  // more than 30 with exact creases
  std::set<std::string> names;
  for (const auto& [patch, group] : mesh.patch_groups) names.insert(group.name);
  EXPECT_TRUE(names.contains("wall") && names.contains("side") && names.contains("outlet")) << a.err;
}

TEST(Patches, SolidsAreMaterials) {
  const TemporaryFolder f;
  write(f / "two.stl", box(0, 1, "bone") + box(1, 1.6, "skin"));
  const Answer a = run("mesh " + (f / "two.stl") + " --split-solids --resolution 16 -o " + (f / "a.msh"));
  EXPECT_LE(a.status, 1) << a.err;
  const TetMesh mesh = read_tet_mesh(f / "a.msh").mesh;
  EXPECT_EQ(mesh.material_names, (std::map<MaterialTag, std::string>{{1, "bone"}, {2, "skin"}}));
}

TEST(Patches, CellsBetweenInnerWallsAreMaterials) {
  const TemporaryFolder f;
  // Both boxes have no lid at z = 1 but for the solid `wall`.
  const std::string above = box(1, 2.5, "gas");
  std::string open = above;
  const std::size_t facet = above.find("facet"), second = above.find("facet normal", facet + 1),
                    third = above.find("facet normal", second + 1);
  open.erase(facet, third - facet);  // the two facets at z = 1
  write(f / "tank.stl", box(0, 1, "bath", "wall") + open);
  const std::string call = "mesh " + (f / "tank.stl") + " --resolution 16 -o " + (f / "a.msh");
  const auto names = [&](const std::string& more) {
    const Answer a = run(call + more);
    const bool outer = more.ends_with("outer");  // where the wall is left out, and its name is lost
    EXPECT_EQ(a.status, outer ? 1 : 0) << a.err;
    EXPECT_EQ(a.err.find("2 cells between the inner walls") != std::string::npos, !outer) << a.err;
    EXPECT_EQ(a.err.find("lost 1 of 3 named patches: 'wall'") != std::string::npos, outer) << a.err;
    return read_tet_mesh(f / "a.msh").mesh.material_names;
  };
  EXPECT_EQ(names(""), (std::map<MaterialTag, std::string>{{1, "gas"}, {2, "bath"}}));
  EXPECT_EQ(names(" --region air@0.5,0.5,2"), (std::map<MaterialTag, std::string>{{1, "air"}, {2, "bath"}}));
  EXPECT_EQ(names(" --regions outer"), (std::map<MaterialTag, std::string>{{1, "tank"}}));
  expect_refused(call + " --region air@3,3,3", 2, {"'air' at (3, 3, 3)", "no cell"});
  expect_refused(call + " --region air@1,2", 2, {"air@1,2", "NAME@X,Y,Z"});
  expect_refused(call + " --region air@1,2,x", 2, {"'x'"});
  expect_refused(call + " --regions all", 2, {"'all'", "cells, outer"});
}

TEST(Patches, SolidsWithoutANameHaveNumbers) {
  const TemporaryFolder f;
  write(f / "a.stl", box(0, 1, "", " "));
  write(f / "b.stl", box(2, 3, "", " "));
  const Answer both =
      run("mesh " + (f / "a.stl") + " " + (f / "b.stl") + " --resolution 12 -o " + (f / "out.msh"));
  EXPECT_LE(both.status, 1) << both.err;
  const TetMesh mesh = read_tet_mesh(f / "out.msh").mesh;
  for (const char* name : {"a_1", "a_2", "b_1", "b_2"}) EXPECT_GT(faces_named(mesh, name), 0U) << name;
  write(f / "two.stl", box(0, 1, "") + box(2, 3, ""));
  const Answer split =
      run("mesh " + (f / "two.stl") + " --split-solids --resolution 12 -o " + (f / "out.msh"));
  EXPECT_LE(split.status, 1) << split.err;
  EXPECT_EQ(read_tet_mesh(f / "out.msh").mesh.material_names,
            (std::map<MaterialTag, std::string>{{1, "two_1"}, {2, "two_2"}}));
  // A generated name gives way to a given one.
  write(f / "c.stl", box(2, 3, "c_2", " "));
  const Answer taken =
      run("mesh " + (f / "a.stl") + " " + (f / "c.stl") + " --resolution 12 -o " + (f / "out.msh"));
  EXPECT_LE(taken.status, 1) << taken.err;
  const TetMesh three = read_tet_mesh(f / "out.msh").mesh;
  for (const char* name : {"a_1", "a_2", "c_2", "c_2_2"}) EXPECT_GT(faces_named(three, name), 0U) << name;
}

/// The six sides of a box as solids, with names as OpenFOAM's users choose them.
std::string sides(const Vec3& low, const Vec3& high) {
  std::ostringstream out;
  for (int axis = 0; axis < 3; ++axis)
    for (const bool upper : {false, true}) {
      out << "solid " << (upper ? "max" : "min") << "XYZ"[axis] << "\n";
      const int u = (axis + (upper ? 1 : 2)) % 3, v = (axis + (upper ? 2 : 1)) % 3;
      for (const auto& corners : {std::array{0, 1, 2}, std::array{0, 2, 3}}) {
        out << "facet normal 0 0 0\nouter loop\n";
        for (const int corner : corners) {
          Vec3 p = low;
          if (upper) p[axis] = high[axis];
          if (corner == 1 || corner == 2) p[u] = high[u];
          if (corner > 1) p[v] = high[v];
          out << "vertex " << p.x() << " " << p.y() << " " << p.z() << "\n";
        }
        out << "endloop\nendfacet\n";
      }
      out << "endsolid\n";
    }
  return out.str();
}

const std::vector<std::string> side_names{"minX", "maxX", "minY", "maxY", "minZ", "maxZ"};

std::set<std::string> names_in(const TetMesh& mesh) {
  std::set<std::string> names;
  for (const auto& [patch, group] : mesh.patch_groups) names.insert(group.name);
  return names;
}

std::set<std::string> qualified(const std::vector<std::string>& bodies) {
  std::set<std::string> names;
  for (const std::string& body : bodies)
    for (const std::string& side : side_names) names.insert(body + ":" + side);
  return names;
}

TEST(Patches, OfOneNameInSeveralFilesAreQualifiedByTheirBody) {
  const TemporaryFolder f;
  write(f / "heater.stl", sides({0, 0, 0}, {1, 1, 1}));
  write(f / "fluid.stl", sides({2, 0, 0}, {3, 1, 1}));
  write(f / "inner.stl", sides({2.3, 0.3, 0.3}, {2.7, 0.7, 0.7}));
  const std::set<std::string> names = qualified({"heater", "fluid", "inner"});
  const Answer a = run("prepare " + (f / "heater.stl") + " " + (f / "fluid.stl") + " " + (f / "inner.stl") +
                       " --target-tets 4000 -o " + (f / "a.msh") + " --stats " + (f / "s.json") +
                       " --boundary " + (f / "b.vtp"));
  EXPECT_LE(a.status, 1) << a.err;
  EXPECT_EQ(a.err.find("lost"), std::string::npos) << a.err;
  EXPECT_NE(a.err.find("heater.stl: 6 names of patches (changed, as others have them, too; the first: "
                       "\"maxX\" -> \"heater:maxX\")"),
            std::string::npos)
      << a.err;
  EXPECT_NE(a.out.find("heater:maxX ("), std::string::npos) << a.out;
  const TetMesh mesh = read_tet_mesh(f / "a.msh").mesh;
  EXPECT_EQ(names_in(mesh), names);
  for (const InterfaceTriangle& t : mesh.interfaces) {
    const Vec3 centre = (mesh.points[t.ids[0]] + mesh.points[t.ids[1]] + mesh.points[t.ids[2]]) / 3;
    const std::string body = centre.x() < 1.5                                               ? "heater"
                             : ((centre - Vec3(2.5, 0.5, 0.5)).cwiseAbs().maxCoeff() > 0.4) ? "fluid"
                                                                                            : "inner";
    const std::string& name = mesh.patch_groups.at({t.pair(), t.patch}).name;
    EXPECT_TRUE(name.starts_with(body + ":")) << name << " " << centre.transpose();
  }
  std::set<std::string> in_stats;
  const auto stats = nlohmann::json::parse(contents(f / "s.json"));
  for (const nlohmann::json& patch : stats.at("patches")) {
    in_stats.insert(patch.at("name").get<std::string>());
    EXPECT_NEAR(patch.at("area").get<double>(), patch.at("input_area").get<double>(), 1e-6) << patch;
  }
  EXPECT_EQ(in_stats, names);
  std::set<std::string> in_boundary;
  for (const SurfaceRegion& group : read_surface(f / "b.vtp").groups) in_boundary.insert(group.name);
  EXPECT_EQ(in_boundary, names);

  const Answer b = run("simplify " + (f / "a.msh") + " -o " + (f / "b.msh") + " --target-tets 2000");
  EXPECT_LE(b.status, 1) << b.err;
  EXPECT_EQ(names_in(read_tet_mesh(f / "b.msh").mesh), names);

  // In formats of solvers names have the form that the format can hold.
  for (const std::string format : {".inp", ".feb", ".bdf", ".mesh", ".vtk", ".xdmf"}) {
    const Answer c = run("simplify " + (f / "a.msh") + " --target-tets 3000 -o " + (f / "c" + format));
    EXPECT_LE(c.status, 1) << c.err;
    const std::string text = contents(f / "c" + format);
    if (format == ".inp")
      for (const std::string& name : names) {
        std::string plain = name;
        plain.replace(plain.find(':'), 1, "_");
        EXPECT_NE(text.find("NAME=" + plain), std::string::npos) << format << " lacks " << plain;
      }
    if (format == ".feb")
      for (const std::string& name : names)
        EXPECT_NE(text.find("name=\"" + name + "\""), std::string::npos) << format << " lacks " << name;
  }
}

TEST(Patches, OfOneNameInBoxesSideBySideAreQualified) {
  const TemporaryFolder f;
  write(f / "left.stl", sides({0, 0, 0}, {1, 1, 1}));
  write(f / "right.stl", sides({1, 0, 0}, {2, 1, 1}));
  const Answer a =
      run("mesh " + (f / "left.stl") + " " + (f / "right.stl") + " --resolution 24 -o " + (f / "a.msh"));
  EXPECT_EQ(a.status, 0) << a.err;
  std::set<std::string> names = qualified({"left", "right"});
  names.erase("left:maxX");
  names.erase("right:minX");
  names.insert("left:maxX+right:minX");
  EXPECT_EQ(names_in(read_tet_mesh(f / "a.msh").mesh), names);
}

TEST(Patches, OfTheHeaterNameEachContactAfterBothParts) {
  const TemporaryFolder f;
  const std::vector<std::string> parts{"below", "left", "core", "right", "above"};
  std::string call = "prepare";
  for (const std::string& part : parts) {
    ASSERT_EQ(run("sample heater_" + part + " -o " + (f / part + ".obj")).status, 0);
    call += part == "below" ? " " + (f / "below.obj") : " --material " + part + "=" + (f / part + ".obj");
  }
  const Answer a = run(call + " --target-tets 3000 -o " + (f / "a.msh") + " --stats " + (f / "s.json"));
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_NE(a.err.find("8 pairs of patches that share faces in contacts (named after both; the first: \""),
            std::string::npos)
      << a.err;
  EXPECT_EQ(a.err.find("not certain"), std::string::npos) << a.err;
  std::set<std::string> names = qualified(parts);
  for (const std::string& all_shared :
       {"below:maxY", "left:maxX", "left:minY", "left:maxY", "core:minX", "core:maxX", "core:minY",
        "core:maxY", "right:minX", "right:minY", "right:maxY", "above:minY"})
    names.erase(all_shared);
  const std::map<std::string, double> contacts{
      {"below:maxY+left:minY", 1.2}, {"below:maxY+core:minY", 1.6}, {"below:maxY+right:minY", 1.2},
      {"left:maxX+core:minX", 0.5},  {"core:maxX+right:minX", 0.5}, {"left:maxY+above:minY", 1.2},
      {"core:maxY+above:minY", 1.6}, {"right:maxY+above:minY", 1.2}};
  for (const auto& [name, area] : contacts) names.insert(name);
  const TetMesh mesh = read_tet_mesh(f / "a.msh").mesh;
  EXPECT_EQ(names_in(mesh), names);
  EXPECT_EQ(mesh.material_names.size(), 5U);
  const auto stats = nlohmann::json::parse(contents(f / "s.json"));
  for (const nlohmann::json& patch : stats.at("patches")) {
    EXPECT_NEAR(patch.at("area").get<double>(), patch.at("input_area").get<double>(), 1e-5) << patch;
    if (const auto contact = contacts.find(patch.at("name")); contact != contacts.end()) {
      EXPECT_NEAR(patch.at("area").get<double>(), contact->second, 1e-5) << patch;
    }
  }
  EXPECT_EQ(stats.at("creases").at("lost_corners"), 0) << stats.at("creases");
}

TEST(Patches, OfOneFileKeepTheirNames) {
  const TemporaryFolder f;
  write(f / "box.stl", sides({0, 0, 0}, {1, 1, 1}));
  write(f / "plain.stl", box(2, 3, "plain"));
  const std::set<std::string> own(side_names.begin(), side_names.end());
  for (const std::string& more : {std::string(), " " + (f / "plain.stl")}) {
    const Answer a = run("mesh " + (f / "box.stl") + more + " --resolution 24 -o " + (f / "a.msh"));
    EXPECT_LE(a.status, 1) << a.err;
    EXPECT_EQ(names_in(read_tet_mesh(f / "a.msh").mesh), own);
    EXPECT_EQ(a.err.find("names of patches"), std::string::npos) << a.err;
  }
}

TEST(Patches, SolidsOfOneNameInTwoFilesAreTwoMaterials) {
  const TemporaryFolder f;
  write(f / "knee.stl", box(0, 1, "bone") + box(1.5, 2.5, "disc"));
  write(f / "hip.stl", box(3, 4, "bone") + box(4.5, 5.5, "skin"));
  write(f / "other.stl", sides({0, 0, 6}, {1, 1, 7}));
  const Answer a =
      run("mesh " + (f / "knee.stl") + " " + (f / "hip.stl") + " --material skin=" + (f / "other.stl") +
          " --split-solids --resolution 40 -o " + (f / "a.msh"));
  EXPECT_LE(a.status, 1) << a.err;
  const TetMesh mesh = read_tet_mesh(f / "a.msh").mesh;
  EXPECT_EQ(mesh.material_names,
            (std::map<MaterialTag, std::string>{
                {1, "knee:bone"}, {2, "disc"}, {3, "hip:bone"}, {4, "hip:skin"}, {5, "skin"}}));
  EXPECT_NE(a.err.find("knee.stl: 1 names of materials (changed, as others have it, too: \"bone\" -> "
                       "\"knee:bone\")"),
            std::string::npos)
      << a.err;
  EXPECT_EQ(names_in(mesh), std::set<std::string>(side_names.begin(), side_names.end()));
}

/// A surface with the name of a tissue for each polygon, as VTK writes text: a number for each character, and
/// a zero at the end.
std::string vtp_with_names(const std::vector<Vec3>& points, const std::vector<std::vector<int>>& polygons,
                           const std::vector<std::string>& names) {
  std::ostringstream out, corners, ends;
  out << "<VTKFile type=\"PolyData\" byte_order=\"LittleEndian\"><PolyData><Piece NumberOfPoints=\""
      << points.size() << "\" NumberOfPolys=\"" << polygons.size()
      << "\"><CellData><Array type=\"String\" Name=\"Names\" format=\"ascii\">";
  for (const std::string& name : names) {
    for (const char c : name) out << static_cast<int>(c) << " ";
    out << "0 ";
  }
  out << "</Array></CellData><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">";
  for (const Vec3& p : points) out << p.x() << " " << p.y() << " " << p.z() << " ";
  std::size_t end = 0;
  for (const std::vector<int>& polygon : polygons) {
    for (const int p : polygon) corners << p << " ";
    ends << (end += polygon.size()) << " ";
  }
  out << "</DataArray></Points><Polys><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">"
      << corners.str() << "</DataArray><DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">"
      << ends.str() << "</DataArray></Polys></Piece></PolyData></VTKFile>";
  return out.str();
}

TEST(Patches, NamesOfPolygonsInAVtpAreLabels) {
  const TemporaryFolder f;
  std::vector<Vec3> points;
  std::vector<std::vector<int>> polygons;
  std::vector<std::string> tissues;
  for (const int box : {0, 1}) {
    for (int corner = 0; corner < 8; ++corner)
      points.emplace_back(2 * box + (corner & 1), corner >> 1 & 1, corner >> 2);
    for (std::vector<int> quad : std::vector<std::vector<int>>{
             {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
      for (int& p : quad) p += 8 * box;
      polygons.push_back(std::move(quad));
      tissues.emplace_back(box == 0 ? "bone" : "skin");
    }
  }
  write(f / "two.vtp", vtp_with_names(points, polygons, tissues));
  const std::string call = "mesh " + (f / "two.vtp") + " --resolution 24 -o " + (f / "a.msh");
  const Answer patches = run(call);
  EXPECT_EQ(patches.status, 0) << patches.err;
  EXPECT_EQ(patches.err.find("Names"), std::string::npos) << patches.err;
  EXPECT_EQ(names_in(read_tet_mesh(f / "a.msh").mesh), (std::set<std::string>{"bone", "skin"}));
  const Answer split = run(call + " --split-solids");
  EXPECT_EQ(split.status, 0) << split.err;
  EXPECT_EQ(read_tet_mesh(f / "a.msh").mesh.material_names,
            (std::map<MaterialTag, std::string>{{1, "bone"}, {2, "skin"}}));
}

TEST(Patches, NamesAreTheSameInTheFileAndInTheStats) {
  const TemporaryFolder f;
  write(f / "box.stl", box(0, 1, "W\xe4nde", "\xe2\x82 lid"));
  const Answer a =
      run("mesh " + (f / "box.stl") + " --resolution 12 -o " + (f / "a.msh") + " --stats " + (f / "s.json"));
  EXPECT_LE(a.status, 1) << a.err;
  const TetMesh mesh = read_tet_mesh(f / "a.msh").mesh;
  const nlohmann::json stats = nlohmann::json::parse(contents(f / "s.json"));
  ASSERT_EQ(stats.at("patches").size(), 2U);
  for (const nlohmann::json& patch : stats.at("patches"))
    EXPECT_GT(faces_named(mesh, patch.at("name")), 0U) << patch;
}

TEST(Patches, WrongCalls) {
  const TemporaryFolder f;
  const std::string out = " -o " + (f / "out.vtu");
  write(f / "one.stl", box(0, 1, "bone"));
  expect_refused("mesh " + (f / "one.stl") + " --split-solids" + out, 3,
                 {"one.stl: --split-solids finds no solids"});
  write(f / "same.stl", box(0, 1, "bone") + box(2, 3, "bone"));
  expect_refused("mesh " + (f / "same.stl") + out, 3, {"same.stl: line 87: a solid is called \"bone\""});
  run("sample organs -o " + (f / "organs.nrrd"));
  expect_refused("mesh " + (f / "organs.nrrd") + " --split-solids" + out, 2,
                 {"--split-solids is for surfaces"});
  run("sample tet_cube -o " + (f / "tets.msh"));
  expect_refused("mesh " + (f / "tets.msh") + out, 3, {"tets.msh: there are ", "tetwright simplify"});
}

}  // namespace
}  // namespace tetwright::patches_test
