// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tetwright/io.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// A piece of a mesh as a file gives it, with ghosts.
struct ReadPiece {
  std::string file;
  std::vector<Vec3> points;
  std::vector<Tet> tets;
  std::vector<std::array<Index, 6>> midside;  ///< indices of points, for each tet; empty: linear tets
  // Numbers in the whole mesh, and whether another piece owns the item.
  std::vector<std::int64_t> node_numbers, tet_numbers;
  std::vector<std::uint8_t> node_ghosts, tet_ghosts;  ///< node_ghosts may be empty
  /// Groups of the faces of each tet, four numbers for each, or empty; 0: none.
  std::vector<std::int64_t> face_groups;
  std::vector<MeshField> point_fields, cell_fields;
};

/// Numbers of nodes and tets of the whole mesh, if a file gives them.
struct WholeCounts {
  std::int64_t parts = 0, tets = 0, nodes = 0;
  bool operator==(const WholeCounts&) const = default;
};

/// A mesh joined from pieces.
struct JoinedPieces {
  /// Tets and points in the order of their numbers; materials are still cell fields.
  TetMesh mesh;
  std::vector<Index> midside;            ///< points of each tet of ten nodes, six for each
  FileTriangles faces;                   ///< faces in groups, each once
  std::vector<std::string> some_pieces;  ///< names of fields that some pieces lack, which are left out
};

/// Joins pieces by the numbers of their tets and nodes.
/// \param name file name for messages that concern no piece
/// \throws InputError as read_pvtu() describes
JoinedPieces join_pieces(std::vector<ReadPiece> pieces, const std::optional<WholeCounts>& whole,
                         const std::string& name);

}  // namespace tetwright
