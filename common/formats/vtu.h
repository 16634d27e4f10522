#pragma once

#include <string>
#include <string_view>

#include "common/formats/atomic_file.h"
#include "common/formats/read_tet_mesh_result.h"

namespace tetwright {

/// Reads the linear tets (type 10) of a VTK XML unstructured grid: data inline or appended, ASCII, base64 or
/// raw, compressed by zlib or not, in either byte order; other cells are skipped. Arrays of numbers in
/// PointData and CellData become fields; integers beyond 2^53 lose digits. Which cell field gives the
/// material: see ReadTetMesh. Names of materials are read where write_vtu() puts them. `name` stands in
/// messages. Throws InputError with the byte offset for anything that makes no sense.
ReadTetMesh read_vtu(std::string_view bytes, const std::string& name, const ReadTetMeshOptions& options = {});

/// The file's content: zlib-compressed, points as Float64, the integer cell field "material"; names as the
/// field "material_names", UTF-8 bytes of lines "tag<TAB>name". A control character in a name becomes an
/// underscore. Fields under the names that field_names_to_write() gives them, as Float64, or as Int32 or
/// Int64 where they are integers. Tets only: the cell fields are those of a solver's elements, and readers
/// that take every cell for an element would stumble over interface triangles.
std::string write_vtu(const TetMesh& mesh);
/// The same for a file that is larger than what should be in memory: some MB and the compressed numbers of
/// one array at a time.
void write_vtu(const TetMesh& mesh, const ByteSink& sink);

}  // namespace tetwright
