// SPDX-License-Identifier: Apache-2.0

// Reads every file of data/regressions/, including findings of the fuzzers. Each is read and checked, or
// rejected with an InputError; none may crash.
#include <gtest/gtest.h>

#include <filesystem>

#include "common/error.h"
#include "common/io/formats.h"
#include "common/mesh/mesh_check.h"
#include "common/mesh/mesh_statistics.h"
#include "common/mesh/topology.h"

namespace tetwright::regressions_test {
namespace {

TEST(Regressions, EveryFileIsReadOrRefused) {
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(TETWRIGHT_REGRESSIONS)) {
    const std::string path = entry.path().string();
    const FileKind kind = file_kind(path);
    if (kind == FileKind::unknown) continue;
    SCOPED_TRACE(path);
    ++files;
    try {
      if (kind == FileKind::surface)
        EXPECT_FALSE(read_surface(path).triangles.empty());
      else if (kind == FileKind::volume)
        EXPECT_FALSE(read_label_volume(path).labels.empty());
      else {
        const TetMesh mesh = read_tet_mesh(path).mesh;
        EXPECT_FALSE(mesh.tets.empty());
        (void)check_mesh(mesh);
        EXPECT_EQ(mesh_statistics(mesh).tets, mesh.tets.size());
        EXPECT_EQ(topology(mesh), topology(mesh));
      }
    } catch (const InputError&) {
    }
  }
  EXPECT_GT(files, 0u);
}

}  // namespace
}  // namespace tetwright::regressions_test
