// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Number of a part of a mesh: the rank of the process that works on it in a parallel program.
using PartNumber = std::uint32_t;

/// Division of the tets of a mesh into parts.
struct TetPartition {
  PartNumber parts = 1;
  /// Part of each tet, below `parts`; every part has at least one tet. Empty: one part has all tets.
  std::vector<PartNumber> part_of = {};

  PartNumber of(std::size_t tet) const { return part_of.empty() ? 0 : part_of[tet]; }
};

/// Sizes of a part. Its ghosts are the tets of other parts that share a point with one of its own tets.
struct PartSize {
  std::size_t tets = 0;
  std::size_t points = 0;  ///< of its own tets
  std::size_t ghosts = 0;
  std::size_t neighbours = 0;  ///< parts that own its ghosts
  std::size_t pieces = 0;      ///< sets of its own tets that are connected by faces
};

struct PartitionStatistics {
  std::vector<PartSize> parts;
  std::size_t cut_faces = 0;  ///< faces between tets of two parts
  /// By how much the largest part exceeds the mean: 0.05 is 5 %.
  double imbalance = 0;
};

/// Measures a partition of the mesh. Takes the time and memory of mesh_faces().
/// \pre indices in range
PartitionStatistics partition_statistics(const TetMesh& mesh, const TetPartition& partition);

}  // namespace tetwright
