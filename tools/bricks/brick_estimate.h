// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <utility>

#include "tetwright/mesher.h"
#include "tetwright/mesher_input.h"
#include "tools/bricks/brick_scratch.h"

namespace tetwright {

/// Tets of a mesh to simplify, 2^30, with a margin for estimates.
inline constexpr double max_tets_to_simplify = 0.8 * (1 << 30);

/// A job in bricks.
struct BrickPlan {
  int cells = 0;         ///< edge of a brick, finest cells before any are halved
  unsigned workers = 1;  ///< bricks made at the same time, each by one thread; 1: one by all threads
  /// How often a tet is coarsened before all bricks are joined, each time in other bricks; 1 to
  /// BrickRoundsTuning::max_rounds.
  int rounds = 1;
};

/// The memory and space that a job in bricks needs, bytes. Infinite if it has more tets in one mesh than can
/// be numbered.
struct BrickEstimate {
  double memory = 0;   ///< peak, including the program and its libraries
  double scratch = 0;  ///< for the files of all bricks
};

/// Estimates jobs in bricks of a volume. Not for concurrent use. Peaks on foams were between half of the
/// estimate and, where cuts dominate (64 bricks of 32 cells in a volume of 128^3), 1.9 times as much.
class BrickEstimator {
 public:
  /// \param dense tets of the dense mesh
  /// \param target final tets
  /// \param scratch whether finished bricks are in files
  /// \param team whether this process has other members of a team make bricks, too
  BrickEstimator(const LabelInput& labels, const MesherOptions& options, double dense, std::size_t target,
                 bool scratch, bool team);
  /// Passes over all voxels. Parallel.
  BrickEstimate operator()(const BrickPlan& plan) const;
  /// The largest bricks, and the most workers, for which the memory suffices with as few rounds as possible;
  /// if it never does, those that need the least.
  /// \param given what is not to be chosen
  /// \param available bytes
  BrickPlan choose(const BrickDivision& given, double available) const;

 private:
  struct Needs {
    double rest;                    ///< before and after the bricks are made
    double base;                    ///< beside the workers
    double each;                    ///< of a worker with one thread
    double alone;                   ///< of one worker with all threads
    double later_base, later_each;  ///< likewise, in the rounds after the first
    double scratch;
  };
  Needs needs(int cells, int rounds) const;
  /// Share of the dense mesh in the largest brick.
  /// \param offset of the grid of bricks, edges
  double largest_share(int cells, double offset) const;
  double memory(const BrickPlan& plan, const Needs& of) const;
  /// The plan with as many workers as memory and threads allow.
  BrickPlan with_workers(int cells, int rounds, double available) const;

  const LabelInput& labels_;
  double cell_, dense_, target_, field_, before_;
  bool scratch_, team_;
  mutable std::map<std::pair<int, double>, double> shares_;  ///< largest_share(), a pass over all voxels
};

/// Voxels along each axis of a brick.
std::array<double, 3> voxels_of_bricks(const LabelInput& labels, double cell, int cells);

}  // namespace tetwright
