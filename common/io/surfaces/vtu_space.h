// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pugixml.hpp>
#include <string>

#include "common/io/encodings/vtu_data.h"
#include "tetwright/io.h"

namespace tetwright {

/// The coordinate system that a child of FieldData names, see TetMesh::space: an array SPACE with the text
/// "LPS" or "RAS" as 3D Slicer writes it, or with its bytes.
/// \return empty for any other array, also for a damaged one
std::string space_of_vtu_array(const VtuData& data, pugi::xml_node array);

/// The system that the FieldData of a grid names, or empty.
std::string read_vtu_space(const VtuData& data, pugi::xml_node grid);

/// Writes such an array with the bytes of the text; nothing for another system.
void write_vtu_space(const ByteSink& sink, const std::string& space);

}  // namespace tetwright
