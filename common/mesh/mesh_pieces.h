// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "common/mesh/part_points.h"
#include "tetwright/partition.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Type in which files store a field: the same in all pieces of a mesh.
enum class FieldType : std::uint8_t { real, int32, int64 };

/// Type that holds all values of a field: integers only if all values are whole and exact.
FieldType field_type(const MeshField& field);

/// Properties of a mesh that every process knows which writes a piece of it.
struct DividedMesh {
  PartNumber parts = 1;
  std::size_t tets = 0, points = 0, faces = 0;
  std::size_t nodes = 0;  ///< points and midside nodes
  bool second_order = false;
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();  ///< box of the nodes
  /// Materials, each once, one face for each patch, the names of both, and the fields without values; no
  /// points and tets.
  TetMesh names;
  std::vector<FieldType> point_types, cell_types;  ///< of the fields
};

/// A face of a tet that is one of the mesh's interfaces.
struct InterfaceSide {
  Index tet;
  std::uint8_t face;      ///< opposite this vertex of the tet
  std::size_t interface;  ///< index in TetMesh::interfaces
};

/// A part of a mesh with its ghosts, as a process of a parallel program holds it.
struct MeshPiece {
  PartNumber part = 0;
  /// Tets of the part, then its ghosts, both in the order of the whole mesh; their points in that order; the
  /// interfaces at these tets. Names and groups are those of the whole mesh.
  TetMesh mesh;
  std::optional<MidsideNodes> midside;
  std::size_t own_tets = 0;  ///< the first tets; the others are ghosts
  // Indices in the whole mesh, from 0.
  std::vector<std::uint64_t> tet_numbers;
  std::vector<std::uint64_t> node_numbers;  ///< of points, then of midside nodes
  std::vector<std::uint64_t> face_numbers;  ///< of the interfaces
  // Parts that own the items. A node belongs to the smallest part that has a tet at it, an interface to the
  // part of the tet on the side of its `material`.
  std::vector<PartNumber> tet_owners, node_owners, face_owners;
  std::vector<InterfaceSide>
      sides;  ///< ascending by tet; a face between two tets of the piece is there twice
};

/// Divides a mesh into pieces. The arguments must outlive this object.
class MeshPieces {
 public:
  /// \param midside null: linear tets
  MeshPieces(const TetMesh& mesh, const MidsideNodes* midside, const TetPartition& partition);

  const DividedMesh& whole() const { return whole_; }
  /// The piece of a part. May be called concurrently. Takes O(n log n) for the n tets of the piece.
  MeshPiece piece(PartNumber part) const;

  const TetMesh& mesh() const { return mesh_; }
  const MidsideNodes* midside() const { return midside_; }
  const TetPartition& partition() const { return partition_; }
  const PartPoints& points() const { return points_; }

 private:
  void find_sides();
  void describe_whole();
  void copy_points(const std::vector<Index>& points, MeshPiece& piece) const;
  void copy_midside_nodes(const std::vector<Index>& tets, const std::vector<Index>& points,
                          MeshPiece& piece) const;
  void copy_interfaces(const std::vector<Index>& tets, const std::vector<Index>& points,
                       MeshPiece& piece) const;

  const TetMesh& mesh_;
  const MidsideNodes* midside_;
  const TetPartition& partition_;
  DividedMesh whole_;
  PartPoints points_;
  std::optional<PartPoints> midside_points_;
  // Tets and ghosts of part k are at starts[k] to starts[k + 1].
  std::vector<std::size_t> tet_starts_, ghost_starts_;
  std::vector<Index> tets_, ghosts_;
  std::vector<InterfaceSide> sides_;       ///< ascending by tet
  std::vector<PartNumber> face_owners_;    ///< of the interfaces
  std::vector<Index> points_without_tet_;  ///< they are in the first piece
};

/// A mesh whose tets are ordered by part, and its points and midside nodes by owner.
struct OrderedMesh {
  TetMesh mesh;  ///< its first cell field is the part of each tet, with the name "partition"
  std::optional<MidsideNodes> midside;
};
inline constexpr const char* partition_field = "partition";

OrderedMesh ordered_by_part(const MeshPieces& pieces);

}  // namespace tetwright
