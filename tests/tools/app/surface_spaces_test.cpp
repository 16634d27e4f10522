// SPDX-License-Identifier: Apache-2.0

// Tests through the program that surfaces, volumes and images in different coordinate systems are brought
// into that of the first input.
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "common/geometry/box_tree.h"
#include "common/number_text.h"
#include "tests/tools/program.h"
#include "tetwright/io.h"

namespace tetwright::surface_spaces_program_test {
namespace {

/// The faces of a box.
TriangleMesh box(const Vec3& low, const Vec3& high) {
  TriangleMesh surface;
  for (int corner = 0; corner < 8; ++corner)
    surface.points.emplace_back(corner & 1 ? high.x() : low.x(), corner & 2 ? high.y() : low.y(),
                                corner & 4 ? high.z() : low.z());
  for (const auto& [a, b, c, d] : {std::array<Index, 4>{0, 2, 3, 1},
                                   {4, 5, 7, 6},
                                   {0, 1, 5, 4},
                                   {2, 6, 7, 3},
                                   {0, 4, 6, 2},
                                   {1, 3, 7, 5}}) {
    surface.triangles.push_back({a, b, c});
    surface.triangles.push_back({a, c, d});
  }
  return surface;
}

std::string text_of(const TriangleMesh& surface, const std::string& before_point,
                    const std::string& before_face, Index first) {
  std::string out;
  for (const Vec3& p : surface.points) {
    out += before_point;
    append_point(out, p);
    out += '\n';
  }
  for (const Triangle& t : surface.triangles) {
    out += before_face;
    for (const Index p : t) out += " " + std::to_string(p + first);
    out += '\n';
  }
  return out;
}

/// The bytes of a file of a surface whose header names a space as 3D Slicer does. Empty: it names none.
std::string with_header(const TriangleMesh& surface, const std::string& extension, const std::string& space) {
  const std::string title = "3D Slicer output." + (space.empty() ? "" : " SPACE=" + space);
  if (extension == ".obj") return "# " + title + "\n" + text_of(surface, "v ", "f", 1);
  if (extension == ".ply")
    return "ply\nformat ascii 1.0\n" + (space.empty() ? "" : "comment SPACE=" + space + "\n") +
           "element vertex 8\nproperty float x\nproperty float y\nproperty float z\nelement face "
           "12\nproperty "
           "list uchar int vertex_indices\nend_header\n" +
           text_of(surface, "", "3", 0);
  if (extension == ".vtk") {
    std::string text = text_of(surface, "", "3", 0);
    std::size_t faces = 0;
    for (int line = 0; line < 8; ++line) faces = text.find('\n', faces) + 1;
    text.insert(faces, "POLYGONS 12 48\n");
    return "# vtk DataFile Version 4.2\n" + title + "\nASCII\nDATASET POLYDATA\nPOINTS 8 float\n" + text;
  }
  std::string stl = title;  // binary
  stl.resize(80, '\0');
  stl += std::string("\14\0\0\0", 4);
  for (const Triangle& t : surface.triangles) {
    stl.append(12, '\0');
    for (const Index p : t)
      for (int axis = 0; axis < 3; ++axis) {
        const auto number = static_cast<float>(surface.points[p][axis]);
        stl.append(reinterpret_cast<const char*>(&number), sizeof number);
      }
    stl.append(2, '\0');
  }
  return stl;
}

/// A NIfTI file of 16 x 16 x 16 bytes with the space right-anterior-superior, voxels of size 1 and the first
/// centre at the origin.
std::string nifti(const std::function<int(int, int, int)>& label) {
  std::string bytes(352, '\0');
  const auto set = [&](std::size_t at, auto value) { std::memcpy(bytes.data() + at, &value, sizeof value); };
  set(0, std::int32_t{348});
  constexpr std::array<std::int16_t, 8> sizes{3, 16, 16, 16, 1, 1, 1, 1};
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    set(40 + 2 * k, sizes[k]);
    set(76 + 4 * k, 1.0F);
  }
  set(70, std::int16_t{2});  // bytes
  set(72, std::int16_t{8});
  set(108, 352.0F);
  set(254, std::int16_t{1});  // the matrix that follows counts
  for (std::size_t axis = 0; axis < 3; ++axis) set(280 + 16 * axis + 4 * axis, 1.0F);
  bytes.replace(344, 4, std::string("n+1\0", 4));
  for (int z = 0; z < 16; ++z)
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x) bytes += static_cast<char>(label(x, y, z));
  return bytes;
}

