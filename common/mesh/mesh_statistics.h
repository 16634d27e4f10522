// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <map>

#include "common/tet_mesh.h"

namespace tetwright {

/// How many tets there are of each volume and smallest solid angle, as in Figure 2 of Cutler, Dorsey &
/// McMillan 2004.
struct QualityHistogram {
  /// Linear, 0 to 0.55 steradians; the last bin takes what is above (a regular tet has 0.5513).
  static constexpr std::size_t angle_bins = 22;
  static constexpr double angle_step = 0.025;
  /// Logarithmic: volume / mean volume from 2^-8 to 2^8, two bins for a doubling. The first and the last bin
  /// take what is beyond. Tets of no or negative volume are in the first.
  static constexpr std::size_t volume_bins = 32;
  static constexpr double min_relative_volume = 0x1p-8;

  /// counts[angle bin][volume bin]
  std::array<std::array<std::size_t, volume_bins>, angle_bins> counts{};
};

/// How many dihedral angles there are of each size, six of each tet: linear, 0 to 180 degrees. Those of
/// degenerate faces, which have none, are left out.
struct DihedralHistogram {
  static constexpr std::size_t bins = 36;
  static constexpr double step = 5;  ///< degrees

  std::array<std::size_t, bins> counts{};
};

struct MaterialStatistics {
  std::size_t tets = 0;
  double volume = 0;  ///< input units cubed; the sum of signed volumes
};

/// The faces where two materials meet, or one and outside.
struct InterfaceStatistics {
  std::size_t triangles = 0;
  double area = 0;  ///< input units squared
};

/// What a report says of a mesh.
struct MeshStatistics {
  std::size_t tets = 0;
  std::size_t points = 0;
  std::map<MaterialTag, MaterialStatistics> materials;
  double volume = 0;  ///< of all materials
  // Over the smallest solid angle of each tet, steradians; 0 where a tet is flat or negative by exact sign.
  double min_solid_angle = 0;
  double mean_solid_angle = 0;
  std::size_t below_count = 0;  ///< tets below the threshold
  double below_percent = 0;     ///< 0 to 100
  /// Dihedral angles in degrees, over all tets that have any (0 and 180 for flat ones).
  double min_dihedral = std::numeric_limits<double>::quiet_NaN();
  double max_dihedral = std::numeric_limits<double>::quiet_NaN();
  QualityHistogram histogram;
  DihedralHistogram dihedrals;
  // Of TetMesh::interfaces; none where those are empty.
  std::map<MaterialPair, InterfaceStatistics> interfaces;
  std::size_t junction_edges = 0;  ///< edges at which three or more interface triangles meet
};

/// `threshold`: steradians; ids must be in range. Parallel; the result does not depend on the threads and is
/// the same on every machine. About 0.2 s for a million tets and as much for a million interface triangles.
/// Takes 48 bytes for each triangle, then one for each tet.
MeshStatistics mesh_statistics(const TetMesh& mesh, double threshold = 0.1);

}  // namespace tetwright
