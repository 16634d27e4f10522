// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <map>

#include "common/tet_mesh.h"

namespace tetwright {

/// Numbers of tets by volume and smallest solid angle, as in Figure 2 of Cutler, Dorsey & McMillan 2004.
struct QualityHistogram {
  /// Linear, 0 to 0.55 steradians; the last bin includes larger angles (a regular tet has 0.5513).
  static constexpr std::size_t angle_bins = 22;
  static constexpr double angle_step = 0.025;
  /// Logarithmic: volume / mean volume from 2^-8 to 2^8, two bins for each doubling. The first and the last
  /// bin include values beyond; the first also volumes that are zero or negative.
  static constexpr std::size_t volume_bins = 32;
  static constexpr double min_relative_volume = 0x1p-8;

  /// counts[angle bin][volume bin]
  std::array<std::array<std::size_t, volume_bins>, angle_bins> counts{};
};

/// Numbers of dihedral angles by size, six of each tet: linear, 0 to 180 degrees. Degenerate faces, whose
/// angles are undefined, are left out.
struct DihedralHistogram {
  static constexpr std::size_t bins = 36;
  static constexpr double step = 5;  ///< degrees

  std::array<std::size_t, bins> counts{};
};

struct MaterialStatistics {
  std::size_t tets = 0;
  double volume = 0;  ///< input units cubed; the sum of signed volumes
};

/// Faces between two materials, or between one and outside.
struct InterfaceStatistics {
  std::size_t triangles = 0;
  double area = 0;  ///< input units squared
};

/// Statistics of a mesh for reports.
struct MeshStatistics {
  std::size_t tets = 0;
  std::size_t points = 0;
  std::map<MaterialTag, MaterialStatistics> materials;
  double volume = 0;  ///< of all materials
  // Smallest solid angle of each tet, steradians; 0 for a tet that is flat or negative by exact sign.
  double min_solid_angle = 0;
  double mean_solid_angle = 0;
  std::size_t below_count = 0;  ///< tets below the threshold
  double below_percent = 0;     ///< 0 to 100
  /// Dihedral angles in degrees, over all tets where they are defined (0 and 180 for flat ones).
  double min_dihedral = std::numeric_limits<double>::quiet_NaN();
  double max_dihedral = std::numeric_limits<double>::quiet_NaN();
  QualityHistogram histogram;
  DihedralHistogram dihedrals;
  // From TetMesh::interfaces; empty if those are.
  std::map<MaterialPair, InterfaceStatistics> interfaces;
  std::size_t junction_edges = 0;  ///< edges at which three or more interface triangles meet
};

/// Computes the statistics. Parallel; the result is the same for any number of threads and on every machine.
/// About 0.2 s for a million tets and as much for a million interface triangles. Takes 48 bytes for each
/// triangle, then one for each tet.
/// \param threshold solid angle for below_count, steradians
/// \pre ids in range
MeshStatistics mesh_statistics(const TetMesh& mesh, double threshold = 0.1);

}  // namespace tetwright