int in_block(int x, int y, int z) { return x > 1 && y > 1 && z > 1 && x < 14 && y < 14 && z < 14 ? 1 : 0; }

class SurfaceSpacesOfCalls : public testing::Test {
 protected:
  std::string write(const std::string& file, const std::string& bytes) const {
    write_file_atomically(folder_ / file, bytes);
    return folder_ / file;
  }
  /// Writes an image in LPS whose value at a point in RAS is x + 20 y.
  std::string write_image() const {
    LabelVolume image;
    image.size = {16, 16, 16};
    image.space = "right-anterior-superior";
    for (int z = 0; z < 16; ++z)
      for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) image.labels.push_back(x + 20 * y);
    EXPECT_TRUE(change_space(image, "left-posterior-superior"));
    write_label_volume(image, folder_ / "ct.nrrd");
    return folder_ / "ct.nrrd";
  }
  Answer mesh(const std::string& words) const {
    return run("mesh " + words + " --resolution 16 -o " + (folder_ / "out.vtu"));
  }
  TetMesh result() const { return read_tet_mesh(folder_ / "out.vtu").mesh; }
  /// Box of the points of a material.
  Box3 box_of(MaterialTag tag) const {
    const TetMesh mesh = result();
    Box3 box;
    for (std::size_t t = 0; t < mesh.tets.size(); ++t)
      if (mesh.materials[t] == tag)
        for (const Index p : mesh.tets[t]) box.add(mesh.points[p]);
    return box;
  }

  TemporaryFolder folder_;
};

const Vec3 low(3, 4, 5), high(8, 10, 9), opposite_low(-8, -10, 5), opposite_high(-3, -4, 9);

void expect_box(const Box3& box, const Vec3& expected_low, const Vec3& expected_high) {
  EXPECT_LT((box.low - expected_low).norm(), 0.6) << box.low.transpose();
  EXPECT_LT((box.high - expected_high).norm(), 0.6) << box.high.transpose();
}

TEST_F(SurfaceSpacesOfCalls, SurfacesAreBroughtIntoThatOfTheFirst) {
  const std::string outer = write("outer.stl", with_header(box({1, 1, 1}, {14, 14, 14}), ".stl", "RAS"));
  for (const std::string extension : {".stl", ".ply", ".obj", ".vtk"}) {
    SCOPED_TRACE(extension);
    const std::string inner =
        write("inner" + extension, with_header(box(opposite_low, opposite_high), extension, "LPS"));
    const Answer a = mesh("--material outer=" + outer + " --material inner=" + inner);
    EXPECT_EQ(a.status, 0) << a.err;
    EXPECT_NE(a.err.find("1 surface in another space, left-posterior-superior: '" + inner +
                         "' (brought into that of the first input, right-anterior-superior)"),
              std::string::npos)
        << a.err;
    expect_box(box_of(2), low, high);
  }
}

TEST_F(SurfaceSpacesOfCalls, TheOptionIsForSurfacesWithoutAHeader) {
  const std::string outer = write("outer.stl", with_header(box({1, 1, 1}, {14, 14, 14}), ".stl", "RAS"));
  const std::string inner = write("inner.ply", with_header(box(opposite_low, opposite_high), ".ply", ""));
  const std::string both = "--material outer=" + outer + " --material inner=" + inner;
  const Answer a = mesh(both + " --surface-space LPS");
  EXPECT_EQ(a.status, 0) << a.err;
  expect_box(box_of(2), low, high);
  const Answer without = mesh(both);
  EXPECT_NE(without.err.find("1 surface whose file names no space: '" + inner + "'"), std::string::npos)
      << without.err;
  // Nothing is said of surfaces alone of which none names a space.
  write("outer.stl", with_header(box({1, 1, 1}, {14, 14, 14}), ".stl", ""));
  EXPECT_EQ(mesh(both).err.find("space"), std::string::npos);
}

TEST_F(SurfaceSpacesOfCalls, ImagesAreBroughtIntoThatOfASurface) {
  const std::string surface = write("inner.vtk", with_header(box(low, high), ".vtk", "RAS"));
  const Answer a = mesh(surface + " --values ct=" + write_image());
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_NE(a.err.find("(brought into that of the mesh, right-anterior-superior)"), std::string::npos)
      << a.err;
  const TetMesh mesh = result();
  for (const MeshField& field : mesh.point_fields)
    for (std::size_t p = 0; p < mesh.points.size(); ++p)
      EXPECT_NEAR(field.values[p], mesh.points[p].x() + 20 * mesh.points[p].y(), 1e-3);
  EXPECT_EQ(mesh.point_fields.size(), 1u);
}

