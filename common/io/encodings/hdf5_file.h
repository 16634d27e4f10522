// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "tetwright/file_sharing.h"
#include "tetwright/files.h"

namespace tetwright {

/// Writes an HDF5 file as one of `files`.
/// \param content adds the contents
/// \param share null: this process writes it alone, in memory
void write_hdf5_file(const std::string& path, OutputFiles& files,
                     const std::function<void(Hdf5Writer&)>& content, const FileSharing* share);

}  // namespace tetwright
