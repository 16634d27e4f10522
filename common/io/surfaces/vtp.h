// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/files/atomic_file.h"
#include "common/io/contents/dropped.h"
#include "common/io/contents/surface_with_fields.h"

namespace tetwright {

/// Reads the polygons of a VTK XML file of poly data (.vtp), in every encoding that read_vtu() knows.
/// Polygons become fans of triangles. A cell array of whole numbers that is_face_label() knows by its name
/// gives their groups; the other arrays, vertices and lines are appended to `dropped`, unless that is null.
/// `name` is used in messages. Throws InputError with the byte offset for anything that is malformed, and for
/// triangle strips.
///
/// Our own, on pugixml: libvtk9.1 takes 105 MB, without what it depends on.
TriangleMesh read_vtp(std::string_view bytes, const std::string& name,
                      std::vector<Dropped>* dropped = nullptr);

/// Reads the surface with the numeric arrays of PointData.
SurfaceWithFields read_vtp_with_fields(std::string_view bytes, const std::string& name);

/// The content of a file, compressed by zlib: points as Float64, and the cell array "surface", which numbers
/// the groups from 1, with their names as the FieldData array "surface_names" of UTF-8 lines
/// "NUMBER<tab>NAME".
void write_vtp(const TriangleMesh& mesh, const ByteSink& sink);

}  // namespace tetwright
