// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tetwright/partition.h"
#include "tools/parts/tet_graph.h"

namespace tetwright {

/// Part of each vertex of a graph, by Scotch with a fixed seed and on one thread. Parts may be empty, and
/// larger than asked for.
/// \param imbalance share by which a part may exceed the mean weight, as Scotch tries to keep it
/// \throws std::bad_alloc
std::vector<PartNumber> scotch_parts(const WeightedGraph& graph, PartNumber parts, double imbalance);

}  // namespace tetwright
