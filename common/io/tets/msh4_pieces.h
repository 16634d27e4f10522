// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/mesh/mesh_pieces.h"
#include "tetwright/files.h"

namespace tetwright {

/// Writes a piece of a mesh as a file of version 4.1, as `gmsh -part_split -part_ghosts` does with
/// Mesh.PartitionCreateTopology 0: the whole mesh's surfaces and volumes with their physical groups; those of
/// the piece, each with the piece's number from 1 and its parent; the piece's own tets and the triangles at
/// them; and its ghosts, in a volume of their own, with the numbers of the pieces that own them. Nodes and
/// elements have the numbers that write_msh41() gives them in the whole mesh. A process needs only its own
/// piece.
void write_msh41_piece(const MeshPiece& piece, const DividedMesh& whole, bool binary, const ByteSink& sink);

/// The files NAME_1.msh, NAME_2.msh and so on.
std::vector<std::string> files_of_msh_pieces(const std::string& path, PartNumber parts);

}  // namespace tetwright
