// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tetwright {

/// A call of the program, without the options that StageScaling adds.
struct ScaledCall {
  std::string name;
  std::vector<std::string> arguments;  ///< command first
};

/// Measures which part of each stage is serial, what speed-ups this implies, and which speed-ups the machine
/// reaches.
class StageScaling {
 public:
  /// \param program path of `tetwright`
  /// \param stats file that may be overwritten
  /// \param runs runs with each number of threads, of which the shortest counts
  StageScaling(std::string program, std::string stats, int runs)
      : program_(std::move(program)), stats_(std::move(stats)), runs_(runs) {}

  /// Prints a table of the stages, measured with one thread, and one of the times with each number of
  /// threads. \return all that was measured \throws InputError if the program fails
  nlohmann::json measure(const ScaledCall& call, const std::vector<unsigned>& threads) const;

 private:
  nlohmann::json best_run(const ScaledCall& call, unsigned threads) const;

  std::string program_, stats_;
  int runs_;
};

}  // namespace tetwright
