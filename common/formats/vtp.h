#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/formats/dropped.h"
#include "common/formats/surface_with_fields.h"

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

/// The same with the arrays of numbers of PointData.
SurfaceWithFields read_vtp_with_fields(std::string_view bytes, const std::string& name);

}  // namespace tetwright
