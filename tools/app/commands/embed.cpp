// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "common/message_text.h"
#include "tetwright/embedding.h"
#include "tetwright/files.h"
#include "tetwright/io.h"
#include "tetwright/prepare_steps.h"
#include "tetwright/resources.h"
#include "tools/app/commands/command_run.h"
#include "tools/app/commands/commands.h"
#include "tools/app/commands/output_paths.h"
#include "tools/app/commands/surfaces_of_mesh.h"
#include "tools/app/printed_report.h"
#include "tools/report/stats_json.h"

namespace tetwright {

namespace {

/// Peak memory of the process, bytes: its libraries, the meshes, the search tree of the tets, and the weights
/// with their file before it is written. 3 million points in 200,000 tets take 960 MB.
constexpr double embed_program_bytes = 40e6;
constexpr double embed_bytes_per_tet = 110, bytes_per_point = 100, file_bytes_per_point = 240;

TetMesh read_carrier(CommandRun& run) {
  Input input = input_named(run.line.inputs.front(), run.line, run.in_memory);
  double waited = 0;
  ReadTetMesh read = take_tet_mesh(input, {}, waited);
  report_dropped(read.dropped, input.name, run.report, false);
  return std::move(read.mesh);
}

/// Reads the surface, brought into the space of the mesh.
TriangleMesh read_carried(const TetMesh& mesh, CommandRun& run) {
  Input input = input_named(run.line.inputs.back(), run.line, run.in_memory);
  std::vector<Dropped> dropped;
  double waited = 0;
  TriangleMesh surface = take_surface(input, &dropped, waited);
  report_dropped(dropped, input.name, run.report, false);
  SpacesOfSurfaces spaces(mesh, run);
  spaces.add(surface, input);
  spaces.report();
  return surface;
}

void report_outside(CommandRun& run) {
  const EmbeddingSummary& found = run.embedding->summary;
  if (found.outside == 0) return;
  run.report.diagnostics.push_back({.code = DiagnosticCode::points_outside,
                                    .file = run.line.inputs.back(),
                                    .what = "points outside the mesh",
                                    .count = found.outside,
                                    .done = "they have the weights of the nearest point of a tet; at most " +
                                            short_number(found.largest_distance) + " away",
                                    .places = {found.place}});
}

void print_embedding(const CommandRun& run) {
  const EmbeddingReport& made = *run.embedding;
  const EmbeddingSummary& found = made.summary;
  std::printf("%zu points in %zu tets: %zu outside", found.points, made.tets, found.outside);
  if (found.largest_distance > 0)
    std::printf("; the farthest is %.4g away, at %s", found.largest_distance,
                place_text(found.place).c_str());
  std::printf("\n%.2f s: read %.2f, embed %.2f, write %.2f; peak memory %.0f MB\n", run.report.seconds_total,
              run.report.seconds_read, made.seconds, run.report.seconds_write,
              static_cast<double>(peak_bytes()) / 1e6);
}

}  // namespace

Embedding make_embedding(CommandRun& run) {
  const CommandLine& line = run.line;
  const std::string& mesh_name = line.inputs.front();
  run.progress.begin_stage("read");
  const TetMesh mesh = read_carrier(run);
  const TriangleMesh surface = read_carried(mesh, run);
  run.report.input_points = surface.points.size();
  run.report.input_triangles = surface.triangles.size();
  run.report.seconds_read = run.since_start.seconds();
  run.report.loops_read = run.since_start.loops();
  const auto points = static_cast<double>(surface.points.size());
  require_memory(embed_program_bytes + embed_bytes_per_tet * static_cast<double>(mesh.tets.size()) +
                     bytes_per_point * points +
                     (line.outputs.mesh.empty() ? 0 : file_bytes_per_point * points),
                 "the weights of " + std::to_string(surface.points.size()) + " points",
                 "free some, or give a larger --memory-limit");
  run.progress.begin_stage("embed");
  const Stopwatch watch;
  Embedding made = embed_points(mesh, surface.points, mesh_name);
  run.embedding = EmbeddingReport{summary_of(made, mesh, surface.points), mesh.tets.size(), watch.seconds()};
  run.report.seconds_total = run.since_start.seconds();
  run.report.loops_total = run.since_start.loops();
  report_outside(run);
  return made;
}

void write_embedding(const Embedding& made, CommandRun& run) {
  const Stopwatch watch;
  run.progress.begin_stage("write");
  OutputFiles files(&run.progress);
  write_embedding(made, run.line.outputs.mesh, &files, run.line.outputs.format);
  run.report.seconds_write = watch.seconds();
  run.report.loops_write = watch.loops();
  run.report.seconds_total = run.since_start.seconds();
  run.report.loops_total = run.since_start.loops();
  write_stats(run, files);
  files.commit();
  run.progress.finish();
}

void run_embed(CommandRun& run) {
  const CommandLine& line = run.line;
  check_output_paths(line);
  write_embedding(make_embedding(run), run);
  if (!line.console.quiet) print_notes(notes_of(run.report));
  if (line.outputs.stats == "-")
    std::printf("%s\n", stats_json(run).c_str());
  else if (!line.console.quiet && line.outputs.mesh != "-")
    print_embedding(run);
}

}  // namespace tetwright
