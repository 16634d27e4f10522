// The tetwright program: one command, its result, one exit status. What each command does is in commands.cpp.
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>

#include "common/error.h"
#include "tools/command_line.h"
#include "tools/commands.h"

int main(int argc, char** argv) {
  using tetwright::ExitStatus;
  // A full disk must end in an error message, not in a signal.
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
  const auto fail = [](ExitStatus status, const char* message) {
    std::fprintf(stderr, "tetwright: %s\n", message);
    return static_cast<int>(status);
  };
  try {
    tetwright::CommandLine line;
    if (!tetwright::parse_command_line(argc, argv, line)) return 0;
    return static_cast<int>(tetwright::run_command(line));
  } catch (const tetwright::Error& e) {
    return fail(e.status(), e.what());
  } catch (const std::bad_alloc&) {
    return fail(ExitStatus::output_failed,
                "not enough memory; give a smaller --resolution or a larger --voxel-size, or free some");
  } catch (const std::exception& e) {
    return fail(ExitStatus::bad_input, e.what());
  }
}
