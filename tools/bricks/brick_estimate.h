// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "tetwright/mesher.h"
#include "tetwright/mesher_input.h"

namespace tetwright {

/// The memory and space that a job in bricks needs, bytes.
struct BrickEstimate {
  double memory = 0;   ///< peak, including the program and its libraries
  double scratch = 0;  ///< for the files of all bricks
};

/// Estimates a job in bricks: mostly within 25 %. Parallel.
/// \param dense tets of the dense mesh
/// \param side edge of a brick, finest cells before any are halved
/// \param target final tets
/// \param scratch whether finished bricks are in files
BrickEstimate estimate_bricks(const LabelInput& labels, const MesherOptions& options, double dense, int side,
                              std::size_t target, bool scratch);

/// The largest bricks for which the memory suffices, or the smallest ones.
/// \param available bytes
int largest_bricks(const LabelInput& labels, const MesherOptions& options, double dense, std::size_t target,
                   bool scratch, double available);

}  // namespace tetwright
