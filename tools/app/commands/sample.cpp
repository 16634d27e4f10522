// SPDX-License-Identifier: Apache-2.0
#include "common/samples/samples.h"

#include <cstdio>

#include "common/files/atomic_file.h"
#include "common/io/formats.h"
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
  write_surface(surface, line.output, &files, line.output_format);
}
void write(const TetMesh& mesh, const CommandLine& line, OutputFiles& files) {
  check_tet_stream(line);
  write_tet_mesh(mesh, line.output, &files, line.output_format);
}
void write(const LabelVolume& volume, const CommandLine& line, OutputFiles& files) {
  write_label_volume(volume, line.output, &files, line.output_format);
}

}  // namespace

void run_sample(CommandRun& run) {
  const CommandLine& line = run.line;
  const Sample sample = make_sample(line.inputs.front());
  check_output_path(line.output, std::visit([](const auto& made) { return kind_of(made); }, sample),
                    line.output_format);
  OutputFiles files;
  std::visit([&](const auto& made) { write(made, line, files); }, sample);
  run.report.seconds_total = run.since_start.seconds();
  write_stats(run, files);
  files.commit();
  if (line.stats == "-") std::printf("%s\n", stats_json(line, run.report).c_str());
}

}  // namespace tetwright
