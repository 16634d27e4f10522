// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <vector>

#include "common/tet_mesh.h"
#include "simplify/mesh/tet_record.h"

namespace tetwright {

/// Patches other than 0 by the points of their faces, ascending.
using FacePatches = std::map<Triangle, PatchId>;

/// Key of a face: its points, ascending.
Triangle face_key(Triangle points);

/// The patches after a renumbering of the points.
///
/// \param numbers new numbers by old ones.
FacePatches renumbered(const FacePatches& patches, const std::vector<Index>& numbers);

/// Sets the patches of the triangles that are listed; the others keep theirs.
void put_patches(const FacePatches& patches, std::vector<InterfaceTriangle>& triangles);

}  // namespace tetwright
