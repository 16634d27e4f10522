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

/// Reads the sections Vertices and Tetrahedra of a Medit ASCII mesh (.mesh). References of tets are materials
/// ("medit:ref"); those of triangles are groups of faces (see take_triangles()), which write_medit()'s
/// comments name or identify as those of a pair of materials. The format has no fields. Sections of other
/// volume cells are rejected, contents of other sections are counted in ReadTetMesh::dropped.
///
/// Not a library: libMeshb reports that a file cannot be read without saying where and why.
/// \param name used in messages
/// \throws InputError with the line for malformed contents
ReadTetMesh read_medit(std::string_view bytes, const std::string& name,
                       const ReadTetMeshOptions& options = {});

/// Reads the sections Vertices, Triangles and Quadrilaterals (split in two) of such a file as a surface, with
/// references as groups.
/// \param dropped receives the other contents; may be null
/// \throws InputError as read_medit(), and for a file with tets
TriangleMesh read_medit_surface(std::string_view bytes, const std::string& name,
                                std::vector<Dropped>* dropped = nullptr);

/// Content of a file; coordinates round-trip bit by bit. The format has no fields and no names of materials.
/// The interface triangles of the mesh, if any, are the section Triangles: their reference is the number of
/// their group (see BoundaryGroups), and a comment gives its name, or the tags of a pair of materials, or the
/// number of the region in the input.
std::string write_medit(const MeshToWrite& written);

/// Names of the regions in this format; materials have none.
MeshParts medit_parts(const TetMesh& mesh);

}  // namespace tetwright
