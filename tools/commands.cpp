#include "tools/commands.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>

#include "common/field_transfer.h"
#include "common/foreign_mesh.h"
#include "common/formats/atomic_file.h"
#include "common/formats/formats.h"
#include "common/formats/label_names.h"
#include "common/interfaces.h"
#include "common/mesh_check.h"
#include "common/mesh_statistics.h"
#include "common/parallel.h"
#include "common/samples.h"
#include "common/topology.h"
#include "mesher/label_field.h"
#include "mesher/material_field.h"
#include "mesher/vdb_files.h"
#include "tools/held_back.h"
#include "tools/progress_bar.h"
#include "tools/report.h"
#include "tools/stats_json.h"

namespace tetwright {

namespace {

// How far a count may be off, of what was asked; beyond it the status says so.
constexpr double target_slack = 0.01;
constexpr double improve_slack = 0.05;

/// Changes of a material's volume from which on they are noted.
constexpr double volume_note_share = 0.02;

std::vector<std::string> all_inputs(const CommandLine& line) {
  std::vector<std::string> inputs = line.inputs;
  for (const NamedValue& m : line.materials) inputs.push_back(m.value);
  return inputs;
}

/// --stats must not take the place of a mesh: it is a .json file, and none of the others.
void check_stats_path(const CommandLine& line) {
  if (line.stats.empty()) return;
  namespace fs = std::filesystem;
  if (fs::path(line.stats).extension() != ".json")
    throw UsageError("--stats " + line.stats + ": the statistics are JSON; give a name that ends in .json");
  std::vector<std::string> others =
      line.command == Command::sample ? std::vector<std::string>() : all_inputs(line);
  others.push_back(line.write_sdf);
  others.push_back(line.label_names);
  others.push_back(line.output);
  others.push_back(line.before);
  std::error_code ignored;
  for (const std::string& other : others)
    if (!other.empty() && (other == line.stats || fs::equivalent(other, line.stats, ignored)))
      throw UsageError("--stats " + line.stats +
                       " is also the name of another file of this call; give it its own");
  check_output_file(line.stats);
}

/// A surface must not be replaced by its mesh, by way of a link either.
void check_output_is_no_input(const CommandLine& line) {
  std::error_code ignored;
  for (const std::string& input : all_inputs(line))
    if (std::filesystem::equivalent(input, line.output, ignored))
      throw UsageError("-o " + line.output + " is also an input; give the mesh a name of its own");
}

bool is_vdb(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension == ".vdb";
}

/// --write-sdf must not take the place of another file either.
void check_sdf_path(const CommandLine& line) {
  if (line.write_sdf.empty()) return;
  if (!is_vdb(line.write_sdf))
    throw UsageError("--write-sdf " + line.write_sdf +
                     ": signed distances are written for OpenVDB; give a name that ends in .vdb");
  std::error_code ignored;
  for (const std::string& input : all_inputs(line))
    if (input == line.write_sdf || std::filesystem::equivalent(input, line.write_sdf, ignored))
      throw UsageError("--write-sdf " + line.write_sdf + " is also an input; give it another name");
  check_output_file(line.write_sdf);
}

/// What an interrupt cancels.
std::atomic<Progress*> running{nullptr};

void on_interrupt(int) {
  if (Progress* progress = running.load()) progress->cancel();
}

/// While it lives, the first SIGINT or SIGTERM cancels the work, between two of its steps or while it waits
/// for input; a second one ends the process.
class InterruptHandler {
 public:
  explicit InterruptHandler(Progress& progress) {
    running = &progress;
    struct sigaction action {};
    action.sa_handler = on_interrupt;
    action.sa_flags = SA_RESETHAND;  // and no SA_RESTART: a read that waits ends with EINTR
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
  }
  ~InterruptHandler() {
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
    running = nullptr;
  }
};

class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// One run of a command: what is common to those that make a mesh.
class Run {
 public:
  explicit Run(const CommandLine& line)
      : line_(line),
        limit_(line.threads),
        progress_(!line.quiet && !line.no_progress && isatty(STDERR_FILENO)),
        handler_(progress_) {
    check_output_path(line.output);
    check_stats_path(line);
    check_sdf_path(line);
    report_.inputs = all_inputs(line);
    const bool may_replace = line.command == Command::simplify || line.command == Command::improve;
    if (!may_replace) check_output_is_no_input(line);
  }

