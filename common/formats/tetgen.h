#pragma once

#include <string>
#include <string_view>

#include "common/formats/read_tet_mesh_result.h"

namespace tetwright {

/// Reads the pair of files that TetGen writes: `node` (.node) and `ele` (.ele), whose names are used in
/// messages. Numbers begin at 0 or 1. Attributes of points become the fields "attribute1", "attribute2", ...,
/// boundary markers the integer field "boundary_marker". Attributes of tets become "attribute", "attribute2",
/// ..., of which the first is the material if its values are whole (see ReadTetMesh). Nothing in the two
/// files is dropped; .face and .edge files beside them are not read. Quadratic tets are refused. Throws
/// InputError with the line for anything that is malformed.
///
/// Our own: the library of TetGen is under the AGPL, and the format is small.
ReadTetMesh read_tetgen(std::string_view node, const std::string& node_name, std::string_view ele,
                        const std::string& ele_name, const ReadTetMeshOptions& options = {});

}  // namespace tetwright
