// Reads every file of data/regressions/, findings of the fuzzers among them: each is read or refused with an
// InputError, never a crash.
#include <gtest/gtest.h>

#include <filesystem>

#include "common/error.h"
#include "common/formats/formats.h"

namespace tetwright {
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
      else
        EXPECT_FALSE(read_tet_mesh(path).mesh.tets.empty());
    } catch (const InputError&) {
    }
  }
  EXPECT_GT(files, 0u);
}

}  // namespace
}  // namespace tetwright