  void read_input() {
    const Stopwatch watch;
    progress_.begin_stage("read");
    if (is_volume())
      read_volume();
    else
      read_surfaces();
    report_.seconds_read = watch.seconds();
  }

  /// The dense mesh of the input.
  void make_dense() {
    const Stopwatch watch;
    MeshedSurface dense = labels_ ? mesh_labels(*labels_, label_options(), &progress_)
                                  : mesh_surfaces(input_, surface_options(), &progress_);
    if (line_.command == Command::prepare || !line_.write_sdf.empty()) field_ = dense.field;
    mesh_ = std::move(dense.mesh);
    dense.field.reset();
    report_.mesher = dense.report;
    report_.seconds_mesh = watch.seconds();
    input_ = {};
    labels_.reset();
    report_.dense = mesh_statistics(mesh_, line_.min_solid_angle);
  }

 private:
  /// A segmented volume says what all its materials are: it stands alone.
  bool is_volume() {
    bool volume = false;
    const std::vector<std::string> inputs = all_inputs(line_);
    for (const std::string& file : inputs) volume |= file_kind(file) == FileKind::volume;
    // A .vdb file shows what it is when it is opened.
    for (const std::string& file : line_.inputs) {
      if (!is_vdb(file)) continue;
      vdb_labels_ = read_label_grid(file);
      volume |= vdb_labels_.has_value();
    }
    const bool choice = !line_.labels.empty() || !line_.label_names.empty() || line_.outside_label_given ||
                        line_.min_voxels_given;
    if (!volume) {
      if (choice)
        throw UsageError(
            "--labels, --label-names, --outside-label and --min-voxels are for segmented volumes, and no "
            "input is one");
      return false;
    }
    if (inputs.size() > 1 || line_.inputs.empty())
      throw UsageError("a segmented volume is the only input of a call; leave the others away");
    if (!line_.layers.empty())
      throw UsageError("--layer is for surfaces, and the input is a segmented volume");
    if (line_.nested != NestedRule::automatic)
      throw UsageError("--nested is for surfaces, and the input is a segmented volume");
    return true;
  }

  void read_volume() {
    const std::string& file = line_.inputs.front();
    LabelChoice choice;
    choice.labels = line_.labels;
    choice.outside_label = line_.outside_label;
    choice.min_voxels = line_.min_voxels;
    if (!line_.label_names.empty()) choice.names = read_label_names(line_.label_names);
    LabelVolume volume = vdb_labels_ ? std::move(*vdb_labels_) : read_label_volume(file);
    vdb_labels_.reset();
    labels_ = prepare_labels(std::move(volume), file, choice, &progress_);
    report_.findings = labels_->findings;
    report_.volume.emplace(*labels_);
  }

  MesherOptions common_options() const {
    MesherOptions options;
    options.voxel_size = line_.voxel_size;
    options.uniform = line_.uniform;
    options.adaptivity = line_.adaptivity;
    options.keep_outside = line_.keep_outside;
    if (line_.resolution) options.resolution = line_.resolution;
    // Measured: a simplifier's tets with all that hangs on them; a text file beside the mesh, while it grows.
    constexpr double simplifier_bytes = 110, text_bytes = 130;
    if (line_.command == Command::prepare)
      options.later_bytes_per_tet = simplifier_bytes;
    else if (!line_.output.ends_with(".vtu"))
      options.later_bytes_per_tet = text_bytes;
    return options;
  }

  MesherOptions surface_options() const {
    MesherOptions options = common_options();
    if (!line_.resolution && line_.voxel_size == 0 && line_.command == Command::prepare)
      options.resolution = resolution_for_target(input_, line_.target_tets);
    return options;
  }

  MesherOptions label_options() const {
    MesherOptions options = common_options();
    if (!line_.resolution && line_.voxel_size == 0)
      options.voxel_size = line_.command == Command::prepare
                               ? cell_size_for_target(*labels_, line_.target_tets)
                               : default_cell_size(*labels_);
    return options;
  }

