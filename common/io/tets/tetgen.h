// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "common/io/contents/mesh_to_write.h"
#include "common/io/contents/read_tet_mesh_result.h"
#include "common/io/volumes/data_file.h"

namespace tetwright {

/// Reads the files that TetGen writes: `node` (.node), `ele` (.ele) and optionally `face` (.face). Numbers
/// begin at 0 or 1. Attributes of points become the fields "attribute1", "attribute2", ..., boundary markers
/// the integer field "boundary_marker". Attributes of tets become "attribute", "attribute2", ..., the first
/// of which is the material if its values are whole (see ReadTetMesh). Faces with a boundary marker other
/// than 0 become patches, see take_triangles(). Names of materials and markers come from the comments of this
/// writer. Quadratic tets are reduced to their corners; nothing else in the files is dropped; a .edge file
/// beside them is not read.
///
/// Not a library: TetGen's is under the AGPL, and the format is small.
/// \throws InputError with the line for malformed contents
ReadTetMesh read_tetgen(const NamedBytes& node, const NamedBytes& ele, const std::optional<NamedBytes>& face,
                        const ReadTetMeshOptions& options = {});

/// Write the three files of a mesh: points, tets with the tag of the material as their attribute, and the
/// faces of the interfaces, if any, with the number of their group (see BoundaryGroups) as boundary marker.
/// Numbers begin at 1. Comments at the beginning of .ele and .face give the names. Neither fields nor midside
/// nodes are written.
void write_tetgen_node(const MeshToWrite& written, const ByteSink& sink);
void write_tetgen_ele(const MeshToWrite& written, const ByteSink& sink);
void write_tetgen_face(const MeshToWrite& written, const ByteSink& sink);

}  // namespace tetwright
