// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "common/io/volumes/data_file.h"
#include "tetwright/io.h"

namespace tetwright {

/// Reads files written by TetGen: `node` (.node), `ele` (.ele) and optionally `face` (.face). Numbers start
/// at 0 or 1. Attributes of points become the fields "attribute1", "attribute2" and so on, boundary markers
/// the integer field "boundary_marker". Attributes of tets become "attribute", "attribute2" and so on; the
/// first is the material if its values are whole (see ReadTetMesh). Faces with a boundary marker other than 0
/// become patches, see take_triangles(). Names of materials and markers come from the comments of the writers
/// below. Quadratic tets are reduced to their corners. All other contents of these files are kept; an .edge
/// file with the same name is not read.
///
/// No library is used: TetGen's is under the AGPL, and the format is small.
/// \throws InputError with the line for malformed contents
ReadTetMesh read_tetgen(const NamedBytes& node, const NamedBytes& ele, const std::optional<NamedBytes>& face,
                        const ReadTetMeshOptions& options = {});

/// Write the three files of a mesh: points; tets with the material's tag as their attribute; and the
/// interface triangles, if any, with the number of their group (see BoundaryGroups) as boundary marker.
/// Numbers start at 1. Comments at the beginning of .ele and .face give the names. Fields and midside nodes
/// are not written.
void write_tetgen_node(const MeshToWrite& written, const ByteSink& sink);
void write_tetgen_ele(const MeshToWrite& written, const ByteSink& sink);
void write_tetgen_face(const MeshToWrite& written, const ByteSink& sink);

}  // namespace tetwright