  void read_surfaces() {
    std::vector<MaterialSurface> surfaces;
    const auto add = [&](const std::string& name, const std::string& file, TriangleMesh surface) {
      report_.input_triangles += surface.triangles.size();
      report_.input_points += surface.points.size();
      surfaces.push_back({name, static_cast<MaterialTag>(surfaces.size() + 1), std::move(surface), file});
    };
    for (const std::string& file : line_.inputs) {
      if (is_vdb(file))
        for (NamedSurface& s : read_level_sets(file))
          add(s.name.empty() ? file_stem(file) : s.name, file, std::move(s.surface));
      else
        add(file_stem(file), file, read_surface(file));
    }
    for (const NamedValue& m : line_.materials) {
      if (!is_vdb(m.value)) {
        add(m.name, m.value, read_surface(m.value));
        continue;
      }
      std::vector<NamedSurface> read = read_level_sets(m.value);
      if (read.size() > 1)
        throw InputError(m.value, 0,
                         "holds " + std::to_string(read.size()) + " level sets, but --material " + m.name +
                             " is one; give the file as an input, and its grids name the materials");
      add(m.name, m.value, std::move(read[0].surface));
    }
    std::vector<MaterialLayer> layers;
    for (const NamedValue& l : line_.layers)
      layers.push_back(
          {l.name, static_cast<MaterialTag>(surfaces.size() + layers.size() + 1), std::stod(l.value)});
    input_ = prepare_input(std::move(surfaces), std::move(layers), line_.nested);
    report_.findings = input_.findings;
  }

 public:
  void read_mesh() {
    const Stopwatch watch;
    progress_.begin_stage("read");
    ReadTetMesh read = read_tet_mesh(line_.inputs.front(), {line_.material_field});
    mesh_ = std::move(read.mesh);
    report_.material_field = read.material_field;
    report_.input_points = mesh_.points.size();
    make_mesh_coherent();
    if (mesh_.tets.empty())
      throw InputError(line_.inputs.front(), 0, "all its tets have a vertex twice; nothing is left of it");
    if (!mesh_.point_fields.empty() || !mesh_.cell_fields.empty()) {
      fields_from_ = mesh_;
      mesh_.point_fields.clear();
      mesh_.cell_fields.clear();
    }
    report_.seconds_read = watch.seconds();
    if (line_.target_tets > mesh_.tets.size())
      throw UsageError("--target-tets " + std::to_string(line_.target_tets) + " is above the " +
                       std::to_string(mesh_.tets.size()) + " tets of " + line_.inputs.front() +
                       "; give fewer");
    report_.dense = mesh_statistics(mesh_, line_.min_solid_angle);
  }

  void simplify_mesh() {
    SimplifyOptions options;
    options.target_tets = line_.target_tets;
    options.min_solid_angle = line_.min_solid_angle;
    options.beta = line_.beta;
    options.gamma = line_.gamma;
    options.max_iterations = line_.max_iterations;
    options.schedule = line_.schedule;
    options.objective = line_.objective;
    options.reference = field_.get();  // nothing where a mesh was read
    options.seed = line_.seed;
    options.name = report_.inputs.front();
    report_.simplify.emplace();
    mesh_ = simplify(std::move(mesh_), options, &*report_.simplify, &progress_);
    carry_fields();
    note_pinned_points();
    if (line_.write_sdf.empty()) field_.reset();
  }

  void improve_mesh() {
    ImproveOptions options;
    options.only_below = line_.only_below;
    options.min_solid_angle = line_.min_solid_angle;
    options.objective = line_.objective;
    options.max_iterations = line_.max_iterations;
    options.seed = line_.seed;
    options.name = report_.inputs.front();
    report_.simplify.emplace();
    mesh_ = improve(std::move(mesh_), options, &*report_.simplify, &progress_);
    carry_fields();
    note_pinned_points();
  }

  ExitStatus finish() {
    // The dense mesh is the result where nothing was done to it.
    report_.result = report_.simplify ? mesh_statistics(mesh_, line_.min_solid_angle) : report_.dense;
    report_.material_names = mesh_.material_names;
    note_volumes();
    if (report_.simplify) find_shortfall();
    const Stopwatch watch;
    progress_.throw_if_cancelled();
    progress_.begin_stage("write");
    if (field_) write_fields(*field_, line_.write_sdf);
    write_tet_mesh(mesh_, line_.output);
    report_.seconds_write = watch.seconds();
    report_.seconds_total = total_.seconds();
    if (!line_.stats.empty())
      write_file_atomically(line_.stats, json_text(stats_json(line_, report_)) + "\n");
    progress_.clear();
    if (!line_.quiet) print_notes(report_);
    if (!line_.quiet) print_report(line_, report_);
    for (const Shortfall& s : report_.shortfall)
      std::fprintf(stderr, "tetwright: short of %s: %.10g was asked, %.10g reached; held back by: %s\n",
                   s.what != "target_tets"             ? "--min-solid-angle"
                   : line_.command == Command::improve ? "about the same count"
                                                       : "--target-tets",
                   s.asked, s.reached, s.held_back_by.c_str());
    return report_.shortfall.empty() ? ExitStatus::done : ExitStatus::short_of_request;
  }

