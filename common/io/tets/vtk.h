// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tetwright/io.h"

namespace tetwright {

/// Reads the tets (type 10, or type 24 with ten nodes, reduced to their corners) of a legacy VTK file (.vtk),
/// versions 1 to 5, ASCII or binary, with dataset UNSTRUCTURED_GRID. SCALARS, VECTORS, NORMALS, TENSORS,
/// texture coordinates, ids and FIELD arrays of POINT_DATA and CELL_DATA become fields; integers beyond 2^53
/// are rounded. ReadTetMesh describes which of them is the material. Other volume cells are rejected;
/// vertices, lines, faces, and arrays of text, of colours or of the whole dataset are counted in
/// ReadTetMesh::dropped; METADATA is skipped.
///
/// VTK itself is not used: libvtk9.1 takes 105 MB, without its dependencies.
/// \param name file name for messages
/// \throws InputError for malformed contents, with the line (in a binary file the number of preceding line
///   feeds plus one, as an editor counts)
ReadTetMesh read_vtk(std::string_view bytes, const std::string& name, const ReadTetMeshOptions& options = {});

/// Reads the polygons and triangle strips of a file with dataset POLYDATA, or the triangles, quads, polygons
/// and strips of an UNSTRUCTURED_GRID without volume cells, as triangles. A cell field of whole numbers whose
/// name is_face_label() knows gives the groups.
/// \param dropped counts vertices, lines and fields
/// \throws InputError in the cases of read_vtk(), and for a file with tets
TriangleMesh read_vtk_surface(std::string_view bytes, const std::string& name, std::vector<Dropped>* dropped);
/// Reads such a surface with its point fields.
/// \return std::nullopt for a file with tets
std::optional<SurfaceWithFields> read_vtk_surface_with_fields(std::string_view bytes,
                                                              const std::string& name);

/// Writes a legacy VTK file, version 3.0, ASCII, which the simplest readers support. The mesh's interfaces,
/// if any, are triangles after the tets. The cell field "material" holds the tags of both (for a triangle the
/// tag on its inner side), "surface" the group numbers of the triangles, 0 for tets. Names of materials and
/// surfaces are field data of the dataset, as the bytes of lines "NUMBER<tab>NAME". The title names the
/// coordinate system as 3D Slicer does (SPACE=LPS). Point fields at midside
/// nodes are means of both endpoints; cell fields on triangles are NaN, or 0 if integer.
void write_vtk(const MeshToWrite& written, const ByteSink& sink);

}  // namespace tetwright
