// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/io/names/mesh_parts.h"
#include "tetwright/files.h"
#include "tetwright/io.h"

namespace tetwright {

/// Materials of the mesh and groups of its boundary, with names that are identifiers and unique among all of
/// them.
MeshParts usd_parts(const TetMesh& mesh);

/// Writes the mesh as a TetMesh of Universal Scene Description (recent versions of OpenUSD) in a text file:
/// points in single precision, tets, and faces of the boundary as the surface. Each material is a GeomSubset
/// of tetrahedra in the family materialBind, each group of boundary faces a GeomSubset of faces in the family
/// boundary; both have their own name in the attribute tetwright:name. Faces between materials and of sheets
/// are left out, as the surface of a TetMesh is its outside. The file has neither unit nor axis.
///
/// No library is used: Debian has none, and the text is a list of numbers.
/// \pre no midside nodes
/// \throws InputError if a coordinate is beyond single precision
void write_usd(const MeshToWrite& written, const ByteSink& sink);

}  // namespace tetwright