TEST_F(SurfaceSpacesOfCalls, ImagesAreBroughtIntoThatOfAVolume) {
  const std::string labels = write("head.nii", nifti(in_block));
  const Answer a = run("mesh " + labels + " --values ct=" + write_image() + " -o " + (folder_ / "out.vtu"));
  EXPECT_EQ(a.status, 0) << a.err;
  const TetMesh mesh = result();
  ASSERT_EQ(mesh.point_fields.size(), 1u);
  for (std::size_t p = 0; p < mesh.points.size(); ++p)
    EXPECT_NEAR(mesh.point_fields[0].values[p], mesh.points[p].x() + 20 * mesh.points[p].y(), 1e-3);
}

/// A mesh of a block, made from a NIfTI file in RAS, and what is compared with it.
class SpacesBesideAMesh : public SurfaceSpacesOfCalls {
 protected:
  SpacesBesideAMesh() {
    const std::string labels = write("head.nii", nifti(in_block));
    for (const char* extension : {".vtu", ".msh"}) {
      const Answer a = run("mesh " + labels + " -o " + (folder_ / "m") + extension);
      EXPECT_EQ(a.status, 0) << a.err;
    }
    write("lps.stl", with_header(box({-13.5, -13.5, 1.5}, {-1.5, -1.5, 13.5}), ".stl", "LPS"));
    write("lps.ply", with_header(box({-13.5, -13.5, 1.5}, {-1.5, -1.5, 13.5}), ".ply", ""));
  }
  std::string path(const std::string& file) const { return folder_ / file; }
  /// Largest distance of the surfaces from the mesh in the JSON of check.
  static double distance(const Answer& a) {
    return nlohmann::json::parse(a.out).at("surface").at("from_surface").at("upper");
  }
};

const char* const unused =
    "m.vtu: mesh in right-anterior-superior, not left-posterior-superior (--mesh-space is not used";
const char* const converted = "(brought into that of the first input, right-anterior-superior)";

TEST_F(SpacesBesideAMesh, FilesOfTheMeshNameIt) {
  EXPECT_EQ(read_tet_mesh(path("m.vtu")).mesh.space, "right-anterior-superior");
  EXPECT_EQ(read_tet_mesh(path("m.msh")).mesh.space, "");
  // Other commands keep it, and --mesh-space names it.
  ASSERT_EQ(run("improve " + path("m.vtu") + " -o " + path("i.vtk")).status, 0);
  EXPECT_EQ(read_tet_mesh(path("i.vtk")).mesh.space, "right-anterior-superior");
  ASSERT_EQ(run("simplify " + path("m.msh") + " --mesh-space RAS --target-tets 2000 -o " + path("s.vtu") +
                " --boundary " + path("s.ply"))
                .status,
            0);
  EXPECT_EQ(read_tet_mesh(path("s.vtu")).mesh.space, "right-anterior-superior");
  EXPECT_EQ(read_surface(path("s.ply")).space, "right-anterior-superior");
  // The file counts more than the option.
  const Answer a =
      run("values " + path("m.vtu") + " ct=" + write_image() + " --mesh-space LPS -o " + path("v.vtu"));
  ASSERT_EQ(a.status, 0);
  EXPECT_NE(a.err.find(unused), std::string::npos) << a.err;
  EXPECT_EQ(read_tet_mesh(path("v.vtu")).mesh.space, "right-anterior-superior");
}

TEST_F(SpacesBesideAMesh, SurfacesOfCheckAreBroughtIntoIt) {
  for (const std::string& words :
       {"m.vtu --surface " + path("lps.stl"), "m.msh --mesh-space RAS --surface " + path("lps.stl"),
        "m.vtu --surface-space LPS --surface " + path("lps.ply")}) {
    const Answer a = run("check --json " + path(words));
    EXPECT_EQ(a.status, 0) << a.err;
    EXPECT_NE(a.err.find(converted), std::string::npos) << words << a.err;
    EXPECT_LT(distance(a), 1) << words;
    EXPECT_NE(a.out.find("\"space-converted\""), std::string::npos) << words << a.out;
  }
  const Answer a = run("check " + path("m.vtu") + " --mesh-space LPS --surface " + path("lps.stl"));
  EXPECT_NE(a.err.find(unused), std::string::npos) << a.err;
}

