// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <vector>

#include "common/tet_mesh.h"
#include "simplify/mesh/tet_record.h"

namespace tetwright {

/// Patches other than 0 by the points of their faces, ascending.
using FacePatches = std::map<Triangle, PatchId>;

/// The key of a face.
Triangle face_key(Triangle points);

/// The same with other numbers of the points, by the old ones.
FacePatches renumbered(const FacePatches& patches, const std::vector<Index>& numbers);

/// Gives triangles the patches that are listed for them; the others keep theirs.
void put_patches(const FacePatches& patches, std::vector<InterfaceTriangle>& triangles);

}  // namespace tetwright
