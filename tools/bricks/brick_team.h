// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <exception>
#include <functional>
#include <string>
#include <vector>

#include "tetwright/progress.h"
#include "tools/bricks/brick_part.h"

namespace tetwright {

/// Processes that make the bricks of one volume together. All of them read the same input with the same
/// options; one, the leader, gathers the bricks and does everything else.
class BrickTeam {
 public:
  using Make = std::function<BrickPart(const BrickTask&)>;
  /// Receives a brick's to_bytes(), possibly in another thread of the leader.
  using Receive = std::function<void(std::size_t brick, const std::string& bytes)>;

  virtual ~BrickTeam() = default;
  virtual bool is_leader() const = 0;
  /// Comes before all that follows. Members whose job is not the leader's are told apart by it.
  /// \param job text that determines the bricks
  /// \param progress looked at while others are waited for
  virtual void begin(const std::string& job, const Progress& progress) = 0;
  /// The leader's part: has the bricks made by all members, in this order as far as possible.
  /// \param make makes a brick in this process
  /// \param receive is called for one brick at a time
  /// \throws what `make` and `receive` throw, OutputError for errors of other members
  virtual void lead(const std::vector<BrickTask>& tasks, const Make& make, const Receive& receive) = 0;
  /// The leader has all bricks: helpers may leave.
  virtual void end() = 0;
  /// The other members' part: makes bricks until the leader has all.
  virtual void help(const Make& make) = 0;
  /// Tells the leader that this member, another one, has failed. May return before the leader knows.
  /// \param status exit status of the program
  virtual void report(int status, const std::string& message) = 0;
};

/// Thrown in a member other than the leader when the leader has all bricks: nothing is left to do.
class HelperFinished : public std::exception {
 public:
  const char* what() const noexcept override { return "the bricks are finished"; }
};

}  // namespace tetwright
