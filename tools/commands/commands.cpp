#include "tools/commands/commands.h"

namespace tetwright {

ExitStatus run_command(const CommandLine& line) {
  switch (line.command) {
    case Command::prepare:
      return run_prepare(line);
    case Command::mesh:
      return run_mesh(line);
    case Command::simplify:
      return run_simplify(line);
    case Command::improve:
      return run_improve(line);
    case Command::check:
      return run_check(line);
    case Command::sample:
      return run_sample(line);
  }
  return ExitStatus::usage;
}

}  // namespace tetwright
