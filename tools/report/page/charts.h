// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "common/mesh/mesh_statistics.h"

namespace tetwright {

/// A mesh that a chart shows.
struct ChartMesh {
  std::string name;  ///< "before", "result"
  const MeshStatistics* statistics;
};

// The charts as HTML: figures with drawings (SVG) that need no script. At most two meshes, the result last.

/// How many tets there are of each volume and smallest solid angle, for each mesh: Figure 2 of Cutler, Dorsey
/// & McMillan 2004 seen from above.
std::string quality_charts(std::span<const ChartMesh> meshes);
/// Shares of the tets by their smallest solid angle, all meshes in one drawing.
std::string solid_angle_chart(std::span<const ChartMesh> meshes);
/// Shares of the dihedral angles.
std::string dihedral_chart(std::span<const ChartMesh> meshes);

}  // namespace tetwright
