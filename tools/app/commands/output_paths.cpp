// SPDX-License-Identifier: Apache-2.0
#include "tools/app/commands/output_paths.h"

#include <sys/stat.h>

#include <cctype>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

#include "common/lower_case.h"
#include "tetwright/error.h"
#include "tetwright/files.h"
#include "tetwright/io.h"
#include "tools/app/commands/command_run.h"
#include "tools/app/log_file.h"

namespace tetwright {

namespace {

/// Names of files with the option of each. Finds a file by another name, too; it need not exist.
class KnownFiles {
 public:
  void add(const std::string& file, const std::string& option) {
    if (file.empty()) return;
    by_path_.emplace(real_path(file), option);
    if (const auto inode = inode_of(file)) by_inode_.emplace(*inode, option);
  }
  /// Option of the file that was added first; null: none.
  const std::string* option_of(const std::string& file) const {
    if (const auto known = by_path_.find(real_path(file)); known != by_path_.end()) return &known->second;
    if (const auto inode = inode_of(file))
      if (const auto known = by_inode_.find(*inode); known != by_inode_.end()) return &known->second;
    return nullptr;
  }

 private:
  using Inode = std::pair<dev_t, ino_t>;
  static std::optional<Inode> inode_of(const std::string& file) {
    struct stat status;
    if (stat(file.c_str(), &status) != 0) return {};
    return Inode{status.st_dev, status.st_ino};
  }
  std::map<std::string, std::string> by_path_;
  std::map<Inode, std::string> by_inode_;  ///< of existing files
};

/// All files that the call reads.
std::vector<std::string> files_read(const CommandLine& line) {
  std::vector<std::string> files = input_files(line);
  files.insert(files.end(),
               {line.options.labels.names_file, line.check.before, line.options.values.mask_file});
  for (const ValueImage& image : line.options.values.images) files.push_back(image.file);
  if (line.options.sizes.field) files.push_back(line.options.sizes.field->name);
  files.insert(files.end(), line.check.surfaces.begin(), line.check.surfaces.end());
  return files;
}

/// A file that the call writes, and the option that requests it.
struct Written {
  std::string option, file;
};

std::vector<Written> files_written(const CommandLine& line) {
  std::vector<Written> files;
  if (line.command == Command::sample || line.command == Command::embed)
    files.push_back({"-o", line.outputs.mesh});
  else if (line.command == Command::batch)
    files.push_back({"--results", results_file_of(line)});
  else if (line.command != Command::check)
    for (const std::string& file :
         files_of_tet_mesh(line.outputs.mesh, line.outputs.format, line.outputs.parts))
      files.push_back({"-o", file});
  for (const Written& more : {Written{"--boundary", line.outputs.boundary},
                              {"--write-sdf", line.outputs.distances},
                              {"--bins", bins_table_of(line)},
                              {"--split-interface", pairs_table_of(line, !line.options.parting.empty())},
                              {"--report", line.outputs.report},
                              {"--stats", line.outputs.stats},
                              {"--log-file", line.console.log_file}})
    if (!more.file.empty() && more.file != "-") files.push_back(more);
  return files;
}

/// Number of report files (--stats and --log-file) among the written files; they are last in the list.
std::size_t report_count(const CommandLine& line) {
  return static_cast<std::size_t>(!line.outputs.stats.empty() && line.outputs.stats != "-") +
         static_cast<std::size_t>(!line.console.log_file.empty());
}

/// Selects only the reports of the run, or all written files.
enum class Which { reports, all };

void check_files_are_different(const CommandLine& line, Which which) {
  // These commands may overwrite their input.
  const bool in_place = line.command == Command::simplify || line.command == Command::improve ||
                        line.command == Command::values;
  const std::vector<Written> written = files_written(line);
  // Reports of the run are last, so that each is compared with all other files.
  const std::size_t first =
      which == Which::all || line.command == Command::batch ? 0 : written.size() - report_count(line);
  KnownFiles inputs, earlier;
  for (const std::string& input : files_read(line)) inputs.add(input, "");
  for (std::size_t i = 0; i < written.size(); ++i) {
    const auto& [option, file] = written[i];
    if (i >= first) {
      std::string message = option;
      message.append(" ").append(file);
      if (inputs.option_of(file) && !(in_place && option == "-o"))
        throw UsageError(message + " is also an input; give it a name of its own");
      if (const std::string* other = earlier.option_of(file))
        throw UsageError(message + " is also the file of " + *other + "; give each its own");
    }
    earlier.add(file, option);
  }
}

void check_sdf_path(const CommandLine& line) {
  if (line.outputs.distances.empty()) return;
  if (!is_vdb(line.outputs.distances))
    throw UsageError("--write-sdf " + line.outputs.distances +
                     ": signed distances are written for OpenVDB; give a name that ends in .vdb");
  check_output_file(line.outputs.distances);
}

void check_report_path(const CommandLine& line) {
  if (line.outputs.report.empty()) return;
  const std::string extension = lower_case(std::filesystem::path(line.outputs.report).extension().string());
  if (extension != ".html" && extension != ".htm")
    throw UsageError("--report " + line.outputs.report +
                     ": the report is a page for browsers; give a name that ends in .html");
  check_output_file(line.outputs.report);
}

}  // namespace

std::vector<std::string> written_files(const CommandLine& line) {
  std::vector<std::string> names;
  for (const Written& written : files_written(line)) names.push_back(written.file);
  return names;
}

std::vector<std::string> read_files(const CommandLine& line) {
  std::vector<std::string> names;
  for (const std::string& file : files_read(line)) {
    if (file.empty()) continue;
    for (const std::string& part : files_of_input(file)) names.push_back(part);
  }
  return names;
}

std::string bins_table_of(const CommandLine& line) {
  const std::string& mesh = line.outputs.mesh;
  if (line.options.values.bins.empty() || mesh.empty() || mesh == "-") return {};
  return (std::filesystem::path(mesh).parent_path() / (file_stem(mesh) + "_bins.csv")).string();
}

std::string pairs_table_of(const CommandLine& line, bool parted) {
  const std::string& mesh = line.outputs.mesh;
  if (!parted || mesh.empty() || mesh == "-") return {};
  return (std::filesystem::path(mesh).parent_path() / (file_stem(mesh) + "_pairs.csv")).string();
}

std::string results_file_of(const CommandLine& line) {
  return line.batch.results.empty()
             ? std::filesystem::path(line.inputs.front()).replace_extension(".results.jsonl").string()
             : line.batch.results;
}

void check_stats_path(const CommandLine& line) {
  const bool to_file = !line.outputs.stats.empty() && line.outputs.stats != "-";
  if (to_file && std::filesystem::path(line.outputs.stats).extension() != ".json")
    throw UsageError("--stats " + line.outputs.stats +
                     ": the statistics are JSON; give a name that ends in .json");
  check_files_are_different(line, Which::reports);
  if (to_file) check_output_file(line.outputs.stats);
  if (line.console.log_file.empty()) return;
  check_output_file(line.console.log_file);
  open_log(line.console.log_file);
  log_line(line.call);
}

void check_tet_stream(const CommandLine& line) {
  if (line.outputs.mesh != "-") return;
  const std::vector<std::string> files =
      files_of_tet_mesh(line.outputs.mesh, line.outputs.format, line.outputs.parts);
  if (files != std::vector<std::string>{line.outputs.mesh})
    throw UsageError("--output-format " + line.outputs.format +
                     " is several files, which standard output is not; "
                     "give -o a name, or another format");
}

void check_output_paths(const CommandLine& line) {
  if (line.command == Command::embed)
    check_embedding_path(line.outputs.mesh, line.outputs.format);
  else if (line.command != Command::check)
    check_output_path(line.outputs.mesh, FileKind::tet_mesh, line.outputs.format, line.outputs.parts);
  if (!line.outputs.boundary.empty())
    check_output_path(line.outputs.boundary, FileKind::surface, line.outputs.boundary_format);
  check_sdf_path(line);
  if (const std::string table = bins_table_of(line); !table.empty()) check_output_file(table);
  if (const std::string table = pairs_table_of(line, !line.options.parting.empty()); !table.empty())
    check_output_file(table);
  check_report_path(line);
  check_files_are_different(line, Which::all);
}

}  // namespace tetwright
