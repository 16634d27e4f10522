// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tetwright/prepare_steps.h"

namespace tetwright {

/// Reports labels of which the merging of islands changed more than 2 % of their voxels as read, and large
/// parts that it joined. Has no effect unless the input is a volume.
void find_changed_labels(PrepareRun& run);

/// Compares the labels that touch in the mesh with those whose voxels touch: reports pairs that no voxels
/// bring together as read, not even in a corner, and pairs that share more voxel faces than
/// LabelOptions::min_voxels, apart from those of small islands, and do not touch in the mesh. Has no effect
/// unless the input is a volume.
void find_changed_contacts(const TetMesh& mesh, PrepareRun& run);

}  // namespace tetwright
