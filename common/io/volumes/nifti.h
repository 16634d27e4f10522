// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "common/io/volumes/data_file.h"
#include "common/label_volume.h"

namespace tetwright {

/// Reads a NIfTI volume of version 1 or 2, in one file or as a header (.hdr) with the voxels in an .img file
/// beside it; compressed with gzip or not (the content decides, not the extension), in either byte order.
/// Coordinates follow the sform, otherwise the qform, otherwise the spacing alone.
///
/// Not a library: libnifti2 3.0.1 prints to stderr when it converts headers, and silently turns spacings that
/// are zero or not finite and sizes below 1 into 1, which must be rejected here.
/// \param name used in messages
/// \param read_file reads the .img file
/// \throws InputError for malformed contents
LabelVolume read_nifti(std::string_view bytes, const std::string& name, const FileReader& read_file);

}  // namespace tetwright
