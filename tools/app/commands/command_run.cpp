// SPDX-License-Identifier: Apache-2.0
#include "tools/app/commands/command_run.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "common/geometry/measurable.h"
#include "common/io/names/mesh_fields.h"
#include "common/io/tets/file_triangles.h"
#include "tools/report/stats_json.h"

namespace tetwright {

namespace {

constexpr double gigabyte = 1 << 30;
/// More than a clock can count would be no limit.
constexpr double max_seconds = 1e9;
/// Share of --time-limit that is kept at least for comparing and writing the mesh.
constexpr double min_reserve = 0.1;

bool is_stream(const CommandLine& line, const std::string& name) {
  return name == standard_input && !line.input_format.empty();
}

std::string read_stream(CommandRun& run) {
  const Stopwatch watch;
  std::string bytes = read_standard_input();
  run.seconds_waited += watch.seconds();
  return bytes;
}

/// Takes the object of that name, or `read`s the file.
template <class Object, class Read>
auto take(std::map<std::string, Object> InputObjects::*kind, InputObjects* objects, const std::string& name,
          const Read& read) -> decltype(read()) {
  if (objects) {
    auto& all = objects->*kind;
    if (const auto object = all.find(name); object != all.end()) return {std::move(object->second)};
  }
  return read();
}

}  // namespace

CommandRun::CommandRun(const CommandLine& call, Progress& shown, InputObjects* in_memory)
    : line(call), memory_limit(call.memory_limit * gigabyte), progress(shown), objects(in_memory) {
  reserve_time(min_reserve * seconds_left());
  report.inputs = input_files(call);
}

double CommandRun::seconds_left() const {
  return line.time_limit == 0 ? std::numeric_limits<double>::infinity()
                              : std::max(0.0, std::min(line.time_limit, max_seconds) - since_start.seconds());
}

void CommandRun::reserve_time(double seconds) {
  if (line.time_limit == 0) return;
  const std::chrono::duration<double> left(seconds_left() - seconds);
  const auto end = Progress::Clock::now() + std::chrono::duration_cast<Progress::Clock::duration>(left);
  progress.set_deadline(std::min(progress.deadline(), end));
}

bool is_object(const CommandRun& run, const std::string& name) {
  return run.objects && (run.objects->surfaces.contains(name) || run.objects->meshes.contains(name) ||
                         run.objects->volumes.contains(name));
}

std::string material_name_of(const CommandRun& run, const std::string& name) {
  return is_object(run, name) ? name : file_stem(name);
}

FileKind input_kind(const CommandRun& run, const std::string& name) {
  if (run.objects) {
    if (run.objects->surfaces.contains(name)) return FileKind::surface;
    if (run.objects->meshes.contains(name)) return FileKind::tet_mesh;
    if (run.objects->volumes.contains(name)) return FileKind::volume;
  }
  return file_kind(typed_name(run.line, name));
}

std::string typed_name(const CommandLine& line, const std::string& name) {
  return is_stream(line, name) ? name + line.input_format : name;
}

TriangleMesh take_surface(CommandRun& run, const std::string& name, std::vector<Dropped>* dropped) {
  if (run.objects && dropped)
    if (const auto of_object = run.objects->dropped.find(name); of_object != run.objects->dropped.end())
      dropped->insert(dropped->end(), of_object->second.begin(), of_object->second.end());
  return take(&InputObjects::surfaces, run.objects, name, [&] {
    return is_stream(run.line, name)
               ? read_surface_bytes(read_stream(run), name, run.line.input_format, dropped)
               : read_surface(name, dropped);
  });
}

ReadTetMesh take_tet_mesh(CommandRun& run, const std::string& name, const ReadTetMeshOptions& options) {
  if (run.objects) {
    auto& meshes = run.objects->meshes;
    if (const auto object = meshes.find(name); object != meshes.end()) {
      ReadTetMesh read = std::move(object->second);
      const FileTriangles listed = std::exchange(run.objects->triangles[name], {});
      require_measurable(read.mesh, name);
      take_material(read, options, name);
      take_triangles(listed, "group", name, read);
      return read;
    }
  }
  return is_stream(run.line, name)
             ? read_tet_mesh_bytes(read_stream(run), name, run.line.input_format, options)
             : read_tet_mesh(name, options);
}

LabelVolume take_label_volume(CommandRun& run, const std::string& name) {
  return take(&InputObjects::volumes, run.objects, name, [&] {
    return is_stream(run.line, name) ? read_label_volume_bytes(read_stream(run), name, run.line.input_format)
                                     : read_label_volume(name);
  });
}

void write_stats(const CommandRun& run, OutputFiles& files) {
  if (!run.line.stats.empty() && run.line.stats != "-")
    files.write(run.line.stats, stats_json(run.line, run.report) + "\n");
}

std::vector<std::string> input_files(const CommandLine& line) {
  if (line.command == Command::sample) return {};
  std::vector<std::string> inputs = line.inputs;
  for (const NamedValue& m : line.materials) inputs.push_back(m.value);
  return inputs;
}

void report_dropped(const std::vector<Dropped>& dropped, const std::string& file, RunReport& report,
                    bool with_restored) {
  for (const Dropped& d : dropped)
    if (with_restored || !d.restored)
      report.findings.push_back(
          {file, {d.what, d.count, {}, d.restored ? "found again from the materials" : "dropped"}});
}

}  // namespace tetwright
