// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <exception>
#include <functional>
#include <string>

#include "tetwright/progress.h"

namespace tetwright {

class Hdf5Writer;

/// Processes that work on one job together. All of them read the same input with the same options; one, the
/// leader, has the others do tasks and does everything else. They share neither memory nor, unless a task
/// says so, folders.
class ProcessTeam {
 public:
  /// Tasks, any of which any member can do.
  struct Tasks {
    std::size_t count = 0;
    /// Does a task in the leader.
    std::function<void(std::size_t task)> here;
    // Both are called for one task at a time, in another thread of the leader while that may do a task here.
    /// The bytes from which another member does a task.
    std::function<std::string(std::size_t task)> order;
    /// Receives the bytes that another member has made of them.
    std::function<void(std::size_t task, const std::string& result)> receive;
  };
  /// Does a task in another member: bytes of Tasks::order to those for Tasks::receive.
  using Work = std::function<std::string(const std::string& order)>;

  virtual ~ProcessTeam() = default;
  virtual bool is_leader() const = 0;
  /// Comes before all that follows. Members whose job is not the leader's are told apart by it.
  /// \param job text that determines the results
  /// \param progress looked at while others are waited for
  virtual void begin(const std::string& job, const Progress& progress) = 0;
  /// The leader's part: has all tasks done, in their order as far as possible. It holds the bytes of one at a
  /// time. May be called again, until end().
  /// \return number of tasks that other members did
  /// \throws what the functions of `tasks` throw, OutputError for errors of other members
  virtual std::size_t lead(const Tasks& tasks) = 0;
  /// The leader has no more tasks of this kind: help() returns in the others.
  virtual void end() = 0;
  /// The other members' part: does tasks until the leader calls end().
  virtual void help(const Work& work) = 0;
  /// Whether members write HDF5 files together.
  virtual bool writes_hdf5() const = 0;
  /// The leader's part: has all members write an HDF5 file, whose folder they see. The others are in help().
  /// \param temporary an existing file, which is overwritten
  /// \param path for messages
  /// \param content adds the contents; called in the leader
  /// \return number of members
  /// \pre writes_hdf5()
  /// \throws OutputError if any of them does not see it, or cannot sync it to the disk. If one fails
  ///   while others may wait for it, all processes end with the status of that error, the file is removed,
  ///   and that one prints why
  virtual std::size_t write_hdf5(const std::string& temporary, const std::string& path,
                                 const std::function<void(Hdf5Writer&)>& content) = 0;
  /// Tells the leader that this member, another one, has failed. May return before the leader knows.
  /// \param status exit status of the program
  virtual void report(int status, const std::string& message) = 0;
};

/// Thrown in a member other than the leader when the leader has all bricks: the mesh is the leader's, and at
/// most its files are left to write.
class HelperFinished : public std::exception {
 public:
  const char* what() const noexcept override { return "the bricks are finished"; }
};

}  // namespace tetwright
