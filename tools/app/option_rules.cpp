// SPDX-License-Identifier: Apache-2.0
#include "tools/app/option_rules.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "common/lower_case.h"
#include "common/message_text.h"
#include "common/samples/foam.h"
#include "tetwright/error.h"
#include "tetwright/io.h"
#include "tetwright/prepare_steps.h"
#include "tools/app/commands/output_paths.h"
#include "tools/app/interface_options.h"
#include "tools/app/value_options.h"

namespace tetwright {

namespace {

/// Rejects "-" for options that require a file.
void check_no_stream(const CommandLine& out) {
  const auto check = [](const char* option, const std::string& file) {
    if (file == "-")
      throw UsageError(std::string(option) +
                       " cannot be -; give a file (- is for the input, -o, --boundary and --stats)");
  };
  check("--write-sdf", out.outputs.distances);
  check("--report", out.outputs.report);
  check("--log-file", out.console.log_file);
  check("--results", out.batch.results);
  check("--label-names", out.options.labels.names_file);
  if (out.options.sizes.field) check("--size-field", out.options.sizes.field->name);
  check("--before", out.check.before);
  for (const std::string& file : out.check.surfaces) check("--surface", file);
  for (const NamedValue& m : out.materials) check("--material", m.value);
  for (const ValueImage& image : out.options.values.images) check("an image", image.file);
  check("--values-mask", out.options.values.mask_file);
  for (const NamedValue& s : out.sheets) check("--sheet", s.value);
  for (const NamedValue& p : out.partitions) check("--partition", p.value);
  if (out.command == Command::batch) check("the file of jobs", out.inputs.front());
}

void complete_input_stream(CommandLine& out) {
  out.input_format = lower_case(out.input_format);
  const auto stream = std::find(out.inputs.begin(), out.inputs.end(), "-");
  const bool given = stream != out.inputs.end();
  if (given && std::count(out.inputs.begin(), out.inputs.end(), "-") > 1)
    throw UsageError("standard input (-) can be given once; give the other inputs as files");
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
                       " is not a stream format; supported: " + streamed_extensions());
  }
}

void complete_output_stream(CommandLine& out) {
  std::vector<const char*> streams;
  for (const auto& [option, file] : {std::pair<const char*, const std::string*>{"-o", &out.outputs.mesh},
                                     {"--boundary", &out.outputs.boundary},
                                     {"--stats", &out.outputs.stats}})
    if (*file == "-") streams.push_back(option);
  if (streams.size() > 1)
    throw UsageError(std::string(streams[0]) + " - and " + streams[1] +
                     " - both print to standard output; give one of them a file");
  if (streams.empty() || out.outputs.stats == "-") return;
  if (out.outputs.format.empty())
    throw UsageError("standard output (" + std::string(streams[0]) +
                     " -) has no extension; give --output-format");
  if (out.outputs.boundary == "-")
    out.outputs.boundary_format = std::exchange(out.outputs.format, {});
  else if (out.command == Command::embed)
    check_embedding_path(out.outputs.mesh, out.outputs.format);
  else if (out.command != Command::sample)  // a sample may be of any kind
    check_tet_stream(out);
}

void check_parts(const CommandLine& out) {
  if (out.outputs.parts == 0) return;
  if (out.outputs.mesh.empty()) throw UsageError("--parts is for files; give -o FILE");
  (void)written_tet_format(out.outputs.mesh, out.outputs.format, out.outputs.parts);
  if (const auto& tets = out.options.target.tets; tets && *tets < out.outputs.parts)
    throw UsageError("--parts " + std::to_string(out.outputs.parts) + ": a mesh of " + std::to_string(*tets) +
                     " tets (--target-tets) has fewer tets than parts; give a smaller number");
}

void check_foam(const CommandLine& out) {
  const auto& [voxels, grains] = out.foam;
  if (!voxels && !grains) return;
  const std::string& name = out.inputs.front();
  if (name != foam_name)
    throw UsageError(
        (voxels ? "--voxels " + std::to_string(*voxels) : "--grains " + std::to_string(*grains)) +
        " is for the sample " + foam_name + "; leave it out, or give " + foam_name + " instead of " +
        in_quotes(name));
  const int edge = voxels.value_or(default_foam_voxels);
  if (const std::uint32_t most = max_foam_grains(edge); grains.value_or(1) > most)
    throw UsageError("--grains " + std::to_string(*grains) + ": a foam with " + std::to_string(edge) +
                     " voxels along each edge has room for " + std::to_string(most) +
                     " (a 64th of its voxels); give fewer grains or more --voxels");
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

void complete_command_line(CommandLine& out) {
  complete_streams(out);
  complete_value_options(out);
  const bool meshes_scans = out.command == Command::prepare || out.command == Command::mesh;
  if (meshes_scans && out.inputs.empty() && out.materials.empty())
    throw UsageError("there is no input; name a surface or a segmented volume, or give --material NAME=FILE");
  if (makes_mesh(out.command)) check_options(task_of(out.command), out.options);
  if (out.command == Command::check && out.options.target.tolerance && out.check.surfaces.empty())
    throw UsageError("--tolerance needs the surfaces that the mesh is compared with; give --surface FILE");
  if (out.command == Command::check && out.check.surfaces.empty())
    for (const auto& [option, space] : {std::pair("--surface-space", &out.options.bodies.surface_space),
                                        {"--mesh-space", &out.options.mesh_space}})
      if (!space->empty())
        throw UsageError(std::string(option) +
                         " is for the surfaces that the mesh is compared with; give --surface FILE");
  if (out.options.order > 1 && !out.outputs.mesh.empty())
    check_holds_second_order(out.outputs.mesh, out.outputs.format);
  check_interface_options(out);
  check_parts(out);
  check_foam(out);
  if (out.check.json && out.outputs.stats == "-")
    throw UsageError(
        "--json and --stats - both print to standard output; give --stats a file, or leave one out");
}

}  // namespace tetwright
