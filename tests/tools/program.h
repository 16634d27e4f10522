// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "tests/common/temporary_folder.h"

namespace tetwright {

/// Result of a run of the program.
struct Answer {
  int status;
  std::string out, err;
};

/// Path of the program to test: TETWRIGHT_PROGRAM in the environment, for one with sanitizers, or otherwise
/// the build's.
inline std::string program() {
  const char* other = std::getenv("TETWRIGHT_PROGRAM");
  return other ? other : TETWRIGHT_PROGRAM;
}

/// Runs `tetwright ARGUMENTS` in a shell, after the command `before` (for example a limit) and by means of
/// the command `with` (for example timeout).
inline Answer run(const std::string& arguments, const std::string& before = "",
                  const std::string& with = "") {
  const TemporaryFolder folder;
  const std::string command = before + " exec " + with + " " + program() + " " + arguments + " >" +
                              (folder / "out") + " 2>" + (folder / "err") + " </dev/null";
  const int code = std::system(command.c_str());
  return {WIFEXITED(code) ? WEXITSTATUS(code) : 1000 + WTERMSIG(code), contents(folder / "out"),
          contents(folder / "err")};
}

/// Expects the status, and one line on stderr that begins like all errors and contains each of `said`.
inline void expect_refused(const std::string& arguments, int status, const std::vector<std::string>& said,
                           const std::string& before = "") {
  const Answer a = run(arguments, before);
  EXPECT_EQ(a.status, status) << arguments << "\n" << a.err;
  EXPECT_EQ(a.err.rfind("tetwright: ", 0), 0u) << a.err;
  EXPECT_EQ(std::count(a.err.begin(), a.err.end(), '\n'), 1) << a.err;
  for (const std::string& s : said) EXPECT_NE(a.err.find(s), std::string::npos) << a.err << "lacks: " << s;
}

inline const std::string tetrahedron_off =
    "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";

}  // namespace tetwright
