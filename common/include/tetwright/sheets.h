// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Sheets are inner faces of a mesh with the same material on both sides: see InterfaceTriangle. The tets do
/// not contain them, so find_interfaces() does not find them.

/// The faces of the sheets among the interfaces of a mesh, in their order.
std::vector<InterfaceTriangle> sheets_of(const TetMesh& mesh);

/// Appends the faces of sheets to the other interfaces: in ascending order of their sorted ids, each starting
/// at its smallest id, oriented consistently across edges that two faces of a patch share. The first face of
/// each piece is oriented by ascending ids. A piece with one side only, such as a Moebius strip, is oriented
/// as far as possible. O(n log n).
void append_sheets(std::vector<InterfaceTriangle>& interfaces, std::vector<InterfaceTriangle> sheets);

/// The result of find_interfaces() for the mesh, followed by its sheets as they are.
std::vector<InterfaceTriangle> interfaces_with_sheets(const TetMesh& mesh);

/// Indices in TetMesh::interfaces of the faces of sheets that are no face of two tets of their material,
/// ascending. O(n log n).
/// \pre ids of the tets in range, one material for each tet
std::vector<std::size_t> misplaced_sheet_faces(const TetMesh& mesh);

/// A sheet: all its faces that belong to one group of the mesh (TetMesh::patch_groups), in whatever material.
/// The faces without a group form a sheet for each material.
struct SheetStatistics {
  std::string name;  ///< of the group, or its number, or "bone|bone" without a group
  std::size_t triangles = 0;
  double area = 0;                ///< input units squared
  std::size_t pieces = 0;         ///< parts connected by edges
  std::ptrdiff_t euler = 0;       ///< Euler characteristic
  double border_length = 0;       ///< of the edges with one of its triangles, input units
  std::size_t border_pieces = 0;  ///< connected parts of the border
};

/// Statistics of the mesh's sheets, in ascending order of their numbers and names, those without a group
/// first. O(n log n).
/// \pre ids in range
std::vector<SheetStatistics> sheet_statistics(const TetMesh& mesh);

}  // namespace tetwright
