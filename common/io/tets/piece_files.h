// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/io/tets/tet_formats.h"
#include "tetwright/file_sharing.h"

namespace tetwright {

/// Writes the files of a mesh in parts.
/// \param share null: this process writes all of them
void write_part_files(const TetFormat& format, const MeshPieces& pieces, const std::string& path,
                      OutputFiles& files, const FileSharing* share);

}  // namespace tetwright
