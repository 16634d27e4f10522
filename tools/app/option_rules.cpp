// SPDX-License-Identifier: Apache-2.0
#include "tools/app/option_rules.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "common/error.h"
#include "common/io/formats.h"
#include "common/lower_case.h"
#include "tools/app/commands/output_paths.h"

namespace tetwright {

namespace {

/// Refuses "-" where only files will do.
void check_no_stream(const CommandLine& out) {
  const auto check = [](const char* option, const std::string& file) {
    if (file == "-")
      throw UsageError(std::string(option) +
                       " is no stream; give it a file (- is for the input, -o, --boundary and --stats)");
  };
  check("--write-sdf", out.write_sdf);
  check("--report", out.report);
  check("--log-file", out.log_file);
  check("--results", out.results);
  check("--label-names", out.label_names);
  check("--size-field", out.size_field);
  check("--before", out.before);
  for (const std::string& file : out.surfaces) check("--surface", file);
  for (const NamedValue& m : out.materials) check("--material", m.value);
  if (out.command == Command::batch) check("the file of jobs", out.inputs.front());
}

void complete_input_stream(CommandLine& out) {
  out.input_format = lower_case(out.input_format);
  const auto stream = std::find(out.inputs.begin(), out.inputs.end(), "-");
  const bool given = stream != out.inputs.end();
  if (given && std::count(out.inputs.begin(), out.inputs.end(), "-") > 1)
    throw UsageError("standard input (-) is one input; give the others as files");
  if (given && out.input_format.empty())
    throw UsageError("standard input (-) has no extension; give --input-format, one of " +
                     streamed_extensions());
  if (!given && !out.input_format.empty())
    throw UsageError("--input-format is for standard input; give - as the input, or leave it out");
  if (given) {
    if (std::find(out.inputs.begin(), out.inputs.end(), standard_input) != out.inputs.end())
      throw UsageError(std::string("a file called ") + standard_input +
                       " would be taken for standard input; give it another name, with an extension");
    *stream = standard_input;
    if (!out.input_format.starts_with('.')) out.input_format.insert(0, ".");
    if (!streams(out.input_format))
      throw UsageError("--input-format " + out.input_format.substr(1) +
                       " is no format of a stream; known are " + streamed_extensions());
  }
}

void complete_output_stream(CommandLine& out) {
  std::vector<const char*> streams;
  for (const auto& [option, file] : {std::pair<const char*, const std::string*>{"-o", &out.output},
                                     {"--boundary", &out.boundary},
                                     {"--stats", &out.stats}})
    if (*file == "-") streams.push_back(option);
  if (streams.size() > 1)
    throw UsageError(std::string(streams[0]) + " - and " + streams[1] +
                     " - both print to standard output; give one of them a file");
  if (streams.empty() || out.stats == "-") return;
  if (out.output_format.empty())
    throw UsageError("standard output (" + std::string(streams[0]) +
                     " -) has no extension; give --output-format");
  if (out.boundary == "-")
    out.boundary_format = std::exchange(out.output_format, {});
  else if (out.command != Command::sample)  // samples are of several kinds
    check_tet_stream(out);
}

void complete_streams(CommandLine& out) {
  check_no_stream(out);
  complete_input_stream(out);
  complete_output_stream(out);
}

}  // namespace

void check_holds_second_order(const std::string& output, const std::string& format) {
  if (written_tet_format(output, format).second_order) return;
  std::string extensions;
  for (const TetFormatInfo& known : written_tet_formats())
    if (known.second_order && !extensions.ends_with(known.extension)) extensions += " " + known.extension;
  throw UsageError("--order 2: " + output + " would be in a format without ten-node tets; write one of" +
                   extensions);
}

void complete_command_line(const CLI::App& chosen, CommandLine& out) {
  complete_streams(out);
  const bool meshes_scans = out.command == Command::prepare || out.command == Command::mesh;
  if (out.command == Command::prepare || out.command == Command::simplify || out.command == Command::improve)
    out.min_solid_angle_given = chosen.count("--min-solid-angle") > 0;
  if (meshes_scans) {
    if (out.inputs.empty() && out.materials.empty())
      throw UsageError(
          "there is no input; name a surface or a segmented volume, or give --material NAME=FILE");
    out.outside_label_given = chosen.count("--outside-label") > 0;
    out.min_voxels_given = chosen.count("--min-voxels") > 0;
  }
  if ((out.command == Command::prepare || out.command == Command::simplify) && out.target_tets == 0 &&
      out.tolerance.value == 0 && out.size_field.empty())
    throw UsageError(
        "--target-tets is required; give the number of tets to reach, --tolerance, or --size-field");
  if (out.command == Command::prepare || out.command == Command::simplify) {
    if (chosen.count("--grading") > 0 && out.size_field.empty())
      throw UsageError("--grading is for the edge lengths of a size field; give --size-field FILE");
    if (out.schedule == Schedule::paper &&
        (!out.size_field.empty() || out.min_edge.value > 0 || out.max_edge.value > 0))
      throw UsageError(
          "--schedule paper bounds no edges; leave out --size-field, --min-edge and --max-edge, or "
          "--schedule");
  }
  if (out.tolerance.value > 0 && out.schedule == Schedule::paper)
    throw UsageError("--schedule paper bounds no distances; leave out --tolerance, or --schedule");
  if (out.command == Command::check && out.tolerance.value > 0 && out.surfaces.empty())
    throw UsageError("--tolerance needs the surfaces that the mesh is compared with; give --surface FILE");
  if (out.order > 1 && !out.output.empty()) check_holds_second_order(out.output, out.output_format);
  if (out.json && out.stats == "-")
    throw UsageError(
        "--json and --stats - both print to standard output; give --stats a file, or leave one out");
  if (out.resolution && out.voxel_size > 0) throw UsageError("give --resolution or --voxel-size, not both");
}

}  // namespace tetwright
