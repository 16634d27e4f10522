// The tetwright program: one command, its result, one exit status. What each command does is in commands.cpp.
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "common/error.h"
#include "tools/command_line.h"
#include "tools/commands.h"

int main(int argc, char** argv) {
  using tetwright::ExitStatus;
#ifdef __GLIBC__
  // Large blocks go back to the system when they are freed. By itself glibc puts what is as large as blocks
  // that were freed before into its heaps, where it stays: gigabytes between the stages. This is the
  // threshold that glibc begins with; setting it keeps it there. Beyond 65,536 blocks at a time glibc takes
  // its heaps.
  mallopt(M_MMAP_THRESHOLD, 128 << 10);
#endif
  // A full disk must end in an error message, not in a signal.
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
  // Threads that cannot be started end in std::terminate, below every handler of ours.
  std::set_terminate([] {
    constexpr char message[] = "tetwright: out of memory or threads; give fewer --threads\n";
    [[maybe_unused]] const auto written = write(STDERR_FILENO, message, sizeof message - 1);
    _exit(static_cast<int>(ExitStatus::output_failed));
  });
  const auto fail = [](ExitStatus status, std::string message) {
    // One line, whatever a file name holds.
    for (char& c : message)
      if (static_cast<unsigned char>(c) < ' ' || c == 127) c = '?';
    std::fprintf(stderr, "tetwright: %s\n", message.c_str());
    return static_cast<int>(status);
  };
  try {
    tetwright::CommandLine line;
    if (!tetwright::parse_command_line(argc, argv, line)) return 0;
    const ExitStatus status = tetwright::run_command(line);
    if (std::fflush(stdout) != 0 || std::ferror(stdout))
      return fail(ExitStatus::output_failed, "cannot write to standard output");
    return static_cast<int>(status);
  } catch (const tetwright::Error& e) {
    return fail(e.status(), e.what());
  } catch (const std::bad_alloc&) {
    return fail(ExitStatus::output_failed,
                "not enough memory; free some, or ask for less (of surfaces: a smaller --resolution)");
  } catch (const std::exception& e) {
    return fail(ExitStatus::bad_input, e.what());
  }
}
