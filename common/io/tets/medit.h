// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/io/names/mesh_parts.h"
#include "tetwright/io.h"
#include "tetwright/surface_mesh.h"

namespace tetwright {

/// Reads the sections Vertices and Tetrahedra of a Medit ASCII mesh (.mesh). References of tets are materials
/// ("medit:ref"). References of triangles are groups of faces (see take_triangles()); comments of
/// write_medit() give a group's name or its pair of materials. The format has no fields. Sections of other
/// volume cells are rejected; contents of other sections are counted in ReadTetMesh::dropped.
///
/// No library is used: libMeshb reports that a file cannot be read, without saying where and why.
/// \param name file name for messages
/// \throws InputError with the line for malformed contents
ReadTetMesh read_medit(std::string_view bytes, const std::string& name,
                       const ReadTetMeshOptions& options = {});

/// Reads the sections Vertices, Triangles and Quadrilaterals (split in two) of such a file as a surface, with
/// references as groups.
/// \param dropped receives the other contents; may be null
/// \throws InputError in the cases of read_medit(), and for a file with tets
TriangleMesh read_medit_surface(std::string_view bytes, const std::string& name,
                                std::vector<Dropped>* dropped = nullptr);

/// Content of a file; coordinates round-trip bit by bit. The format has no fields and no names of materials.
/// The interface triangles of the mesh, if any, form the section Triangles. Their reference is the number of
/// their group (see BoundaryGroups); a comment gives the group's name, the tags of a pair of materials, or
/// the number of the region in the input.
std::string write_medit(const MeshToWrite& written);

/// Names of the regions in this format, which has no names of materials.
MeshParts medit_parts(const TetMesh& mesh);

}  // namespace tetwright
