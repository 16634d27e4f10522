// SPDX-License-Identifier: Apache-2.0
#include "common/samples/samples.h"

#include <cstdio>

#include "common/samples/foam.h"
#include "tetwright/files.h"
#include "tetwright/io.h"
#include "tetwright/resources.h"
#include "tools/app/commands/command_run.h"
#include "tools/app/commands/commands.h"
#include "tools/app/commands/output_paths.h"
#include "tools/report/stats_json.h"

namespace tetwright {

namespace {

FileKind kind_of(const TriangleMesh&) { return FileKind::surface; }
FileKind kind_of(const TetMesh&) { return FileKind::tet_mesh; }
FileKind kind_of(const LabelVolume&) { return FileKind::volume; }

void write(const TriangleMesh& surface, const CommandLine& line, OutputFiles& files) {
  write_surface(surface, line.outputs.mesh, &files, line.outputs.format);
}
void write(const TetMesh& mesh, const CommandLine& line, OutputFiles& files) {
  check_tet_stream(line);
  write_tet_mesh(mesh, line.outputs.mesh, &files, line.outputs.format);
}
void write(const LabelVolume& volume, const CommandLine& line, OutputFiles& files) {
  write_label_volume(volume, line.outputs.mesh, &files, line.outputs.format);
}

/// Writes a foam piece by piece, since it may be larger than the memory.
void write_foam(CommandRun& run, OutputFiles& files) {
  const OutputOptions& out = run.line.outputs;
  check_output_path(out.mesh, FileKind::volume, out.format);
  const FoamOptions& options = run.line.foam;
  const int voxels = options.voxels.value_or(default_foam_voxels);
  const Foam foam(voxels, options.grains.value_or(default_foam_grains(voxels)));
  if (out.mesh == "-")
    require_memory(static_cast<double>(foam.grid().voxels()) * sizeof(MaterialTag),
                   "the volume for standard output", "give -o a file");
  run.progress.begin_stage("write");
  write_label_source(foam, foam.grains(), out.mesh, &files, out.format, &run.progress);
  run.progress.finish();
}

void write_sample(const CommandLine& line, OutputFiles& files) {
  const Sample sample = make_sample(line.inputs.front());
  check_output_path(line.outputs.mesh, std::visit([](const auto& made) { return kind_of(made); }, sample),
                    line.outputs.format);
  std::visit([&](const auto& made) { write(made, line, files); }, sample);
}

}  // namespace

void run_sample(CommandRun& run) {
  const CommandLine& line = run.line;
  OutputFiles files(&run.progress);
  if (line.inputs.front() == foam_name)
    write_foam(run, files);
  else
    write_sample(line, files);
  run.report.seconds_total = run.since_start.seconds();
  run.report.loops_total = run.since_start.loops();
  write_stats(run, files);
  files.commit();
  if (line.outputs.stats == "-") std::printf("%s\n", stats_json(run).c_str());
}

}  // namespace tetwright
