// SPDX-License-Identifier: Apache-2.0

// Fuzzes the readers of volumes: each must return a volume that satisfies label_volume.h, or throw an
// InputError. The volume must survive a round trip through the NRRD writer. The file to which a header refers
// follows a line of equal signs.
#include "common/io/volumes/inr.h"
#include "common/io/volumes/metaimage.h"
#include "common/io/volumes/nifti.h"
#include "common/io/volumes/nrrd.h"
#include "tests/fuzz/targets.h"
#include "tetwright/error.h"

namespace tetwright::fuzz {
namespace {

using Read = LabelVolume (*)(std::string_view, const std::string&, const FileReader&);

void run(std::string_view bytes, Read read) {
  constexpr std::size_t max_voxels = 100000;  // maximum size of volumes that are written
  constexpr std::string_view between = "=====\n";
  const std::size_t at = bytes.find(between);
  try {
    const LabelVolume volume = read(bytes.substr(0, at), "fuzz", [&](const std::string& path) {
      if (at == std::string_view::npos) throw InputError(path + ": there is no such file");
      return std::string(bytes.substr(at + between.size()));
    });
    std::size_t voxels = 1;
    for (const int n : volume.size) {
      TETWRIGHT_CHECK(n >= 1);
      voxels *= static_cast<std::size_t>(n);
    }
    TETWRIGHT_CHECK(volume.labels.size() == voxels);
    TETWRIGHT_CHECK(volume.origin.allFinite() && volume.directions.allFinite());
    if (voxels > max_voxels) return;
    const LabelVolume back = read_nrrd(write_nrrd(volume), "fuzz");
    TETWRIGHT_CHECK(back.size == volume.size && back.labels == volume.labels && back.space == volume.space);
    TETWRIGHT_CHECK(back.origin == volume.origin && back.directions == volume.directions);
  } catch (const InputError&) {
  }
}

/// Reads a format with a single file.
LabelVolume read_inr_alone(std::string_view bytes, const std::string& name, const FileReader&) {
  return read_inr(bytes, name);
}

using Bytes = std::string_view;
constexpr Target targets[] = {
    {"nrrd", [](Bytes b) { run(b, read_nrrd); }},
    {"metaimage", [](Bytes b) { run(b, read_metaimage); }},
    {"nifti", [](Bytes b) { run(b, read_nifti); }},
    {"inr", [](Bytes b) { run(b, read_inr_alone); }},
};

}  // namespace

std::span<const Target> volume_targets() { return targets; }

}  // namespace tetwright::fuzz
