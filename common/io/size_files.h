// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "tetwright/sizes.h"

namespace tetwright {

/// Checks that the extension belongs to meshes that may have point fields. Call it before any work.
/// \param others other extensions that the caller reads, such as ".vdb", for the message
/// \throws UsageError listing the extensions
void check_mesh_sizes_path(const std::string& file, const std::string& others = "");

/// Reads the edge lengths at the points of a tet mesh, or of a surface if there are no tets, from a scalar
/// point field: the first name in size_names that the file has, otherwise its only floating-point field,
/// otherwise its only field.
/// \throws UsageError as check_mesh_sizes_path()
/// \throws InputError, beginning with `file`, if the file is missing or malformed, has no such field or
///   several (listing their names), or if a value is not finite or not above 0 at a point that a tet or
///   triangle uses
std::unique_ptr<const SizeSource> read_mesh_sizes(const std::string& file);

}  // namespace tetwright
