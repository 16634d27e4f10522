// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tetwright/mesh_quality.h"
#include "tetwright/simplify.h"
#include "tools/bricks/brick_part.h"

namespace tetwright {

/// The coarsened mesh of a volume, from all its bricks.
struct GatheredMesh {
  TetMesh mesh;  ///< input units, with its interfaces
  OriginalMesh original;
  MeshStatistics dense;  ///< of the original mesh; see BrickPart::dense for the histogram
  std::size_t leaves = 0, lattice_tets = 0, isolated_vertices = 0;
  /// Bricks, ascending, whose boundary meets that of another one, since both were moved: nothing else can
  /// intersect across a cut, where no face is moved. They must be made again with BrickTask::keep_surface.
  std::vector<std::size_t> meeting;
};

/// Joins the parts of all bricks of a volume.
/// \param parts in the order of BrickMesher::bricks(). Meshes and surfaces are moved out of them, since both
///   together would take much memory, unless bricks meet: then the result lacks the original
/// \param names of the materials
GatheredMesh gather(std::vector<BrickPart>& parts, std::map<MaterialTag, std::string> names);

/// Likewise, if the bricks were regrouped and coarsened again.
/// \param parts of the last round
/// \param bricks of the first round, which have the surface and the statistics of the dense mesh; their
///   coarsened meshes are not used
/// \param shared_points the points that several bricks of the first round have
GatheredMesh gather(std::vector<BrickPart>& parts, std::vector<BrickPart>& bricks, std::size_t shared_points,
                    std::map<MaterialTag, std::string> names);

}  // namespace tetwright