TEST_F(SpacesBesideAMesh, SurfacesElsewhereAreRefusedWithBothBoxes) {
  const std::string boxes = "lps.ply: it does not meet " + path("m.vtu") +
                            ": it reaches from (-13.5, -13.5, 1.5) to (-1.5, -1.5, 13.5), " + path("m.vtu") +
                            " from (1.";
  for (const std::string& words : {"check " + path("m.vtu") + " --surface " + path("lps.ply"),
                                   "embed " + path("m.vtu") + " " + path("lps.ply") + " -o " + path("w.npz")})
    expect_refused(words, 3,
                   {boxes, "coordinate system of both: that of " + path("lps.ply") +
                               " is unknown (--surface-space LPS or RAS names it), that of " + path("m.vtu") +
                               " is right-anterior-superior"});
  expect_refused("check " + path("m.msh") + " --surface " + path("lps.stl"), 3,
                 {"it does not meet", "that of " + path("lps.stl") + " is left-posterior-superior, that of " +
                                          path("m.msh") + " is unknown (--mesh-space LPS or RAS names it)"});
  const std::string mirrored =
      write("mirrored.stl", with_header(box({2, 2, 2}, {13, 13, 13}), ".stl", "LPS"));
  expect_refused(
      "check " + path("m.vtu") + " --surface " + mirrored, 3,
      {mirrored + " was brought from left-posterior-superior into right-anterior-superior, that of " +
       path("m.vtu")});
  // A surface elsewhere beside one that meets the mesh.
  const std::string meets = write("ras.stl", with_header(box({2, 2, 2}, {13, 13, 13}), ".stl", "RAS"));
  expect_refused("check " + path("m.vtu") + " --surface " + meets + " " + path("lps.ply"), 3,
                 {"it does not meet"});
}

TEST_F(SpacesBesideAMesh, WhatIsUnknownIsSaid) {
  const std::string plain = write("plain.ply", with_header(box({2, 2, 2}, {13, 13, 13}), ".ply", ""));
  const Answer surface = run("check " + path("m.vtu") + " --surface " + plain);
  EXPECT_EQ(surface.status, 0);
  EXPECT_NE(surface.err.find("1 surface whose file names no space: '" + plain + "' (taken as it is"),
            std::string::npos)
      << surface.err;
  const std::string named = write("named.ply", with_header(box({2, 2, 2}, {13, 13, 13}), ".ply", "LPS"));
  const Answer mesh = run("check " + path("m.msh") + " --surface " + named);
  EXPECT_NE(mesh.err.find("unknown; --mesh-space LPS or RAS names it)"), std::string::npos) << mesh.err;
  EXPECT_EQ(run("check " + path("m.msh") + " --surface " + plain).err.find("space"), std::string::npos);
}

TEST_F(SpacesBesideAMesh, EmbeddedSurfacesAreBroughtIntoIt) {
  for (const std::string& words :
       {path("m.vtu") + " " + path("lps.stl"), path("m.msh") + " " + path("lps.stl") + " --mesh-space RAS",
        path("m.vtu") + " " + path("lps.ply") + " --surface-space LPS"}) {
    const Answer a = run("embed " + words + " -o " + path("w.json"));
    EXPECT_EQ(a.status, 0) << a.err;
    EXPECT_NE(a.err.find(converted), std::string::npos) << a.err;
    const nlohmann::json weights = nlohmann::json::parse(contents(path("w.json")));
    for (const double distance : weights.at("distances")) EXPECT_LT(distance, 1);
  }
}

TEST_F(SpacesBesideAMesh, ImagesAreBroughtIntoIt) {
  const std::string image = write_image();
  for (const std::string& words : {"values " + path("m.vtu") + " ct=" + image,
                                   "values " + path("m.msh") + " --mesh-space RAS ct=" + image,
                                   "improve " + path("m.vtu") + " --values ct=" + image}) {
    const Answer a = run(words + " -o " + (folder_ / "out.vtu"));
    EXPECT_EQ(a.status, 0) << a.err;
    EXPECT_NE(a.err.find("(brought into that of the mesh, right-anterior-superior)"), std::string::npos)
        << a.err;
    const TetMesh mesh = result();
    ASSERT_EQ(mesh.point_fields.size(), 1u);
    for (std::size_t p = 0; p < mesh.points.size(); ++p)
      EXPECT_NEAR(mesh.point_fields[0].values[p], mesh.points[p].x() + 20 * mesh.points[p].y(), 1e-3);
  }
  expect_refused("values " + path("m.msh") + " ct=" + image + " -o " + path("no.vtu"), 3,
                 {"no part of the image is in", "the image reaches from (-15.5, -15.5, -0.5)"});
}

