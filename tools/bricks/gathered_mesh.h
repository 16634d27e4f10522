// SPDX-License-Identifier: Apache-2.0
#pragma once

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
};

/// Joins the parts of all bricks of a volume, and frees them.
/// \param parts in the order of BrickMesher::bricks()
/// \param names of the materials
GatheredMesh gather(std::vector<BrickPart> parts, std::map<MaterialTag, std::string> names);

}  // namespace tetwright
