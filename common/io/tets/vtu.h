// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "common/io/contents/mesh_to_write.h"
#include "common/io/contents/read_tet_mesh_result.h"
#include "common/io/names/mesh_parts.h"

namespace tetwright {

/// Reads the tets (type 10, or 24 of ten nodes, by their corners) of a VTK XML unstructured grid: data inline
/// or appended, ASCII, base64 or raw, compressed by zlib or not, in either byte order. Arrays of numbers in
/// PointData and CellData become fields; integers beyond 2^53 lose digits. ReadTetMesh describes which of
/// them is the material. Names of materials are read from the array that write_vtu() writes. Other volume
/// cells are refused; vertices, lines, faces, arrays of text and arrays of the whole dataset are counted in
/// ReadTetMesh::dropped. `name` is used in messages. Throws InputError with the byte offset for anything that
/// is malformed.
///
/// Our own, on pugixml: libvtk9.1 takes 105 MB, without what it depends on.
ReadTetMesh read_vtu(std::string_view bytes, const std::string& name, const ReadTetMeshOptions& options = {});

/// The content of a file, compressed by zlib: points as Float64, materials as the integer cell field
/// "material", their names as the FieldData array "material_names" of UTF-8 lines "tag<TAB>name", in which a
/// control character becomes an underscore. Fields have the names of field_names_to_write() and are Float64,
/// or Int32 or Int64 if they are integers. The cells are tets only: many readers take every cell for an
/// element of the solver, and would take interface triangles for such.
std::string write_vtu(const MeshToWrite& written);
/// The same in pieces: needs memory for some MB and for the compressed numbers of one array at a time.
void write_vtu(const MeshToWrite& written, const ByteSink& sink);

/// What it calls the materials; it has no surfaces.
MeshParts vtu_parts(const TetMesh& mesh);

}  // namespace tetwright