 private:
  /// Other programs list tets the other way round, repeat points for each tet, and worse.
  void make_mesh_coherent() {
    const ForeignReport found = make_coherent(mesh_);
    const auto note = [&](std::size_t count, const char* what, const char* done,
                          std::optional<Vec3> place = {}) {
      if (count) report_.findings.push_back({line_.inputs.front(), {what, count, place, done}});
    };
    note(found.merged_points, "points repeated for each tet", "merged where coordinates are equal");
    note(found.removed_tets, "tets with a vertex twice", "left out");
    note(found.turned_tets, "tets listed the other way round", "turned");
    std::optional<Vec3> first;
    if (!found.first_inverted.empty()) first = mesh_.points[mesh_.tets[found.first_inverted.front()][0]];
    note(found.inverted_tets, "flat or negative tets", "kept unless the work puts them right", first);
  }

  /// The fields of the input, if it had any, on the mesh that was made of it.
  void carry_fields() {
    if (!fields_from_) return;
    transfer_fields(*fields_from_, mesh_);
    fields_from_.reset();
  }

  /// What nobody asked for and everybody would want to know.
  void note_volumes() {
    if (!report_.dense || !report_.result || !report_.simplify) return;
    for (const auto& [tag, before] : report_.dense->materials) {
      const auto after = report_.result->materials.find(tag);
      const double volume = after == report_.result->materials.end() ? 0 : after->second.volume;
      if (!(std::fabs(volume - before.volume) > volume_note_share * std::fabs(before.volume))) continue;
      const auto name = mesh_.material_names.find(tag);
      report_.findings.push_back(
          {line_.inputs.front(),
           {"material '" + (name != mesh_.material_names.end() ? name->second : std::to_string(tag)) +
                "' whose volume changed by " +
                std::to_string(static_cast<int>(std::lround(100 * (volume / before.volume - 1)))) + " %",
            1,
            {},
            "the schedule does not bound it"}});
    }
  }

  void note_pinned_points() {
    if (report_.simplify && report_.simplify->pinned_points > 0)
      report_.findings.push_back({line_.inputs.front(),
                                  {"points where parts touch without a common face",
                                   report_.simplify->pinned_points,
                                   {},
                                   "kept as they are with all their tets"}});
  }

  std::string what_changed_the_count(double asked, double reached) const {
    if (line_.command == Command::improve)
      return "nothing: shapes were worth " + std::string(reached < asked ? "fewer" : "more") + " tets";
    if (reached > asked) return count_held_back_by(*report_.simplify, line_.max_iterations);
    return static_cast<double>(report_.dense->tets) < asked
               ? "the dense mesh, which has too few tets; raise --resolution"
               : "nothing: the closing improvement took tets away";
  }

  void find_shortfall() {
    const bool improved = line_.command == Command::improve;
    const double asked = static_cast<double>(improved ? report_.dense->tets : line_.target_tets);
    const double reached = static_cast<double>(report_.result->tets);
    if (std::fabs(reached - asked) > (improved ? improve_slack : target_slack) * asked)
      report_.shortfall.push_back({"target_tets", asked, reached, what_changed_the_count(asked, reached)});
    if (line_.min_solid_angle_given && report_.result->min_solid_angle < line_.min_solid_angle)
      report_.shortfall.push_back({"min_solid_angle", line_.min_solid_angle, report_.result->min_solid_angle,
                                   shapes_held_back_by(*report_.simplify)});
  }

