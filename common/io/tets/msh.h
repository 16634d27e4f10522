// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/io/contents/mesh_to_write.h"
#include "common/io/contents/read_tet_mesh_result.h"
#include "common/io/contents/surface_with_fields.h"

namespace tetwright {

/// Reads the tets (type 4, or 11 of ten nodes, by their corners) of a Gmsh MSH file of version 2, 4.0 or 4.1,
/// ASCII or binary. The material is the first physical
/// group of a tet, with its name from $PhysicalNames. In version 4.1, if no volume has a physical group, it
/// is the number of the volume ("gmsh:geometrical", which the options can also ask for). $NodeData and
/// $ElementData become fields, with nan for items that a section does not list. Volume elements other than
/// linear tets are refused; physical groups of triangles become groups of faces (see take_triangles()),
/// whatever the sign of their number, which says how Gmsh turns them; points, lines, other faces, their
/// groups and other sections are counted in ReadTetMesh::dropped. `name` is used in messages. Throws
/// InputError with the line for anything that is malformed; other versions, binary files and partitioned
/// meshes are refused with advice.
///
/// Our own: the library of Gmsh is under the GPL.
ReadTetMesh read_msh(std::string_view bytes, const std::string& name, const ReadTetMeshOptions& options = {});

/// Reads the triangles (type 2) and quads (type 3), cut in two, of such a file as a surface: physical groups
/// of faces are its groups, with their names. What else it holds is appended to `dropped`, unless that is
/// null. Throws InputError as read_msh() does, and for a file with tets.
TriangleMesh read_msh_surface(std::string_view bytes, const std::string& name,
                              std::vector<Dropped>* dropped = nullptr);

/// The same with $NodeData as fields, with nan for points that a section does not list; nothing for a file
/// with tets.
std::optional<SurfaceWithFields> read_msh_surface_with_fields(std::string_view bytes,
                                                              const std::string& name);

/// The content of a file of version 2.2, ASCII; coordinates are read back bit by bit. The interface triangles
/// of the mesh, if it has any, follow the tets; each of the BoundaryGroups is a physical group of
/// dimension 2 with its number and its name, or pair_name()'s; one without a name whose number is not kept
/// has that for a name. Fields follow as $NodeData and $ElementData, see append_msh_data(). Names are written
/// as msh_name() gives them, and get a suffix where two of them would become equal: of pairs of
/// materials before the user's groups, and then one that is larger than theirs.
std::string write_msh(const MeshToWrite& written);

/// The same of version 4.1, ASCII or binary (little-endian, sizes of 8 bytes). Each group of interfaces is a
/// surface of Gmsh's model and each material a volume, bounded by its surfaces; both have a physical group of
/// the same number, so that Gmsh keeps them when it saves the file again. A material whose tag is not above
/// 0, for which Gmsh knows no group, has the smallest number that is left, and a comment with its tag. Nodes
/// are listed by entity, those of surfaces first, and numbered in the order of the mesh, as tets are.
void write_msh41(const MeshToWrite& written, const ByteSink& sink);
void write_msh41_binary(const MeshToWrite& written, const ByteSink& sink);

}  // namespace tetwright
