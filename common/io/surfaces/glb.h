// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tetwright/io.h"
#include "tetwright/surface_mesh.h"

namespace tetwright {

/// Reads the triangles of a binary glTF 2.0 file (.glb): those of its default scene, or of all scenes if it
/// has no default, placed by the transforms of the nodes. Vertices with equal coordinates are merged, since
/// the format repeats them wherever normals or textures differ. Each node is a group, with the name of the
/// node or else of its mesh, followed by a colon and the material's name if the mesh has several materials;
/// repeated names become NAME_2, NAME_3 and so on. Lines, points, skins, morph targets, animations, and
/// meshes that the scene does not show are dropped.
///
/// Uses nlohmann::json: tinygltf (2.7) follows unchecked offsets in damaged files and overflows the stack on
/// nested ones.
/// \param name file name for messages
/// \param dropped receives the dropped contents; may be null
/// \throws InputError with the accessor or node for malformed contents, for positions that are compressed,
///   quantised, sparse or in another file, and for extensions that change the shape
TriangleMesh read_glb(std::string_view bytes, const std::string& name,
                      std::vector<Dropped>* dropped = nullptr);

}  // namespace tetwright
