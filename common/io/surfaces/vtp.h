// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tetwright/files.h"
#include "tetwright/io.h"

namespace tetwright {

/// Reads the polygons of a VTK XML file of poly data (.vtp), in every encoding that read_vtu() supports.
/// Polygons become fans of triangles. Groups are given by the first cell array whose name is_face_label()
/// knows and which has a text (the group's name) or a whole number for each cell.
///
/// No library is used except pugixml: libvtk9.1 takes 105 MB, without its dependencies.
/// \param name file name for messages
/// \param dropped receives the other arrays, vertices and lines; may be null
/// \throws InputError with the byte offset for malformed contents, and for triangle strips
TriangleMesh read_vtp(std::string_view bytes, const std::string& name,
                      std::vector<Dropped>* dropped = nullptr);

/// Reads the surface, and the numeric arrays of PointData as point fields.
SurfaceWithFields read_vtp_with_fields(std::string_view bytes, const std::string& name);

/// Content of a file, compressed by zlib: points as Float64; the cell array "surface" with the number of each
/// triangle's group, from 1; and the groups' names as the FieldData array "surface_names" of UTF-8 lines
/// "NUMBER<tab>NAME".
void write_vtp(const TriangleMesh& mesh, const ByteSink& sink);

}  // namespace tetwright
