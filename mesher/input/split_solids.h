// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/triangle_mesh.h"

namespace tetwright {

/// Splits a surface into one for each group of triangles, in the order of their first triangles and without
/// groups of their own. A surface without groups is returned as it is, called `name`. A group without a name
/// is called after `name` and its number; triangles in no group form a surface called `name`.
std::vector<NamedSurface> split_solids(TriangleMesh surface, const std::string& name);

}  // namespace tetwright
