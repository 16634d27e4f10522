#include "tools/commands/command_run.h"

#include <unistd.h>

namespace tetwright {

CommandRun::CommandRun(const CommandLine& call)
    : line(call), threads(call.threads), progress(!call.quiet && !call.no_progress && isatty(STDERR_FILENO)) {
  report.inputs = input_files(call);
}

std::vector<std::string> input_files(const CommandLine& line) {
  if (line.command == Command::sample) return {};
  std::vector<std::string> inputs = line.inputs;
  for (const NamedValue& m : line.materials) inputs.push_back(m.value);
  return inputs;
}

void report_dropped(const std::vector<Dropped>& dropped, const std::string& file, RunReport& report,
                    bool with_restored) {
  for (const Dropped& d : dropped)
    if (with_restored || !d.restored)
      report.findings.push_back(
          {file, {d.what, d.count, {}, d.restored ? "found again from the materials" : "dropped"}});
}

}  // namespace tetwright
