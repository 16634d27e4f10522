// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/files/byte_archive.h"
#include "common/mesh/mesh_pieces.h"

namespace tetwright {

// For ByteWriter and ByteReader: everything that a process needs to write its piece of a mesh.

template <class Archive, IsType<DividedMesh> T>
void archive(Archive& members, T& whole) {
  members(whole.parts, whole.tets, whole.points, whole.faces, whole.nodes, whole.second_order);
  members(whole.low, whole.high, whole.names, whole.point_types, whole.cell_types);
}

template <class Archive, IsType<InterfaceSide> T>
void archive(Archive& members, T& side) {
  members(side.tet, side.face, side.interface);
}

template <class Archive, IsType<MeshPiece> T>
void archive(Archive& members, T& piece) {
  members(piece.part, piece.mesh, piece.midside, piece.own_tets);
  members(piece.tet_numbers, piece.node_numbers, piece.face_numbers);
  members(piece.tet_owners, piece.node_owners, piece.face_owners, piece.sides);
}

}  // namespace tetwright
