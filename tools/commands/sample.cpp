#include "common/samples.h"

#include <cstdio>

#include "common/formats/atomic_file.h"
#include "common/formats/formats.h"
#include "tools/commands/command_run.h"
#include "tools/commands/commands.h"
#include "tools/stats_json.h"

namespace tetwright {

namespace {

FileKind kind_of(const TriangleMesh&) { return FileKind::surface; }
FileKind kind_of(const TetMesh&) { return FileKind::tet_mesh; }
FileKind kind_of(const LabelVolume&) { return FileKind::volume; }

void write(const TriangleMesh& surface, const std::string& path, OutputFiles& files) {
  write_surface(surface, path, &files);
}
void write(const TetMesh& mesh, const std::string& path, OutputFiles& files) {
  write_tet_mesh(mesh, path, &files);
}
void write(const LabelVolume& volume, const std::string& path, OutputFiles& files) {
  write_label_volume(volume, path, &files);
}

}  // namespace

void run_sample(CommandRun& run) {
  const CommandLine& line = run.line;
  const Sample sample = make_sample(line.inputs.front());
  check_output_path(line.output, std::visit([](const auto& made) { return kind_of(made); }, sample));
  OutputFiles files;
  std::visit([&](const auto& made) { write(made, line.output, files); }, sample);
  run.report.seconds_total = run.since_start.seconds();
  write_stats(run, files);
  files.commit();
  if (line.stats == "-") std::printf("%s\n", stats_json(line, run.report).c_str());
}

}  // namespace tetwright
