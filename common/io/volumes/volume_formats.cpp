// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/volume_formats.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include "common/files/file_names.h"
#include "common/io/volumes/dicom.h"
#include "common/io/volumes/dicom_elements.h"
#include "common/io/volumes/hdf5_volume.h"
#include "common/io/volumes/headerless.h"
#include "common/io/volumes/inr.h"
#include "common/io/volumes/metaimage.h"
#include "common/io/volumes/nifti.h"
#include "common/io/volumes/npy.h"
#include "common/io/volumes/nrrd.h"
#include "common/io/volumes/tiff_stack.h"
#include "common/io/volumes/zarr.h"
#include "common/lower_case.h"
#include "tetwright/error.h"
#include "tetwright/files.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

/// Chunks that are kept while a whole volume is read: each is needed once.
constexpr std::size_t whole_volume_cache = std::size_t{1} << 24;

std::unique_ptr<VoxelSource> open_zarr_path(const VolumePath& path, std::size_t cache_bytes, VoxelUse use) {
  return open_zarr(path.file, cache_bytes, FileRanges::if_there, use);
}

std::unique_ptr<VoxelSource> open_tiff_path(const VolumePath& path, std::size_t cache_bytes, VoxelUse use) {
  return open_tiff_stack(path.file, cache_bytes, use);
}

std::unique_ptr<VoxelSource> open_dicom_path(const VolumePath& path, std::size_t cache_bytes, VoxelUse use) {
  return open_dicom(path.file, cache_bytes, use);
}

std::unique_ptr<VoxelSource> open_hdf5_path(const VolumePath& path, std::size_t cache_bytes, VoxelUse use) {
  return open_hdf5_volume(path.file, path.inside, cache_bytes, use);
}

constexpr std::array<VolumeFormat, 18> formats_of_volumes{
    {{.extension = ".nrrd",
      .read = open_nrrd,
      .find = find_nrrd,
      .layers = nrrd_layers,
      .read_layers = read_nrrd_layers,
      .write = write_nrrd,
      .write_source = write_raw_nrrd},
     {.extension = ".nhdr",
      .read = open_nrrd,
      .find = find_nrrd,
      .layers = nrrd_layers,
      .read_layers = read_nrrd_layers,
      .one_file = false},
     {.extension = ".mhd", .read = open_metaimage, .find = find_metaimage, .one_file = false},
     {.extension = ".mha", .read = open_metaimage, .find = find_metaimage},
     {.extension = ".nii", .read = open_nifti, .find = find_nifti},
     {.extension = ".nii.gz", .read = open_nifti, .find = find_nifti},
     {.extension = ".hdr", .read = open_nifti, .find = find_nifti, .one_file = false},
     {.extension = ".img", .read = open_nifti, .find = find_nifti, .header = ".hdr", .one_file = false},
     {.extension = ".inr", .read = open_inr},
     {.extension = ".inr.gz", .read = open_inr},
     {.extension = ".zarr", .open = open_zarr_path},
     {.extension = ".tif", .open = open_tiff_path},
     {.extension = ".tiff", .open = open_tiff_path},
     {.extension = ".dcm", .open = open_dicom_path},
     {.extension = ".h5", .open = open_hdf5_path},
     {.extension = ".hdf5", .open = open_hdf5_path},
     {.extension = ".npy", .read = open_npy, .find = find_npy},
     {.extension = ".raw", .headerless = true}}};

/// A volume in bytes that were read.
EncodedVolume encoded_volume(const VolumeFormat& format, std::string_view bytes, const std::string& name,
                             VoxelUse use, const VolumeFileOptions& options, const FileReader& others) {
  EncodedVolume volume =
      format.headerless ? encoded_headerless(bytes, name, options) : format.read(bytes, name, others, use);
  if (options.spacing) set_spacing(volume.grid, *options.spacing);
  return volume;
}

/// Reads a file, which is in memory beside its voxels.
std::string read_volume_file(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_regular_file(path, error))
    require_memory(static_cast<double>(std::filesystem::file_size(path, error)), "the file " + path,
                   "crop the volume or make it coarser");
  return read_whole_file(path);
}

/// Whether a folder of the path is a zarr hierarchy by its name.
bool is_in_zarr(const std::string& path) {
  for (const std::filesystem::path& part : std::filesystem::path(path))
    if (lower_case(part.extension().string()) == ".zarr") return true;
  return false;
}

}  // namespace

