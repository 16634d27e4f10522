// SPDX-License-Identifier: Apache-2.0
#include "common/samples/samples.h"

#include <cstdio>

#include "tetwright/files.h"
#include "tetwright/io.h"
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

}  // namespace

void run_sample(CommandRun& run) {
  const CommandLine& line = run.line;
  const Sample sample = make_sample(line.inputs.front());
  check_output_path(line.outputs.mesh, std::visit([](const auto& made) { return kind_of(made); }, sample),
                    line.outputs.format);
  OutputFiles files;
  std::visit([&](const auto& made) { write(made, line, files); }, sample);
  run.report.seconds_total = run.since_start.seconds();
  run.report.loops_total = run.since_start.loops();
  write_stats(run, files);
  files.commit();
  if (line.outputs.stats == "-") std::printf("%s\n", stats_json(run).c_str());
}

}  // namespace tetwright
