// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "common/io/names/mesh_parts.h"
#include "tetwright/io.h"

namespace tetwright {

/// Starts of write_nastran()'s comments that give names; "NUMBER: NAME" follows.
inline constexpr std::string_view nastran_material_comment = "$ material ";
inline constexpr std::string_view nastran_surface_comment = "$ surface ";

/// Constraints on tags, numbers and names in write_nastran().
NameRules nastran_names();

/// Reads the mesh of a Nastran bulk data file, in free, small and large field format: GRID in the basic
/// coordinate system, CTETRA of 4 or 10 points (reduced to their corners) with the property as material, and
/// BSURFS as groups of faces, see take_triangles(). Names come from write_nastran()'s comments. Other
/// three-dimensional elements, other coordinate systems and INCLUDE are rejected. Further elements are
/// counted in ReadTetMesh::dropped; entries unrelated to the mesh are skipped.
///
/// No library is used: no packaged one reads the format.
/// \throws InputError with the line for malformed contents
ReadTetMesh read_nastran(std::string_view bytes, const std::string& name,
                         const ReadTetMeshOptions& options = {});

/// Writes a Nastran bulk data file: GRID in the large field format; CTETRA of 4 or 10 points; a PSOLID for
/// each material, whose MAT1 of the same number must be added by the user; and for each surface of a mesh
/// with interfaces a BSURFS of element faces (on the side of the smaller tag) and a SET1 of its points, both
/// with the number of the group. The format has no names: comments before the entries give them. Tags and
/// group numbers are kept if they are above 0 and have at most eight digits. The format has no fields.
///
/// Coordinates are rounded to 16 characters: 9 digits in the worst case, 13 in most.
/// \throws OutputError for more than 99,999,999 nodes or tets, whose numbers do not fit
void write_nastran(const MeshToWrite& written, const ByteSink& sink);

}  // namespace tetwright
