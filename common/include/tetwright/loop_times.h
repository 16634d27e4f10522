// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace tetwright {

/// Processor time of a thread, and the part of it in the parallel loops that the thread starts. Counted with
/// a ThreadLimit of 1, they predict the time on several cores: all time outside of loops is serial (Amdahl
/// 1967). With more threads, those that help in loops are not counted. Processor time does not depend on how
/// busy the machine is, as wall time does.
struct LoopTimes {
  /// Numbers of cores of the predictions.
  static constexpr std::array<unsigned, 4> cores{2, 4, 16, 64};

  double thread_seconds = 0;  ///< in loops and outside
  double seconds = 0;         ///< in loops; loops within loops count once
  std::uint64_t loops = 0;    ///< number of loops
  /// Seconds that the loops would take on `cores` if the parts of a loop take equally long and cores do not
  /// slow each other down.
  std::array<double, cores.size()> on_cores{};

  /// Seconds of the work on cores[i] cores: the serial time and that of the loops.
  double predicted(std::size_t i) const { return thread_seconds - seconds + on_cores[i]; }

  /// Adds a loop of `parts` parts, at least 1: n cores need as long as for the ceil(parts / n) parts of the
  /// busiest of them.
  void add(double loop_seconds, std::size_t parts);
  LoopTimes& operator+=(const LoopTimes& other);
  friend LoopTimes operator-(LoopTimes later, const LoopTimes& earlier);
};

/// Counts the loops that the constructing thread starts during the object's lifetime. Destroy objects on the
/// constructing thread, in reverse order of construction; what an inner one counts, outer ones count as well.
class CountLoops {
 public:
  CountLoops();
  ~CountLoops();
  CountLoops(const CountLoops&) = delete;
  CountLoops& operator=(const CountLoops&) = delete;

 private:
  friend LoopTimes loop_times();
  friend class CountedLoop;
  LoopTimes times_;
  double thread_start_;  ///< processor time of the thread at construction, seconds
  CountLoops* before_;
};

/// Times that the calling thread has counted in its innermost CountLoops; zero without one, and within loops.
/// The difference of two values is that of the work between them.
LoopTimes loop_times();

}  // namespace tetwright
