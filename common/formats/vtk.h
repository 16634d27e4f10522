#pragma once

#include <string>
#include <string_view>

#include "common/formats/read_tet_mesh_result.h"

namespace tetwright {

/// Reads the linear tets (type 10) of a legacy VTK file (.vtk), versions 1 to 5, ASCII or binary, of dataset
/// UNSTRUCTURED_GRID. Points, lines and faces are skipped, other volume cells refused. SCALARS, VECTORS,
/// NORMALS, TENSORS, texture coordinates, ids and FIELD arrays of POINT_DATA and CELL_DATA become fields;
/// integers beyond 2^53 lose digits. Which cell field gives the material: see ReadTetMesh. `name` stands in
/// messages. Throws InputError with the line (in a binary file: one more than the line ends before it, as an
/// editor would count) for anything that makes no sense.
ReadTetMesh read_vtk(std::string_view bytes, const std::string& name, const ReadTetMeshOptions& options = {});

}  // namespace tetwright
