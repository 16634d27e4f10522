// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "common/sizes/size_source.h"

namespace tetwright {

/// Checks that the extension is of meshes that may have fields of points; call it before any work.
/// \param others extensions that the caller reads, such as ".vdb", for the message
/// \throws UsageError, which lists the extensions
void check_mesh_sizes_path(const std::string& file, const std::string& others = "");

/// Reads the edge lengths at the points of a tet mesh, or of a surface if there are no tets, from a scalar
/// point field: the first of size_names that the file has, otherwise the only one of floating-point numbers,
/// otherwise the only one.
/// \throws UsageError as check_mesh_sizes_path()
/// \throws InputError, beginning with `file`, if the file is missing or malformed, has no such field or
///   several (listing their names), or a number is not finite or not above 0 at a point that a tet or
///   triangle uses
std::unique_ptr<const SizeSource> read_mesh_sizes(const std::string& file);

}  // namespace tetwright