/// A tet mesh in LPS around the block, with large tets on one side, x above -8, and small ones on the other.
std::string sizes_in_lps(const std::string& header) {
  std::string text =
      "# vtk DataFile Version 3.0\nsizes" + header + "\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 double\n";
  for (int corner = 0; corner < 8; ++corner)
    text += std::string(corner & 1 ? "0 " : "-16 ") + (corner & 2 ? "0 " : "-16 ") +
            (corner & 4 ? "16\n" : "0\n");
  text += "CELLS 6 30\n4 0 1 3 7\n4 0 3 2 7\n4 0 2 6 7\n4 0 6 4 7\n4 0 4 5 7\n4 0 5 1 7\nCELL_TYPES 6\n";
  for (int tet = 0; tet < 6; ++tet) text += "10\n";
  text += "POINT_DATA 8\nSCALARS size double 1\nLOOKUP_TABLE default\n";
  for (int corner = 0; corner < 8; ++corner) text += corner & 1 ? "9\n" : "1.5\n";
  return text;
}

TEST_F(SpacesBesideAMesh, SizesAreBroughtIntoIt) {
  const std::string named = write("named.vtk", sizes_in_lps(" SPACE=LPS")),
                    plain = write("plain.vtk", sizes_in_lps(""));
  const std::string out = " --quiet -o " + (folder_ / "out.vtu"), labels = path("head.nii");
  for (const std::string& words : {"simplify " + path("m.vtu") + " --size-field " + named,
                                   "simplify " + path("m.msh") + " --mesh-space RAS --size-field " + named,
                                   "simplify " + path("m.vtu") + " --surface-space LPS --size-field " + plain,
                                   "prepare " + labels + " --size-field " + named,
                                   "prepare " + labels + " --surface-space LPS --size-field " + plain}) {
    const Answer a = run(words + out + " --stats " + path("s.json"));
    EXPECT_LE(a.status, 1) << a.err;
    EXPECT_NE(contents(path("s.json")).find("1 size field in another space, left-posterior-superior"),
              std::string::npos)
        << words;
    // In RAS the small tets are at large x.
    const TetMesh mesh = result();
    std::size_t small = 0;
    for (const Vec3& p : mesh.points) small += p.x() > 8;
    EXPECT_GT(small, 2 * (mesh.points.size() - small)) << words;
  }
  expect_refused("simplify " + path("m.vtu") + " --size-field " + plain + out, 3,
                 {"plain.vtk: it has no sizes in ", "it reaches from (-16, -16, 0) to (0, 0, 16), ",
                  "plain.vtk is unknown (--surface-space LPS or RAS names it), that of "});
  // Their boxes share a layer of voxels.
  expect_refused("prepare " + labels + " --size-field " + plain + out, 3,
                 {"plain.vtk: the sizes end within the body"});
}

TEST_F(SurfaceSpacesOfCalls, WrongOptionsAreRefused) {
  const std::string labels = write("head.nii", nifti(in_block));
  const std::string out = " -o " + (folder_ / "no.vtu");
  ASSERT_EQ(run("mesh " + labels + " -o " + (folder_ / "m.msh")).status, 0);
  const std::string mesh = folder_ / "m.msh";
  const std::string surface = write("lps.stl", with_header(box(low, high), ".stl", "LPS"));
  expect_refused("check " + mesh + " --surface-space LPS", 2, {"--surface-space", "give --surface FILE"});
  expect_refused("check " + mesh + " --mesh-space LPS", 2, {"--mesh-space is for", "give --surface FILE"});
  expect_refused("check " + mesh + " --surface-space LPS --surface " + surface, 2,
                 {"m.msh, is unknown", "name it by --mesh-space LPS or RAS"});
  expect_refused("simplify " + mesh + " --target-tets 100 --surface-space LPS" + out, 2,
                 {"--surface-space", "give --size-field FILE"});
  expect_refused("check " + mesh + " --mesh-space LAS", 2, {"--mesh-space", "'LAS' is not LPS or RAS"});
  expect_refused("mesh " + labels + " --surface-space LPS" + out, 2, {"--surface-space is for surfaces"});
  expect_refused("mesh " + labels + " --surface-space LAS" + out, 2,
                 {"--surface-space", "'LAS' is not LPS or RAS"});
}

}  // namespace
}  // namespace tetwright::surface_spaces_program_test
