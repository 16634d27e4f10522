// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "common/io/names/mesh_parts.h"
#include "tetwright/io.h"

namespace tetwright {

/// Start of a comment of write_abaqus() that gives the tag of a material; "TAG: NAME" follows.
inline constexpr const char* abaqus_material_comment = "** material ";
/// Starts of comments that give the name of a material or a surface in the mesh, if the format cannot hold
/// it; "NAME: NAME IN THE MESH" follows.
inline constexpr const char* abaqus_material_name_comment = "** name of material ";
inline constexpr const char* abaqus_surface_name_comment = "** name of surface ";

/// Constraints on names in write_abaqus().
NameRules abaqus_names();

/// Reads the mesh of an input file of Abaqus or CalculiX: *NODE, and *ELEMENT of tets with 4 or 10 nodes
/// (C3D4, C3D10 and their variants, also DC3D4 and similar); tets of 10 nodes are reduced to their corners.
/// Materials are the element sets of *SOLID SECTION, or those named by *ELEMENT lines if there is no section.
/// They are numbered from 1 in order of appearance, unless comments of write_abaqus() give their tags.
/// Surfaces of element faces become groups of faces, see take_triangles(). Cohesive elements (COH3D6) whose
/// nodes coincide in pairs become TetMesh::wedges. Other volume elements and *INCLUDE are rejected. Other
/// elements, sets and surfaces are counted in ReadTetMesh::dropped; keywords unrelated to the mesh are
/// skipped.
///
/// Instances of parts are translated and rotated as the file says, and keep their own nodes. If there are
/// several with tets, materials are called INSTANCE.ELSET, or INSTANCE where there is only one, and surfaces
/// of parts INSTANCE.SURFACE. Parts without an instance are named in ReadTetMesh::dropped.
///
/// No library is used: the only packaged reader, meshio's, is written in Python and reads no surfaces.
/// \param name file name for messages
/// \throws InputError with the line for malformed contents
ReadTetMesh read_abaqus(std::string_view bytes, const std::string& name,
                        const ReadTetMeshOptions& options = {});

/// Writes an input file of Abaqus or CalculiX for *INCLUDE, without steps and material properties. Nodes and
/// elements are numbered from 1 without gaps, in the order of the mesh. Each material is an element set of
/// C3D4 or C3D10 elements. Each surface of a mesh with interfaces is a *SURFACE of element faces (on the side
/// of the smaller tag) and a node set of the same name. Cohesive elements are an element set of COH3D6 for
/// each parted interface, numbered after the tets. Names are plain_name()s. The format has no fields.
///
/// Both programs read 20 characters of a number: a coordinate that needs more is rounded to what fits, 14
/// digits in the worst case.
/// \throws InputError if a coordinate is out of the range that can be written
void write_abaqus(const MeshToWrite& written, const ByteSink& sink);

}  // namespace tetwright
