// Fuzzes a reader of volumes: it must return a volume as label_volume.h describes it, or throw an InputError.
// The volume must survive a round trip through the NRRD writer. The file that a header names follows a line
// of equal signs.
#include <cmath>
#include <cstdint>
#include <type_traits>

#include FORMAT_HEADER
#include "common/error.h"
#include "common/formats/nrrd.h"
#include "tests/fuzz/names.h"

namespace {

using namespace tetwright;

template <class Read>
LabelVolume read_with(const Read& read, std::string_view bytes) {
  constexpr std::string_view between = "=====\n";
  if constexpr (std::is_invocable_v<Read, std::string_view, std::string, FileReader>) {
    const std::size_t at = bytes.find(between);
    return read(bytes.substr(0, at), "fuzz", [&](const std::string& path) {
      if (at == std::string_view::npos) throw InputError(path + ": there is no such file");
      return std::string(bytes.substr(at + between.size()));
    });
  } else {
    return read(bytes, "fuzz");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const LabelVolume volume = read_with(READ_FORMAT, {reinterpret_cast<const char*>(data), size});
    std::size_t voxels = 1;
    for (const int n : volume.size) {
      TETWRIGHT_CHECK(n >= 1);
      voxels *= static_cast<std::size_t>(n);
    }
    TETWRIGHT_CHECK(volume.labels.size() == voxels);
    TETWRIGHT_CHECK(volume.origin.allFinite() && volume.directions.allFinite());
    if (voxels > 100000) return 0;
    const LabelVolume back = read_nrrd(write_nrrd(volume), "fuzz");
    TETWRIGHT_CHECK(back.size == volume.size && back.labels == volume.labels && back.space == volume.space);
    TETWRIGHT_CHECK(back.origin == volume.origin && back.directions == volume.directions);
  } catch (const InputError&) {
  }
  return 0;
}
