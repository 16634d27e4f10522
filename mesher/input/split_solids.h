// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/triangle_mesh.h"

namespace tetwright {

/// A surface for each group of triangles, in the order of their first triangles and without groups of their
/// own; the surface itself, called `name`, where it has none. A group without a name is called after `name`
/// and its number, and what is in no group `name`.
std::vector<NamedSurface> split_solids(TriangleMesh surface, const std::string& name);

}  // namespace tetwright
