// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace tetwright {

/// Coordinate system that a header or comment of a surface file names by SPACE=LPS or SPACE=RAS, as 3D Slicer
/// writes it, in the form of TriangleMesh::space. Empty if it names none, or another one.
std::string declared_space(std::string_view header);

/// The system that one of the comments before the first statement of a text file names.
/// \param comment character that begins a comment
std::string space_in_comments(std::string_view bytes, char comment);

/// The system that is called "LPS" or "RAS", in the form of TriangleMesh::space; empty for other names.
std::string space_called(std::string_view name);
/// The inverse of space_called(); empty for other spaces.
std::string short_name_of_space(std::string_view space);

}  // namespace tetwright
