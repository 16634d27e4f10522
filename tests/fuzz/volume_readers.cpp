// SPDX-License-Identifier: Apache-2.0

// Fuzzes the readers of volumes: each must return a volume that satisfies label_volume.h, or throw an
// InputError. The volume must survive a round trip through the NRRD writer. The file to which a header refers
// follows a line of equal signs. Sources must give the same labels box by box as as a whole. All files are
// read as images, too, whose values must be finite.
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "common/io/volumes/dicom.h"
#include "common/io/volumes/hdf5_volume.h"
#include "common/io/volumes/inr.h"
#include "common/io/volumes/metaimage.h"
#include "common/io/volumes/nifti.h"
#include "common/io/volumes/npy.h"
#include "common/io/volumes/nrrd.h"
#include "common/io/volumes/tiff_stack.h"
#include "common/io/volumes/zarr.h"
#include "tests/common/io/memory_files.h"
#include "tests/fuzz/targets.h"
#include "tetwright/error.h"

namespace tetwright::fuzz {
namespace {

constexpr std::size_t max_voxels = 100000;  // maximum size of volumes that are written or read by boxes
constexpr std::string_view between = "=====\n";

using Read = LabelVolume (*)(std::string_view, const std::string&, const FileReader&);

void check_image(const ImageVolume& image) {
  TETWRIGHT_CHECK(image.origin.allFinite() && image.directions.allFinite() && !image.channels.empty());
  for (const std::vector<float>& channel : image.channels) {
    TETWRIGHT_CHECK(channel.size() == image.voxels());
    for (const float value : channel) TETWRIGHT_CHECK(std::isfinite(value));
  }
}

void run(std::string_view bytes, Read read, VolumeReader open) {
  const std::size_t at = bytes.find(between);
  const auto others = [&](const std::string& path) {
    if (at == std::string_view::npos) throw InputError(path + ": there is no such file");
    return std::string(bytes.substr(at + between.size()));
  };
  try {
    check_image(image_of(open(bytes.substr(0, at), "fuzz", others, VoxelUse::image)));
  } catch (const InputError&) {
  }
  try {
    const LabelVolume volume = read(bytes.substr(0, at), "fuzz", others);
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

/// Reads the layers of overlapping segments, or the only one.
void run_layers(std::string_view bytes) {
  try {
    for (const LabelVolume& layer : read_nrrd_layers(bytes, "fuzz"))
      TETWRIGHT_CHECK(layer.labels.size() == layer.voxels());
  } catch (const InputError&) {
  }
}

/// Reads a format with a single file.
LabelVolume read_inr_alone(std::string_view bytes, const std::string& name, const FileReader&) {
  return read_inr(bytes, name);
}

/// Reads a source as a whole and by its slices.
void run_source(const LabelSource& source) {
  const LabelGrid& grid = source.grid();
  std::uint64_t block = 1;
  for (const int n : source.block()) block *= static_cast<std::uint64_t>(n);
  // Memory of a chunk beyond this may be reserved, which the fuzzer would report.
  if (grid.voxels() > max_voxels || block > max_voxels) return;
  const LabelVolume volume = read_all(source, "fuzz");
  const std::size_t slice = volume.labels.size() / static_cast<std::size_t>(grid.size[2]);
  std::vector<MaterialTag> labels(slice);
  for (int z = 0; z < grid.size[2]; ++z) {
    source.read({0, 0, z}, {grid.size[0], grid.size[1], z + 1}, labels);
    TETWRIGHT_CHECK(std::equal(labels.begin(), labels.end(),
                               volume.labels.begin() + static_cast<std::ptrdiff_t>(slice) * z));
  }
}

/// Reads the labels of an array of NumPy.
LabelVolume read_npy_alone(std::string_view bytes, const std::string& name, const FileReader& others) {
  return labels_of(open_npy(bytes, name, others, VoxelUse::labels));
}

/// Reads an image as a whole and by its slices.
void run_image(const VoxelSource& source) {
  const LabelGrid& grid = source.grid();
  std::uint64_t block = static_cast<std::uint64_t>(source.channels());
  for (const int n : source.block()) block *= static_cast<std::uint64_t>(n);
  if (grid.voxels() > max_voxels / static_cast<std::uint64_t>(source.channels()) || block > max_voxels)
    return;
  const ImageVolume image = read_all_values(source, "fuzz");
  check_image(image);
  const std::size_t slice = grid.voxels() / static_cast<std::size_t>(grid.size[2]);
  std::vector<float> values(slice);
  for (std::int64_t c = 0; c < source.channels(); ++c)
    for (int z = 0; z < grid.size[2]; ++z) {
      source.read_values({0, 0, z}, {grid.size[0], grid.size[1], z + 1}, c, values);
      TETWRIGHT_CHECK(std::equal(
          values.begin(), values.end(),
          image.channels[static_cast<std::size_t>(c)].begin() + static_cast<std::ptrdiff_t>(slice) * z));
    }
}

/// Opens a file for labels, then as an image.
template <class Open>
void run_both(const Open& open) {
  try {
    run_source(*open(VoxelUse::labels));
  } catch (const InputError&) {
  }
  try {
    run_image(*open(VoxelUse::image));
  } catch (const InputError&) {
  }
}

/// Reads an array of zarr: its metadata, and bytes that all chunks have. Three parts are the metadata of an
/// image, of its array, and a chunk.
void run_zarr(std::string_view bytes) {
  std::array<std::string, 3> parts;
  const bool image = bytes.substr(0, bytes.find(between)).find("multiscales") != std::string_view::npos;
  const std::size_t chunk = image ? 2 : 1;
  for (std::size_t k = 0; k <= chunk; ++k) {
    const std::size_t at = k < chunk ? bytes.find(between) : std::string_view::npos;
    parts[k] = bytes.substr(0, at);
    bytes.remove_prefix(at == std::string_view::npos ? bytes.size() : at + between.size());
  }
  const auto open = [&](const std::string& path) -> std::unique_ptr<ByteRanges> {
    const std::string name = path.substr(path.rfind('/') + 1);
    if (name != "zarr.json" && name != ".zarray" && name != ".zattrs" && name != ".zgroup")
      return std::make_unique<MemoryRanges>(path, parts[chunk]);
    const bool group = path.find('/') == path.rfind('/');
    const std::string& text = parts[image && !group ? 1 : 0];
    const bool third = text.find("node_type") != std::string::npos;
    if (name != (third ? "zarr.json" : image && group ? ".zattrs" : ".zarray")) return nullptr;
    return std::make_unique<MemoryRanges>(path, text);
  };
  run_both([&](VoxelUse use) { return open_zarr("f", 1 << 12, open, use); });
}

/// A file in memory with a path.
class NamedMemory {
 public:
  explicit NamedMemory(std::string_view bytes) : file_(memfd_create("fuzz", MFD_CLOEXEC)) {
    TETWRIGHT_CHECK(file_ >= 0 &&
                    ::write(file_, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()));
  }
  ~NamedMemory() { ::close(file_); }
  NamedMemory(const NamedMemory&) = delete;
  NamedMemory& operator=(const NamedMemory&) = delete;
  std::string path() const { return "/proc/self/fd/" + std::to_string(file_); }

 private:
  int file_;
};

void run_file(std::string_view bytes,
              std::unique_ptr<VoxelSource> (*open)(const std::string& path, VoxelUse use)) {
  const NamedMemory file(bytes);
  run_both([&](VoxelUse use) { return open(file.path(), use); });
}

using Bytes = std::string_view;
constexpr Target targets[] = {
    {"nrrd",
     [](Bytes b) {
       run(b, read_nrrd, open_nrrd);
       run_layers(b);
     }},
    {"metaimage", [](Bytes b) { run(b, read_metaimage, open_metaimage); }},
    {"nifti", [](Bytes b) { run(b, read_nifti, open_nifti); }},
    {"inr", [](Bytes b) { run(b, read_inr_alone, open_inr); }},
    {"npy",
     [](Bytes b) {
       run(b, read_npy_alone, open_npy);
       const NamedMemory file(b);
       run_both([&](VoxelUse use) { return find_raw_volume(file.path(), find_npy, use); });
     }},
    {"zarr", run_zarr},
    {"dicom",
     [](Bytes b) {
       run_file(b, [](const std::string& path, VoxelUse use) { return open_dicom(path, 1 << 12, use); });
     }},
    {"tiff",
     [](Bytes b) {
       run_file(b, [](const std::string& p, VoxelUse use) { return open_tiff_stack(p, 1 << 12, use); });
     }},
    {"hdf5",
     [](Bytes b) {
       run_file(b, [](const std::string& p, VoxelUse use) { return open_hdf5_volume(p, {}, 1 << 12, use); });
     }},
};

}  // namespace

std::span<const Target> volume_targets() { return targets; }

}  // namespace tetwright::fuzz
