// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "common/io/volumes/voxel_data.h"
#include "common/io/volumes/voxel_source.h"

namespace tetwright {

/// Opens a stack of grey images: the pages of a TIFF or BigTIFF file, or the files of one page in a folder,
/// ordered by their names (slice_2 before slice_10). Rows are the second axis, pages the third one.
///
/// Spacing is that of ImageJ (in its unit) or OME-TIFF if the first page has their description. Otherwise it
/// follows from the resolution: in mm if that has a unit, and the same along the third axis. A resolution of
/// 1 or none is a spacing of 1. An image may have the channels that ImageJ or OME-TIFF names, each in pages
/// of its own. \param cache_bytes decoded strips and tiles that are kept, bytes \throws InputError naming the
/// page if pages differ in size or type, or are no grey images
std::unique_ptr<VoxelSource> open_tiff_stack(const std::string& path, std::size_t cache_bytes,
                                             VoxelUse use = VoxelUse::labels);

/// Whether a folder has a TIFF file.
bool has_tiff_files(const std::string& folder);

/// Whether the name `a` comes before `b` if runs of digits are compared as numbers.
bool natural_less(std::string_view a, std::string_view b);

}  // namespace tetwright
