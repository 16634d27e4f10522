// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace tetwright {

/// A line of a file of jobs: {"id": "case-7", "args": ["prepare", "case-7.nrrd", "-o", "case-7.vtu"]}.
struct Job {
  std::string id;  ///< from the line, or its line number
  std::vector<std::string> arguments;
};

/// Reads a file of jobs; skips empty lines.
///
/// \throws InputError with the line if it is not such an object or repeats an id
std::vector<Job> read_jobs(const std::string& file);

}  // namespace tetwright
