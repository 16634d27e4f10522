// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <string>

#include "tools/bricks/process_team.h"

namespace tetwright {

/// The ranks of MPI_COMM_WORLD; rank 0 leads.
///
/// Helpers ask for a task, receive its number and the bytes of its order, and send those of the result before
/// they ask again. A thread of the leader answers them while the leader does tasks itself: until it has
/// ended, no other thread of the leader calls MPI (MPI_THREAD_SERIALIZED). Both sides sleep between looks at
/// what has arrived, since MPI's own waiting would occupy a core.
class MpiTeam final : public ProcessTeam {
 public:
  MpiTeam();

  bool is_leader() const override { return rank_ == 0; }
  void begin(const std::string& job, const Progress& progress) override;
  std::size_t lead(const Tasks& tasks) override;
  void end() override;
  void help(const Work& work) override;
  bool writes_hdf5() const override;
  std::size_t write_hdf5(const std::string& temporary, const std::string& path,
                         const std::function<void(Hdf5Writer&)>& content) override;
  void report(int status, const std::string& message) override;
  /// Waits in a helper, and tells the helpers in the leader, that the program ends.
  void part();

 private:
  class Service;
  /// Looks for a helper that asks for a task, and adds it to waiting_. Throws the error of one that failed.
  bool helper_asked();
  /// Waits until one has asked.
  void wait_for_helper();

  int rank_ = 0, size_ = 1;
  bool has_news_ = true;  ///< of a helper: it has neither helped nor reported, and the leader may wait for it
  std::uint64_t job_ = 0;               ///< hash
  const Progress* progress_ = nullptr;  ///< null before begin()
  std::deque<int> waiting_;             ///< helpers that have asked and were not answered yet
};

}  // namespace tetwright
