// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/io/names/mesh_parts.h"
#include "common/io/volumes/data_file.h"
#include "tetwright/io.h"

namespace tetwright {

/// Reads the tets (type 10, or type 24 with ten nodes, reduced to their corners) of a VTK XML unstructured
/// grid: data inline or appended, ASCII, base64 or raw, uncompressed or compressed by zlib, LZ4 or LZMA, in
/// either byte order. Numeric arrays in PointData and CellData become fields; integers beyond 2^53 are
/// rounded. ReadTetMesh describes which of them is the material. Names of materials and sheets come from the
/// arrays written by write_vtu(), which mark the triangles that are sheets. Other volume cells are rejected;
/// vertices, lines, faces, text arrays and arrays of the whole dataset are counted in ReadTetMesh::dropped.
///
/// VTK itself is not used: libvtk9.1 takes 105 MB, without its dependencies. Uses pugixml.
/// \param name file name for messages
/// \throws InputError with the byte offset for malformed contents
ReadTetMesh read_vtu(std::string_view bytes, const std::string& name, const ReadTetMeshOptions& options = {});
/// Reads the pieces of several files as if they were in one.
/// \param name file name for messages about all of them
ReadTetMesh read_vtu_files(const std::vector<std::string>& files, const std::string& name,
                           const ReadTetMeshOptions& options, const FileReader& read_file);

/// Content of a file, compressed by zlib: points as Float64; materials as the integer cell field "material";
/// their names as the FieldData array "material_names" of UTF-8 lines "tag<TAB>name", in which underscores
/// replace control characters. Fields have the names of field_names_to_write() and are Float64, or Int32 or
/// Int64 if they are integers. Cells are the tets, and the triangles of sheets, which have no other means in
/// this format: the cell field "surface" gives the number of the sheet, 0 for a tet, and the FieldData array
/// "surface_names" the names. Triangles of the boundary and of interfaces are left out, since many readers
/// would take them for elements of the solver, except for those of parted interfaces. Cohesive elements are
/// wedges with a number of their own in `material`.
std::string write_vtu(const MeshToWrite& written);
/// Writes a file piece by piece: needs memory for a few MB and for the compressed numbers of one array at a
/// time.
void write_vtu(const MeshToWrite& written, const ByteSink& sink);

/// Names of the materials in this format; needs neither points nor tets.
std::vector<MeshParts::Material> vtu_materials(const TetMesh& mesh);
/// These, and the names of sheets and of the sides of parted interfaces; it has no other surfaces.
MeshParts vtu_parts(const TetMesh& mesh);

}  // namespace tetwright
