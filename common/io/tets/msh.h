// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tetwright/io.h"

namespace tetwright {

/// Reads the tets (type 4, or type 11 with ten nodes, reduced to their corners) of a Gmsh MSH file of version
/// 2, 4.0 or 4.1, ASCII or binary. The material is the first physical group of a tet, with its name from
/// $PhysicalNames. In version 4.1, if no volume has a physical group, it is the number of the volume
/// ("gmsh:geometrical", which the options can also request). $NodeData and $ElementData become fields, with
/// NaN for items that a section does not list. Physical groups of triangles become groups of faces (see
/// take_triangles()); the sign of their number, which gives their orientation in Gmsh, is ignored. Volume
/// elements other than linear tets are rejected; points, lines, other faces, their groups and other sections
/// are counted in ReadTetMesh::dropped.
///
/// Gmsh's library is not used, since it is under the GPL.
/// \param name file name for messages
/// \throws InputError with the line for malformed contents, and with advice for other versions and
///   partitioned meshes
ReadTetMesh read_msh(std::string_view bytes, const std::string& name, const ReadTetMeshOptions& options = {});

/// Reads the triangles (type 2) and quads (type 3, split in two) of such a file as a surface, with the
/// physical groups of faces and their names as its groups.
/// \param dropped receives the other contents; may be null
/// \throws InputError in the cases of read_msh(), and for a file with tets
TriangleMesh read_msh_surface(std::string_view bytes, const std::string& name,
                              std::vector<Dropped>* dropped = nullptr);

/// Reads such a surface with $NodeData as fields; points that a section does not list get NaN.
/// \return std::nullopt for a file with tets
std::optional<SurfaceWithFields> read_msh_surface_with_fields(std::string_view bytes,
                                                              const std::string& name);

/// Content of a file of version 2.2, ASCII; coordinates round-trip bit by bit. The interface triangles of the
/// mesh, if any, follow the tets. Each of the BoundaryGroups is a physical group of dimension 2 with its
/// number and its name, or the pair_name() of its pair. A group without a name whose number cannot be kept
/// gets its original number as a name. Fields follow as $NodeData and $ElementData, see append_msh_data().
/// Names have the form of msh_name(), with a suffix if two would become equal: pairs of materials get the
/// suffix rather than the input's groups, and one larger than theirs.
std::string write_msh(const MeshToWrite& written);

/// Writes a file of version 4.1, ASCII or binary (little-endian, sizes of 8 bytes). Each group of interfaces
/// is a surface of Gmsh's model, and each material a volume bounded by its surfaces. Both have a physical
/// group with the same number, so that Gmsh keeps them when it saves the file again. A material whose tag is
/// not above 0, for which Gmsh has no group, gets the smallest free number, and a comment with its tag. Nodes
/// are listed by entity, nodes of surfaces first; nodes and tets are numbered in the order of the mesh.
void write_msh41(const MeshToWrite& written, const ByteSink& sink);
void write_msh41_binary(const MeshToWrite& written, const ByteSink& sink);

}  // namespace tetwright
