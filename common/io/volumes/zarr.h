// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "common/io/encodings/file_ranges.h"
#include "common/io/volumes/voxel_data.h"
#include "common/io/volumes/voxel_source.h"

namespace tetwright {

/// Opens the file at a path; null if there is none. This is FileRanges::if_there(), except in tests and
/// fuzzers, which have no files. May be called concurrently.
using FileOpener = std::function<std::unique_ptr<ByteRanges>(const std::string& path)>;

/// Opens an array of zarr 2 or 3, or the full resolution of an OME-Zarr image. An array in such an image has
/// its scale and translation as spacing and origin; other arrays have a spacing of 1. The last axis of an
/// array is x, unless its axes are called x, y and z; an image may have one more axis, of channels. \param
/// path the folder of the array or group \param cache_bytes decoded chunks that are kept, bytes. Each call of
/// read() takes the memory of a chunk
///   beside them, decoded and encoded
/// \throws InputError if there is none, the metadata are malformed, or a codec is not supported
std::unique_ptr<VoxelSource> open_zarr(const std::string& path, std::size_t cache_bytes,
                                       const FileOpener& open = FileRanges::if_there,
                                       VoxelUse use = VoxelUse::labels);

/// Whether a folder has the metadata of a zarr array or group.
bool is_zarr_folder(const std::string& path);

}  // namespace tetwright