VolumePath volume_path(const std::string& path) {
  const std::string lower = lower_case(path);
  for (const std::string extension : {".h5", ".hdf5"})
    if (const std::size_t at = lower.find(extension + ":/"); at != std::string::npos) {
      const std::size_t colon = at + extension.size();
      return {path.substr(0, colon), path.substr(colon + 1), extension};
    }
  VolumePath out{path, {}, extension_of(path)};
  if (std::any_of(formats_of_volumes.begin(), formats_of_volumes.end(),
                  [&](const VolumeFormat& format) { return out.extension == format.extension; }))
    return out;
  if (is_in_zarr(path)) {
    out.extension = ".zarr";
  } else if (std::error_code error; std::filesystem::is_directory(path, error)) {
    if (is_zarr_folder(path))
      out.extension = ".zarr";
    else if (has_dicom_files(path))
      out.extension = ".dcm";
    else if (has_tiff_files(path))
      out.extension = ".tif";
  } else if (is_dicom_file(path)) {
    out.extension = ".dcm";
  }
  return out;
}

std::span<const VolumeFormat> volume_formats() { return formats_of_volumes; }

std::unique_ptr<VoxelSource> open_by_boxes(const VolumeFormat& format, const std::string& path,
                                           std::size_t cache_bytes, VoxelUse use,
                                           const VolumeFileOptions& options) {
  std::unique_ptr<VoxelSource> source;
  std::error_code error;
  if (format.open)
    source = format.open(volume_path(path), cache_bytes, use);
  else if (format.headerless && std::filesystem::is_regular_file(path, error))
    source = open_raw_volume(headerless_volume(path, FileRanges(path).size(), options));
  else if (format.find)
    source = find_raw_volume(format.header ? with_extension(path, format.header) : path, format.find, use);
  if (source && options.spacing) source->set_spacing(*options.spacing);
  return source;
}

std::int64_t layers_of(const VolumeFormat& format, const std::string& path) {
  std::error_code error;
  if (!format.layers || !std::filesystem::is_regular_file(path, error)) return 1;
  const FileRanges file(path);
  const ByteBuffer head = file.head(max_header_bytes);
  return format.layers({head.view(), file.size()}, path);
}

std::vector<LabelVolume> read_layers(const VolumeFormat& format, const std::string& path,
                                     const VolumeFileOptions& options) {
  std::vector<LabelVolume> layers;
  if (format.read_layers)
    layers = format.read_layers(read_whole_file(path), path, read_whole_file);
  else
    layers.push_back(read_whole_volume(format, path, {options.dimensions, options.voxel_type, {}}));
  if (options.spacing)
    for (LabelVolume& layer : layers) set_spacing(layer, *options.spacing);
  return layers;
}

EncodedVolume volume_of_bytes(const VolumeFormat& format, std::string_view bytes, const std::string& name,
                              VoxelUse use, const VolumeFileOptions& options) {
  return encoded_volume(format, bytes, name, use, options, [&](const std::string& other) -> std::string {
    throw InputError(name, 0, "its voxels are in another file, " + other + "; give the header's name");
  });
}

LabelVolume read_whole_volume(const VolumeFormat& format, const std::string& path,
                              const VolumeFileOptions& options) {
  if (const auto source = open_by_boxes(format, path, whole_volume_cache, VoxelUse::labels, options))
    return read_all(*source, path);
  const std::string first = format.header ? with_extension(path, format.header) : path;
  const std::string bytes = read_volume_file(first);
  const HeldMemory held(static_cast<double>(bytes.size()));
  return labels_of(encoded_volume(format, bytes, first, VoxelUse::labels, options, read_whole_file));
}

ImageVolume read_whole_image(const VolumeFormat& format, const std::string& path,
                             const VolumeFileOptions& options) {
  if (const auto source = open_by_boxes(format, path, whole_volume_cache, VoxelUse::image, options))
    return read_all_values(*source, path);
  const std::string first = format.header ? with_extension(path, format.header) : path;
  const std::string bytes = read_volume_file(first);
  const HeldMemory held(static_cast<double>(bytes.size()));
  return image_of(encoded_volume(format, bytes, first, VoxelUse::image, options, read_whole_file));
}

}  // namespace tetwright
