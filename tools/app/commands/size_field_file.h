// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "common/sizes/size_source.h"

namespace tetwright {

/// Throws UsageError, which lists what is read, unless the extension is one that read_size_field() knows. To
/// be called before any work.
void check_size_field_path(const std::string& file);

/// Reads the edge lengths that a user wants: of a .vdb file as read_vdb_sizes() does, of meshes as
/// read_mesh_sizes() does, with their errors.
std::unique_ptr<const SizeSource> read_size_field(const std::string& file);

}  // namespace tetwright
