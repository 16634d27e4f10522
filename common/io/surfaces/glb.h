// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/io/contents/dropped.h"
#include "common/triangle_mesh.h"

namespace tetwright {

/// Reads the triangles of a binary glTF 2.0 file (.glb): those of its default scene, or of all scenes where
/// it names none, placed by the nodes' transforms. Vertices at the same place become one, since the format
/// repeats them wherever normals or textures differ. What a node shows is a group, by the node's name or else
/// its mesh's, with that of the material behind a colon where a mesh has several; of equal names the later
/// ones become NAME_2, NAME_3 and so on. Lines, points, skins, morph targets, animations and meshes that the
/// scene does not show are left out and appended to `dropped`, unless that is null. `name` is used in
/// messages. Throws InputError with the accessor or node for anything that is malformed, for positions that
/// are compressed, quantised, sparse or in another file, and for extensions that change the shape.
///
/// On nlohmann::json: tinygltf (2.7) follows unchecked offsets in damaged files and overflows the stack on
/// nested ones.
TriangleMesh read_glb(std::string_view bytes, const std::string& name,
                      std::vector<Dropped>* dropped = nullptr);

}  // namespace tetwright
