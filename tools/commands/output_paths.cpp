#include "tools/commands/output_paths.h"

#include <filesystem>

#include "common/error.h"
#include "common/formats/atomic_file.h"
#include "common/formats/formats.h"
#include "tools/commands/command_run.h"
#include "tools/commands/scan_input.h"

namespace tetwright {

namespace {

/// True if both names lead to the same file, which need not exist if they are spelt alike.
bool same_file(const std::string& a, const std::string& b) {
  if (a.empty() || b.empty()) return false;
  std::error_code not_there;
  return a == b || std::filesystem::equivalent(a, b, not_there);
}

/// All files that the call reads.
std::vector<std::string> files_read(const CommandLine& line) {
  std::vector<std::string> files = input_files(line);
  files.insert(files.end(), {line.label_names, line.before});
  return files;
}

void check_output_is_no_input(const CommandLine& line) {
  for (const std::string& input : files_read(line))
    if (same_file(input, line.output))
      throw UsageError("-o " + line.output + " is also an input; give the mesh a name of its own");
}

void check_sdf_path(const CommandLine& line) {
  if (line.write_sdf.empty()) return;
  if (!is_vdb(line.write_sdf))
    throw UsageError("--write-sdf " + line.write_sdf +
                     ": signed distances are written for OpenVDB; give a name that ends in .vdb");
  for (const std::string& input : files_read(line))
    if (same_file(input, line.write_sdf))
      throw UsageError("--write-sdf " + line.write_sdf + " is also an input; give it another name");
  check_output_file(line.write_sdf);
}

}  // namespace

void check_stats_path(const CommandLine& line) {
  if (line.stats.empty()) return;
  if (std::filesystem::path(line.stats).extension() != ".json")
    throw UsageError("--stats " + line.stats + ": the statistics are JSON; give a name that ends in .json");
  std::vector<std::string> others = files_read(line);
  others.insert(others.end(), {line.write_sdf, line.output});
  for (const std::string& other : others)
    if (same_file(other, line.stats))
      throw UsageError("--stats " + line.stats +
                       " is also the name of another file of this call; give it its own");
  check_output_file(line.stats);
}

void check_output_paths(const CommandLine& line) {
  check_output_path(line.output);
  check_stats_path(line);
  check_sdf_path(line);
  if (line.command != Command::simplify && line.command != Command::improve) check_output_is_no_input(line);
}

}  // namespace tetwright
