// SPDX-License-Identifier: Apache-2.0
#include "tools/app/commands/command_run.h"

#include "tools/report/stats_json.h"

namespace tetwright {

CommandRun::CommandRun(const CommandLine& call, Progress& shown, NamedInputs* values)
    : line(call),
      memory_limit(call.options.limits.memory.value_or(0) * gigabyte),
      progress(shown),
      in_memory(values) {
  report.inputs = input_files(call);
}

void write_stats(const CommandRun& run, OutputFiles& files) {
  const std::string& file = run.line.outputs.stats;
  if (!file.empty() && file != "-") files.write(file, stats_json(run) + "\n");
}

std::vector<std::string> input_files(const CommandLine& line) {
  if (line.command == Command::sample) return {};
  std::vector<std::string> inputs = line.inputs;
  for (const std::vector<NamedValue>* named : {&line.materials, &line.sheets, &line.partitions})
    for (const NamedValue& m : *named) inputs.push_back(m.value);
  return inputs;
}

}  // namespace tetwright
