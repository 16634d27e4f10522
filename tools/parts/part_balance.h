// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "tetwright/partition.h"
#include "tools/parts/tet_graph.h"

namespace tetwright {

/// Moves tets between neighbouring parts until none has more than `most` and none is empty: from a part that
/// has too many along the shortest chain of neighbours to one that has room. Only if there is no such chain
/// do tets move elsewhere.
/// \pre parts * most is at least the number of tets, which is at least the number of parts
void balance_parts(const TetNeighbours& neighbours, std::size_t most, TetPartition& partition);

/// Gives tets to the neighbouring part with which they share more faces than with their own, if that then has
/// at most `most` tets: the ragged borders of clusters become smooth.
void smooth_parts(const TetNeighbours& neighbours, std::size_t most, TetPartition& partition);

/// Gives pieces of a part that are not connected by faces with its largest piece to the neighbouring part
/// with which they share most faces, if that then has at most `most` tets.
void connect_parts(const TetNeighbours& neighbours, std::size_t most, TetPartition& partition);

}  // namespace tetwright