  const CommandLine& line_;
  Stopwatch total_;
  ThreadLimit limit_;
  ProgressBar progress_;
  InterruptHandler handler_;
  RunReport report_;
  PreparedInput input_;
  std::optional<LabelVolume> vdb_labels_;  ///< of a .vdb file, until they are prepared
  std::optional<PreparedLabels> labels_;
  std::shared_ptr<const MaterialField> field_;  ///< while it is slid along, or where it is to be written
  TetMesh mesh_;
  std::optional<TetMesh> fields_from_;  ///< the mesh as it was read, if it had fields
};

ExitStatus prepare(const CommandLine& line) {
  Run run(line);
  run.read_input();
  run.make_dense();
  run.simplify_mesh();
  return run.finish();
}

ExitStatus mesh(const CommandLine& line) {
  Run run(line);
  run.read_input();
  run.make_dense();
  return run.finish();
}

ExitStatus simplify(const CommandLine& line) {
  Run run(line);
  run.read_mesh();
  run.simplify_mesh();
  return run.finish();
}

ExitStatus improve(const CommandLine& line) {
  Run run(line);
  run.read_mesh();
  run.improve_mesh();
  return run.finish();
}

ExitStatus check(const CommandLine& line) {
  const ThreadLimit limit(line.threads);
  check_stats_path(line);
  const Stopwatch total;
  RunReport run;
  run.inputs = line.inputs;
  // Of two meshes it is enough that one has the field: what was made of the other has it as "material".
  const ReadTetMeshOptions options{line.material_field, line.before.empty()};
  ReadTetMesh read = read_tet_mesh(line.inputs.front(), options);
  bool field_found = read.material_field == line.material_field;
  run.material_field = read.material_field;
  run.input_points = read.mesh.points.size();
  run.seconds_read = total.seconds();
  const std::vector<MeshFinding> findings = check_mesh(read.mesh);
  const bool valid = findings.empty();
  // Without sound indices and coordinates there is nothing to measure.
  const bool measurable = valid || findings.front().fault > MeshFault::coordinates_not_finite;
  std::vector<std::string> topology_text, differences;
  nlohmann::json json = {{"valid", valid}, {"findings", nlohmann::json::array()}};
  for (const MeshFinding& f : findings)
    json["findings"].push_back({{"number", static_cast<int>(f.fault)},
                                {"name", mesh_fault_name(f.fault)},
                                {"count", f.count},
                                {"places", f.places}});
  if (measurable) {
    read.mesh.interfaces = find_interfaces(read.mesh);
    run.result = mesh_statistics(read.mesh, line.min_solid_angle);
    run.material_names = read.mesh.material_names;
    json["mesh"] = mesh_json(*run.result, run.material_names, line.min_solid_angle);
    const Topology signature = topology(read.mesh);
    topology_text = topology_lines(signature);
    json["topology"] = topology_text;
    if (!line.before.empty()) {
      const ReadTetMesh before = read_tet_mesh(line.before, options);
      field_found = field_found || before.material_field == line.material_field;
      differences = topology_differences(topology(before.mesh), signature);
    }
  }
  // It is not where it has to be: the reader says what there is.
  if (!line.material_field.empty() && !field_found)
    (void)read_tet_mesh(line.inputs.front(), {line.material_field});
  if (!line.before.empty()) json["topology_differences"] = differences;
  const bool kept = differences.empty();
  run.seconds_total = total.seconds();
  if (!line.stats.empty()) write_file_atomically(line.stats, json_text(stats_json(line, run)) + "\n");
  if (line.json) {
    std::printf("%s\n", json_text(json).c_str());
  } else if (!line.quiet) {
    for (const MeshFinding& f : findings)
      std::printf("finding %d, %s\n", static_cast<int>(f.fault), mesh_finding_line(f).c_str());
    if (measurable) {
      print_report(line, run);
      for (const std::string& l : topology_text) std::printf("%s\n", l.c_str());
    }
    for (const std::string& d : differences) std::printf("topology differs: %s\n", d.c_str());
    std::printf("%s\n", !valid ? "not valid" : kept ? "valid" : "valid, but of another topology");
  }
  return valid && kept ? ExitStatus::done : ExitStatus::short_of_request;
}

ExitStatus sample(const CommandLine& line) {
  const ThreadLimit limit(line.threads);
  const Stopwatch total;
  check_output_path(line.output, sample_kind(line.inputs.front()));
  check_stats_path(line);
  write_sample(line.inputs.front(), line.output);
  if (!line.stats.empty()) {
    RunReport run;
    run.seconds_total = total.seconds();
    write_file_atomically(line.stats, json_text(stats_json(line, run)) + "\n");
  }
  return ExitStatus::done;
}

}  // namespace

ExitStatus run_command(const CommandLine& line) {
  switch (line.command) {
    case Command::prepare:
      return prepare(line);
    case Command::mesh:
      return mesh(line);
    case Command::simplify:
      return simplify(line);
    case Command::improve:
      return improve(line);
    case Command::check:
      return check(line);
    case Command::sample:
      return sample(line);
  }
  return ExitStatus::usage;
}

}  // namespace tetwright
