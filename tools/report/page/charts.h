// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "tetwright/mesh_quality.h"
#include "tetwright/simplify.h"

namespace tetwright {

/// A mesh that a chart shows.
struct ChartMesh {
  std::string name;  ///< "before", "result"
  const MeshStatistics* statistics;
};

// The charts as HTML: figures with drawings (SVG) that need no script. At most two meshes, the result last.

/// Two-dimensional histograms of the tets' volume and min solid angle, one for each mesh: Figure 2 of Cutler,
/// Dorsey & McMillan 2004 seen from above.
std::string quality_charts(std::span<const ChartMesh> meshes);
/// Histogram of the tets' min solid angles, all meshes in one drawing.
std::string solid_angle_chart(std::span<const ChartMesh> meshes);
/// Histogram of the dihedral angles, all meshes in one drawing.
std::string dihedral_chart(std::span<const ChartMesh> meshes);

/// A bar for each iteration of simplification, as high as its tets before the iteration, the worst at the
/// top: Figure 4 of Cutler, Dorsey & McMillan 2004. Empty if there are no such iterations.
std::string iterations_chart(std::span<const IterationReport> iterations);

}  // namespace tetwright
