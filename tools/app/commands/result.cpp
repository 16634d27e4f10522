// SPDX-License-Identifier: Apache-2.0
#include "tools/app/commands/result.h"

#include <cstdio>
#include <optional>

#include "tetwright/file_sharing.h"
#include "tetwright/files.h"
#include "tetwright/io.h"
#include "tetwright/parted_interfaces.h"
#include "tetwright/partition.h"
#include "tetwright/prepare_steps.h"
#include "tetwright/tet_parts.h"
#include "tools/app/commands/output_paths.h"
#include "tools/app/commands/report_file.h"
#include "tools/app/printed_report.h"
#include "tools/bricks/process_team.h"
#include "tools/report/stats_json.h"

namespace tetwright {

namespace {

/// Copies the mesh without its interface triangles.
TetMesh without_triangles(TetMesh mesh) {
  mesh.interfaces.clear();
  mesh.patch_groups.clear();
  return mesh;
}

void write_mesh(const TetMesh& mesh, const Prepared& result, const std::optional<TetPartition>& partition,
                CommandRun& run, OutputFiles& files) {
  const OutputOptions& outputs = run.line.outputs;
  const MeshToWrite written(mesh, result.midside ? &*result.midside : nullptr, result.bins);
  if (!partition) {
    write_tet_mesh(written, outputs.mesh, &files, outputs.format);
    return;
  }
  FileSharing share;
  ProcessTeam* const team = run.line.options.bricks.team;
  if (team)
    share.pieces = [&run, team](const PiecesToWrite& pieces) {
      run.pieces_by_helpers =
          team->lead({pieces.count, pieces.here, pieces.order, [](std::size_t, const std::string&) {}});
    };
  if (team && team->writes_hdf5())
    share.hdf5 = [&run, team](const auto&... file) { run.hdf5_ranks = team->write_hdf5(file...); };
  write_tet_mesh(written, *partition, outputs.mesh, &files, outputs.format, &share);
}

}  // namespace

void write_result(Prepared& result, CommandRun& run) {
  const CommandLine& line = run.line;
  const Stopwatch watch;
  run.progress.begin_stage("write");
  OutputFiles files(&run.progress);
  if (!line.outputs.distances.empty()) write_fields(*result.field, line.outputs.distances, &files);
  result.field.reset();  // frees memory for writing the mesh
  std::optional<TetPartition> partition;
  if (line.outputs.parts > 0) {
    partition = partition_tets(result.mesh, line.outputs.parts, &run.progress);
    run.parts = partition_statistics(result.mesh, *partition);
  }
  if (line.outputs.no_boundary)
    write_mesh(without_triangles(result.mesh), result, partition, run, files);
  else
    write_mesh(result.mesh, result, partition, run, files);
  if (line.options.bricks.team) line.options.bricks.team->end();
  if (const std::string table = bins_table_of(line); !table.empty())
    files.write(table, table_of_bins(result.mesh, result.bins));
  if (const std::string table = pairs_table_of(line, !run.report.parted.empty()); !table.empty())
    files.write(table, table_of_pairs(run.report.parted));
  if (!line.outputs.boundary.empty())
    write_interfaces(result.mesh, line.outputs.boundary, &files, line.outputs.boundary_format);
  write_report(result.mesh, run, files);
  run.report.seconds_write = watch.seconds();
  run.report.loops_write = watch.loops();
  run.report.seconds_total = run.since_start.seconds();
  run.report.loops_total = run.since_start.loops();
  write_stats(run, files);
  files.commit();
  remove_bricks(result);
  run.progress.finish();
}

void print_result(const CommandRun& run) {
  if (!run.line.console.quiet) print_notes(notes_of(run.report));
  if (run.line.outputs.stats == "-")
    std::printf("%s\n", stats_json(run).c_str());
  else if (!run.line.console.quiet && run.line.outputs.mesh != "-" && run.line.outputs.boundary != "-")
    print_report(run.line, run.report, run.parts ? &*run.parts : nullptr);
  for (const std::string& line : shortfalls_of(run.report)) print_line(line);
}

}  // namespace tetwright
