// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "common/io/volumes/data_file.h"
#include "common/io/volumes/encoded_volume.h"
#include "common/io/volumes/raw_volume.h"
#include "tetwright/label_volume.h"

namespace tetwright {

/// Opens a NIfTI volume of version 1 or 2, in one file or as a header (.hdr) with the voxels in a separate
/// .img file; optionally compressed with gzip (determined by the content, not by the extension); in either
/// byte order. Coordinates follow the sform, else the qform, else only the spacing.
///
/// No library is used: libnifti2 3.0.1 prints to stderr when it converts headers, and silently replaces by 1
/// spacings that are zero or not finite and sizes below 1, which must be rejected here.
/// An image may have one axis of times or of vectors, dim[4] to dim[7], whose items are its channels.
/// \param read_file reads the .img file
/// \throws InputError for malformed contents
EncodedVolume open_nifti(std::string_view bytes, const std::string& name, const FileReader& read_file,
                         VoxelUse use);

/// Reads the labels of a NIfTI volume.
LabelVolume read_nifti(std::string_view bytes, const std::string& name, const FileReader& read_file);

/// RawVolumeFinder of NIfTI.
std::optional<RawVolume> find_nifti(const HeaderBytes& head, const std::string& name,
                                    VoxelUse use = VoxelUse::labels);

}  // namespace tetwright
