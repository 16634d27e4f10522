#include "common/formats/formats.h"

#include "tests/common/formats/expect_error.h"
#include "tests/common/formats/file_test.h"
#include "tests/common/formats/tricky_meshes.h"

namespace tetwright {
namespace {

using Formats = FileTest;

TEST_F(Formats, KindsByExtension) {
  EXPECT_EQ(file_kind("a/b.PLY"), FileKind::surface);
  EXPECT_EQ(file_kind("b.StL"), FileKind::surface);
  EXPECT_EQ(file_kind("x.off"), FileKind::surface);
  EXPECT_EQ(file_kind("x.y.obj"), FileKind::surface);
  EXPECT_EQ(file_kind("x.VTU"), FileKind::tet_mesh);
  EXPECT_EQ(file_kind("x.msh"), FileKind::tet_mesh);
  EXPECT_EQ(file_kind("x.mesh"), FileKind::tet_mesh);
  for (const char* name : {"", "ply", "a/.ply/b", "x.vtk", "x.", "x.ply "})
    EXPECT_EQ(file_kind(name), FileKind::unknown);
}

TEST_F(Formats, RoundTripThroughFiles) {
  for (const char* name : {"a.vtu", "a.msh", "a.mesh"}) {
    write_tet_mesh(tricky_tets(), path(name));
    const TetMesh back = read_tet_mesh(path(name)).mesh;
    EXPECT_TRUE(same_bits(back.points, tricky_tets().points)) << name;
    EXPECT_EQ(back.tets, tricky_tets().tets);
    EXPECT_EQ(back.materials, tricky_tets().materials);
  }
  for (const char* name : {"a.off", "a.obj", "a.ply"}) {
    write_surface(tricky_surface(), path(name));
    EXPECT_TRUE(same_bits(read_surface(path(name)).points, tricky_surface().points)) << name;
  }
  EXPECT_EQ(files(), 6u);
}

TEST_F(Formats, UnknownExtensions) {
  const std::string in = error_of<UsageError>([&] { (void)read_surface(path("x.xyz")); });
  EXPECT_NE(in.find("\".xyz\" for a surface; known are .ply .obj .stl .off"), std::string::npos) << in;
  const std::string out = error_of<UsageError>([&] { check_output_path(path("x")); });
  EXPECT_NE(out.find("no extension for a tet mesh; known are .vtu .msh .mesh"), std::string::npos) << out;
  // A surface is no place for a tet mesh.
  (void)error_of<UsageError>([&] { check_output_path(path("x.ply")); });
  (void)error_of<UsageError>([&] { check_output_path(path("x.vtu"), FileKind::surface); });
  (void)error_of<UsageError>([&] { write_tet_mesh(tricky_tets(), path("x.ply")); });
  (void)error_of<UsageError>([&] { (void)read_tet_mesh(path("x.ply")); });
  EXPECT_EQ(files(), 0u);
}

TEST_F(Formats, MissingFiles) {
  EXPECT_NE(error_of<InputError>([&] { (void)read_surface(path("no.ply")); }).find("no.ply"),
            std::string::npos);
  (void)error_of<OutputError>([&] { check_output_path(path("no/a.vtu")); });
  std::filesystem::create_directory(path("a.ply"));
  (void)error_of<InputError>([&] { (void)read_surface(path("a.ply")); });
}

TEST_F(Formats, MessagesNameTheFile) {
  put(path("bad.off"), "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n");
  const std::string message = error_of<InputError>([&] { (void)read_surface(path("bad.off")); });
  EXPECT_EQ(message.find(path("bad.off") + ": line 6: "), 0u) << message;
}

}  // namespace
}  // namespace tetwright
