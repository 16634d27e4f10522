// SPDX-License-Identifier: Apache-2.0
#include "tools/prepare/size_field_file.h"

#include <gtest/gtest.h>

#include "tests/common/small_meshes.h"
#include "tests/common/temporary_folder.h"
#include "tetwright/error.h"
#include "tetwright/files.h"
#include "tetwright/io.h"

namespace tetwright::size_field_file_test {
namespace {

TEST(SizeFieldFile, IsReadByItsExtension) {
  const TemporaryFolder folder;
  TetMesh mesh = one_tet();
  mesh.point_fields = {{"size", 1, false, {2, 2, 2, 2}}};
  write_tet_mesh(mesh, folder / "a.vtu");
  EXPECT_EQ(read_size_field(folder / "a.vtu")->at({0.2, 0.2, 0.2})->length, 2);
  write_file_atomically(folder / "a.VDB", "no grid");
  try {
    (void)read_size_field(folder / "a.VDB");
    ADD_FAILURE();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find(".vdb"), std::string::npos) << e.what();
  }
}

TEST(SizeFieldFile, OtherExtensionsAreRefused) {
  EXPECT_NO_THROW(check_size_field_path("a.VDB"));
  try {
    check_size_field_path("a.nrrd");
    ADD_FAILURE();
  } catch (const UsageError& e) {
    EXPECT_STREQ(
        e.what(),
        "a.nrrd: unknown extension \".nrrd\"; edge lengths are read from .vtu .pvtu .msh .vtk .xdmf .node "
        ".ele .ply .vtp .vdb");
  }
}

}  // namespace
}  // namespace tetwright::size_field_file_test
