// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/io/contents/mesh_to_write.h"
#include "common/io/contents/read_tet_mesh_result.h"
#include "common/io/names/mesh_parts.h"
#include "common/triangle_mesh.h"

namespace tetwright {

/// Reads the sections Vertices and Tetrahedra of a Medit ASCII mesh (.mesh). The reference of a tet is its
/// material ("medit:ref"), those of triangles are groups of faces (see take_triangles()), of which
/// write_medit()'s comments give the names and tell those of a pair of materials; the format has no place for
/// fields. Sections of other volume cells are refused, what other sections hold is counted in
/// ReadTetMesh::dropped. `name` is used in messages. Throws InputError with the line for anything that is
/// malformed.
///
/// Our own: libMeshb reports that a file can't be read without saying where and why.
ReadTetMesh read_medit(std::string_view bytes, const std::string& name,
                       const ReadTetMeshOptions& options = {});

/// Reads the sections Vertices, Triangles and Quadrilaterals, cut in two, of such a file as a surface:
/// references are its groups. What else it holds is appended to `dropped`, unless that is null. Throws
/// InputError as read_medit() does, and for a file with tets.
TriangleMesh read_medit_surface(std::string_view bytes, const std::string& name,
                                std::vector<Dropped>* dropped = nullptr);

/// The content of a file; coordinates are read back bit by bit. The format has no place for fields and for
/// names of materials. The interface triangles of the mesh, if it has any, are written as section Triangles:
/// their reference is the number of their group (see BoundaryGroups), and a comment gives its name, or the
/// tags of a pair of materials, or the number that the user's group had.
std::string write_medit(const MeshToWrite& written);

/// What it calls the groups of the user; materials have no names.
MeshParts medit_parts(const TetMesh& mesh);

}  // namespace tetwright
