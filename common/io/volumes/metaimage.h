// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "common/io/volumes/data_file.h"
#include "common/io/volumes/encoded_volume.h"
#include "common/io/volumes/raw_volume.h"
#include "tetwright/files.h"
#include "tetwright/label_volume.h"

namespace tetwright {

/// Opens an ITK MetaImage volume. The voxels are binary, compressed or text, and follow the header (.mha) or
/// are in a separate file (.mhd).
///
/// No library is used: MetaIO is packaged only as part of ITK, which takes 150 MB or more.
/// \param read reads the separate file
/// \throws InputError with the line of the header for malformed contents
EncodedVolume open_metaimage(std::string_view bytes, const std::string& name, const FileReader& read,
                             VoxelUse use);

/// Reads the labels of a MetaImage volume.
LabelVolume read_metaimage(std::string_view bytes, const std::string& name,
                           const FileReader& read = read_whole_file);

/// RawVolumeFinder of MetaImage.
std::optional<RawVolume> find_metaimage(const HeaderBytes& head, const std::string& name,
                                        VoxelUse use = VoxelUse::labels);

}  // namespace tetwright
