// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "common/io/volumes/data_file.h"
#include "common/label_volume.h"

namespace tetwright {

/// Reads a NIfTI volume of version 1 or 2, in one file or as a header (.hdr) whose voxels are in a file .img
/// beside it, which `read_file` reads; compressed with gzip or not (the content decides, not the extension),
/// in either byte order. Coordinates follow the sform, without one the qform, without both the spacing alone.
/// `name` is used in messages. Throws InputError for anything that is malformed.
///
/// Our own reader of the bytes that matter: the conversion of headers in libnifti2 3.0.1 prints to
/// stderr, and silently turns spacings that are zero or not finite and sizes below 1 into 1, which must be
/// refused here.
LabelVolume read_nifti(std::string_view bytes, const std::string& name, const FileReader& read_file);

}  // namespace tetwright
