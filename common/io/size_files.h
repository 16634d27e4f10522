// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "common/sizes/size_source.h"

namespace tetwright {

/// Throws UsageError unless the extension is of meshes whose points may have numbers; the message lists these
/// extensions, and `others` that the caller reads, such as ".vdb". To be called before any work.
void check_mesh_sizes_path(const std::string& file, const std::string& others = "");

/// Reads the edge lengths at the points of a tet mesh, or of a surface if there are no tets: a point field
/// with one number for each point, which is the first that the file has of size_names, else the only one of
/// floating-point numbers, else the only one.
///
/// Throws UsageError as check_mesh_sizes_path() does; InputError that begins with `file` if it is missing or
/// malformed, if it has no such field or several (with their names), and for a number that is not finite or
/// not above 0 at a point that a tet or triangle uses.
std::unique_ptr<const SizeSource> read_mesh_sizes(const std::string& file);

}  // namespace tetwright
