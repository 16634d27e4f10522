// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "tetwright/sizes.h"

namespace tetwright {

/// Checks the extension of a size field's file. Call it before any work.
///
/// \throws UsageError listing the known extensions, unless read_size_field() can read the file
void check_size_field_path(const std::string& file);

/// Reads target edge lengths: from a .vdb file by read_vdb_sizes(), from a mesh by read_mesh_sizes().
///
/// \throws Error in the cases of these functions
std::unique_ptr<const SizeSource> read_size_field(const std::string& file);

}  // namespace tetwright
