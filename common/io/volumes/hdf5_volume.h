// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "common/io/volumes/voxel_data.h"
#include "common/io/volumes/voxel_source.h"

namespace tetwright {

/// Opens a dataset of three axes in an HDF5 file. The last axis is x, unless the attribute `axistags` of
/// ilastik names the axes. The attribute `element_size_um` (z, y, x) is the spacing in micrometres; without
/// it the spacing is 1.
///
/// The library's calls take turns: several threads decode no faster than one.
/// \param dataset its path in the file; empty: the only dataset of three axes and whole numbers, or for an
///   image of numbers, with another axis if it has channels
/// \param cache_bytes decoded chunks that are kept, bytes
/// \throws InputError if the file is no HDF5 file, has no such dataset or several, or the dataset is
/// compressed by
///   a filter that the library does not have
std::unique_ptr<VoxelSource> open_hdf5_volume(const std::string& path, const std::string& dataset,
                                              std::size_t cache_bytes, VoxelUse use = VoxelUse::labels);

}  // namespace tetwright
