// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace tetwright {

/// One line of a file of jobs: {"id": "case-7", "args": ["prepare", "case-7.nrrd", "-o", "case-7.vtu"]}.
struct Job {
  std::string id;  ///< of the line, or its number as text
  std::vector<std::string> arguments;
};

/// Reads a file of jobs; empty lines are skipped. Throws InputError, with the line, where one is no such
/// object or repeats an id.
std::vector<Job> read_jobs(const std::string& file);

}  // namespace tetwright
