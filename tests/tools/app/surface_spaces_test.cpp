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

TEST_F(SurfaceSpacesOfCalls, WrongOptionsAreRefused) {
  const std::string labels = write("head.nii", nifti(in_block));
  const std::string out = " -o " + (folder_ / "no.vtu");
  expect_refused("mesh " + labels + " --surface-space LPS" + out, 2, {"--surface-space is for surfaces"});
  expect_refused("mesh " + labels + " --surface-space LAS" + out, 2,
                 {"--surface-space", "'LAS' is not LPS or RAS"});
}

}  // namespace
}  // namespace tetwright::surface_spaces_program_test
