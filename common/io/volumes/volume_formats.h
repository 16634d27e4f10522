// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/io/volumes/data_file.h"
#include "common/io/volumes/encoded_volume.h"
#include "common/io/volumes/raw_volume.h"
#include "tetwright/files.h"
#include "tetwright/io.h"
#include "tetwright/label_source.h"

namespace tetwright {

class Progress;

/// A file or folder with volumes, and the volume in it.
struct VolumePath {
  std::string file;
  std::string inside;     ///< path of a dataset in an HDF5 file; empty: the only one
  std::string extension;  ///< of the format, in lower case; empty: none is known
};

/// Splits FILE.h5:/DATASET. Other paths have the format of their extension, or if that is none of a volume,
/// that of a folder: zarr arrays, also inside FOLDER.zarr, DICOM or TIFF files; or DICOM by the content of
/// the file.
VolumePath volume_path(const std::string& path);

/// A format of volumes: labels or images. It is read as bytes, or opened by name.
struct VolumeFormat {
  const char* extension;
  VolumeReader read = nullptr;
  RawVolumeFinder find = nullptr;  ///< null: voxels are always read as a whole
  std::unique_ptr<VoxelSource> (*open)(const VolumePath& path, std::size_t cache_bytes,
                                       VoxelUse use) = nullptr;
  /// Number of layers of overlapping segments, and their reader; null: there is always one.
  std::int64_t (*layers)(const HeaderBytes& head, const std::string& name) = nullptr;
  std::vector<LabelVolume> (*read_layers)(std::string_view bytes, const std::string& name,
                                          const FileReader& others) = nullptr;
  std::string (*write)(const LabelVolume& volume) = nullptr;  ///< null: the format can only be read
  /// Writes slab by slab; null like `write`. See write_label_source().
  void (*write_source)(const LabelSource& source, MaterialTag largest, const ByteSink& sink,
                       Progress* progress) = nullptr;
  const char* header = nullptr;  ///< extension of the header file
  bool one_file = true;          ///< false: the voxels are in another file
  bool headerless = false;       ///< true: VolumeFileOptions describe the voxels
};

std::span<const VolumeFormat> volume_formats();

/// Opens a volume that is read by boxes.
/// \return null if the file can only be read as a whole, since it is compressed or text
std::unique_ptr<VoxelSource> open_by_boxes(const VolumeFormat& format, const std::string& path,
                                           std::size_t cache_bytes, VoxelUse use,
                                           const VolumeFileOptions& options);

/// Number of layers of overlapping segments; 1 for other files.
std::int64_t layers_of(const VolumeFormat& format, const std::string& path);

/// Opens a volume in a stream.
/// \throws InputError if its voxels are in another file
EncodedVolume volume_of_bytes(const VolumeFormat& format, std::string_view bytes, const std::string& name,
                              VoxelUse use, const VolumeFileOptions& options);

/// Reads all layers of overlapping segments.
std::vector<LabelVolume> read_layers(const VolumeFormat& format, const std::string& path,
                                     const VolumeFileOptions& options);

/// Reads all labels, by boxes if possible.
LabelVolume read_whole_volume(const VolumeFormat& format, const std::string& path,
                              const VolumeFileOptions& options);

/// Reads all values of an image, by boxes if possible.
ImageVolume read_whole_image(const VolumeFormat& format, const std::string& path,
                             const VolumeFileOptions& options);

}  // namespace tetwright
