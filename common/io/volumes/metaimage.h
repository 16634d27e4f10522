// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "common/files/atomic_file.h"
#include "common/io/volumes/data_file.h"
#include "common/label_volume.h"

namespace tetwright {

/// Reads a MetaImage volume of ITK. The voxels are binary, compressed or text, and follow the header (.mha)
/// or are in another file (.mhd).
///
/// Not a library: MetaIO is only packaged as part of ITK, which takes 150 MB and more.
/// \param name used in messages
/// \param read reads that other file
/// \throws InputError with the line of the header for malformed contents
LabelVolume read_metaimage(std::string_view bytes, const std::string& name,
                           const FileReader& read = read_whole_file);

}  // namespace tetwright
