// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "tetwright/progress.h"
#include "tools/bricks/brick_store.h"
#include "tools/bricks/process_team.h"
#include "tools/bricks/regrouped_bricks.h"

namespace tetwright {

/// How the bricks of a round are made.
struct BrickMaking {
  unsigned workers;   ///< bricks made at the same time, each by one thread; 1: one by all threads
  ProcessTeam* team;  ///< null: this process alone
  std::function<BrickPart(const BrickTask&)> make;
  /// Pieces of a brick for another member of the team, as BrickRequest::pieces.
  std::function<BrickPieces(const BrickTask&)> pieces;
};

/// Has the bricks of a round made, and keeps them.
class BrickRound {
 public:
  /// \param store all arguments must outlive this object
  /// \param work of each brick, in any unit: those with most of it are made first
  /// \param report counts the bricks of other members
  BrickRound(BrickStore& store, std::vector<std::size_t> work, BrickMaking making, BrickReport& report,
             Progress& progress);
  /// Has all bricks made with BrickTask::thin.
  void thin_surfaces() { thin_ = true; }

  /// Makes the bricks that no file has.
  void make(const std::vector<BrickTask>& tasks);
  /// Makes all bricks once, without a halo.
  void make_all();
  /// Makes bricks again without coarsening their boundary, since it meets that of others, until none do.
  /// \param meeting finds them, see meeting_parts()
  /// \return how many bricks were made again
  std::size_t separate(const std::function<std::vector<std::size_t>()>& meeting);

  std::vector<BrickBorder>& borders() { return borders_; }

 private:
  BrickStore& store_;
  std::vector<std::size_t> work_;
  BrickMaking making_;
  BrickReport& report_;
  Progress& progress_;
  std::vector<BrickBorder> borders_;
  bool thin_ = false;
  std::vector<std::uint8_t> kept_;  ///< by brick: made again by separate()
};

}  // namespace tetwright
