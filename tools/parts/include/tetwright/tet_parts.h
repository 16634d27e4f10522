// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tetwright/partition.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Max share by which a part may exceed the mean number of tets, unless the next whole number does.
inline constexpr double max_part_imbalance = 0.05;

/// Divides the tets of a mesh into parts of about equal size with few faces between them, by Scotch's graph
/// partitioning (Pellegrini & Roman 1996); large meshes by clusters of tets. The result does not depend on
/// the number of threads, nor on the user's seed. Pieces of a part that Scotch leaves unconnected
/// go to neighbouring parts where these stay small enough. Takes
/// 1 to 2 microseconds for each tet with 8 to 64 parts, and the memory of mesh_faces(). May be called
/// concurrently. \throws UsageError if there are fewer tets than parts, or no parts
TetPartition partition_tets(const TetMesh& mesh, PartNumber parts);

}  // namespace tetwright
