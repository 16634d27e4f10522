#pragma once

#include <string>
#include <string_view>

#include "common/formats/mesh_to_write.h"
#include "common/formats/read_tet_mesh_result.h"

namespace tetwright {

/// Reads the pair of files that TetGen writes: `node` (.node) and `ele` (.ele), whose names are used in
/// messages. Numbers begin at 0 or 1. Attributes of points become the fields "attribute1", "attribute2", ...,
/// boundary markers the integer field "boundary_marker". Attributes of tets become "attribute", "attribute2",
/// ..., of which the first is the material if its values are whole (see ReadTetMesh). Quadratic
/// tets are taken by their corners; nothing else in the two files is dropped; .face and .edge files beside
/// them are not read. Throws
/// InputError with the line for anything that is malformed.
///
/// Our own: the library of TetGen is under the AGPL, and the format is small.
ReadTetMesh read_tetgen(std::string_view node, const std::string& node_name, std::string_view ele,
                        const std::string& ele_name, const ReadTetMeshOptions& options = {});

/// The content of the three files of a mesh: points, tets with the tag of the material as their attribute,
/// and the faces of the interfaces, if it has any, with the number of their group (see BoundaryGroups) as
/// boundary marker. Numbers begin at 1. Comments at the beginning of .ele and .face give the names. Neither
/// fields nor midside nodes are written.
void write_tetgen_node(const MeshToWrite& written, const ByteSink& sink);
void write_tetgen_ele(const MeshToWrite& written, const ByteSink& sink);
void write_tetgen_face(const MeshToWrite& written, const ByteSink& sink);

}  // namespace tetwright
