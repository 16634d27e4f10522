#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <string>

#include "tests/common/temporary_folder.h"

namespace tetwright {

/// What a run of the program answered.
struct Answer {
  int status;
  std::string out, err;
};

/// Runs `tetwright ARGUMENTS` in a shell, after `before` (for example a limit), by way of `with` (for example
/// timeout).
inline Answer run(const std::string& arguments, const std::string& before = "",
                  const std::string& with = "") {
  const TemporaryFolder folder;
  const std::string command = before + " exec " + with + " " TETWRIGHT_PROGRAM " " + arguments + " >" +
                              (folder / "out") + " 2>" + (folder / "err") + " </dev/null";
  const int code = std::system(command.c_str());
  return {WIFEXITED(code) ? WEXITSTATUS(code) : 1000 + WTERMSIG(code), contents(folder / "out"),
          contents(folder / "err")};
}

}  // namespace tetwright
