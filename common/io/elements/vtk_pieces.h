// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tetwright {

// Arrays of the pieces of a mesh in VTK's formats. VTK knows the first three by these names.
inline constexpr const char* vtk_ghosts = "vtkGhostType";
inline constexpr const char* vtk_node_numbers = "GlobalNodeId";
inline constexpr const char* vtk_cell_numbers = "GlobalCellId";
/// Number of the group of each face of a tet, opposite its vertices 0 to 3; 0: none.
inline constexpr const char* vtk_face_groups = "face_groups";
/// Field data: names of these groups, as the bytes of lines "NUMBER<tab>NAME".
inline constexpr const char* vtk_face_group_names = "face_group_names";
/// Field data: numbers of parts, tets and nodes of the whole mesh.
inline constexpr const char* vtk_whole_mesh = "whole_mesh";

/// Value of vtkGhostType for points and cells that another piece owns (vtkDataSetAttributes).
inline constexpr unsigned char vtk_duplicate = 1;

}  // namespace tetwright
