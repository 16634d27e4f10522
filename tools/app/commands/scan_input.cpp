// SPDX-License-Identifier: Apache-2.0
#include "tools/app/commands/scan_input.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include "common/error.h"
#include "common/io/formats.h"
#include "common/io/names/unique_names.h"
#include "common/io/volumes/label_names.h"
#include "common/memory.h"
#include "common/utf8.h"
#include "mesher/input/split_solids.h"
#include "mesher/mesh_estimate.h"
#include "tools/app/commands/edge_sizes_input.h"
#include "tools/app/commands/simplification.h"

namespace tetwright {

namespace {

/// Refuses files that cannot be an input of `prepare` and `mesh` by their extension.
void check_input_kinds(const CommandRun& run) {
  const CommandLine& line = run.line;
  for (const std::string& file : input_files(line)) {
    const FileKind kind = input_kind(run, file);
    if (kind == FileKind::surface || kind == FileKind::volume || is_vdb(file) ||
        may_hold_surface(typed_name(line, file)))
      continue;
    std::string read = name_of(line.command);
    read.append(" reads surfaces (").append(known_extensions(FileKind::surface));
    read.append("), level sets (.vdb) and segmented volumes (").append(known_extensions(FileKind::volume));
    read.append(" .vdb)");
    if (kind == FileKind::tet_mesh)
      throw UsageError(
          std::string(file)
              .append(" is a tet mesh, which 'tetwright simplify' and 'tetwright improve' take; ")
              .append(read));
    const std::string extension = std::filesystem::path(file).extension().string();
    const std::string what = extension.empty() ? "no extension" : "unknown extension '" + extension + "'";
    throw UsageError(std::string(file).append(": ").append(what).append("; ").append(read));
  }
}

/// Whether the input is a segmented volume, which must then be the only one, since it names all materials.
/// What a .vdb file holds is known only once it has been read: its labels are put into `vdb_labels`.
bool is_volume(const CommandRun& run, std::optional<LabelVolume>& vdb_labels) {
  const CommandLine& line = run.line;
  const std::vector<std::string> inputs = input_files(line);
  bool volume = std::any_of(inputs.begin(), inputs.end(),
                            [&](auto& f) { return input_kind(run, f) == FileKind::volume; });
  for (const std::string& file : line.inputs) {
    if (is_object(run, file) || !is_vdb(file)) continue;
    vdb_labels = read_label_grid(file);
    volume |= vdb_labels.has_value();
  }
  if (!volume) {
    if (!line.labels.empty() || !line.label_names.empty() || line.outside_label_given ||
        line.min_voxels_given)
      throw UsageError(
          "--labels, --label-names, --outside-label and --min-voxels are for segmented volumes, and no "
          "input is one");
    return false;
  }
  if (inputs.size() > 1 || line.inputs.empty())
    throw UsageError("a segmented volume must be the only input; leave out the others");
  if (!line.layers.empty()) throw UsageError("--layer is for surfaces, and the input is a segmented volume");
  if (line.max_refinement || line.min_gap.value > 0 || line.min_thickness.value > 0)
    throw UsageError(
        "--max-refinement, --min-gap and --min-thickness are for surfaces, and the input is a segmented "
        "volume");
  if (line.feature_angle.rule != FeatureAngle::Rule::automatic)
    throw UsageError("--feature-angle is for surfaces and tet meshes, and the input is a segmented volume");
  if (line.split_solids)
    throw UsageError("--split-solids is for surfaces, and the input is a segmented volume");
  if (line.nested != NestedRule::automatic)
    throw UsageError("--nested is for surfaces, and the input is a segmented volume");
  return true;
}

LabelChoice label_choice(const CommandLine& line) {
  LabelChoice choice;
  choice.labels = line.labels;
  choice.outside_label = line.outside_label;
  choice.min_voxels = line.min_voxels;
  if (!line.label_names.empty()) {
    choice.names = read_label_names(line.label_names, &choice.name_lines);
    choice.names_file = line.label_names;
  }
  return choice;
}

/// Those of the file itself. No two labels have one name there, nor that of the outside.
void take_names(const LabelVolume& volume, LabelChoice& choice) {
  UniqueNames unique(printable_name);
  (void)unique.add("outside");
  for (const auto& [tag, name] : volume.names)
    if (tag != choice.outside_label) choice.names[tag] = unique.add(name);
}

LabelInput read_labels(std::optional<LabelVolume> vdb_labels, CommandRun& run) {
  const std::string& file = run.line.inputs.front();
  LabelChoice choice = label_choice(run.line);  // before the volume, which takes longer to read
  LabelVolume volume = vdb_labels ? std::move(*vdb_labels) : take_label_volume(run, file);
  if (run.line.label_names.empty()) take_names(volume, choice);
  run.report.material_colours = volume.colours;
  LabelInput labels = make_label_input(std::move(volume), file, choice, &run.progress);
  run.report.findings = labels.findings;
  run.report.volume.emplace(labels);
  return labels;
}

/// The level set of a --material option.
TriangleMesh read_one_level_set(const NamedValue& material) {
  std::vector<NamedSurface> level_sets = read_level_sets(material.value);
  if (level_sets.size() > 1)
    throw InputError(material.value, 0,
                     "holds " + std::to_string(level_sets.size()) + " level sets, but --material " +
                         material.name +
                         " is one; give the file as an input, and its grids name the materials");
  return std::move(level_sets[0].surface);
}

/// One material for each surface and level set, or with --split-solids for each solid of a surface, with tags
/// from 1 in the order of the call.
std::vector<MaterialSurface> read_material_surfaces(CommandRun& run) {
  const CommandLine& line = run.line;
  RunReport& report = run.report;
  std::vector<MaterialSurface> surfaces;
  const auto add = [&](const std::string& name, const std::string& file, TriangleMesh surface) {
    surfaces.push_back({name, static_cast<MaterialTag>(surfaces.size() + 1), std::move(surface), file});
  };
  const auto count = [&](TriangleMesh surface) {
    report.input_triangles += surface.triangles.size();
    report.input_points += surface.points.size();
    return surface;
  };
  const auto read = [&](const std::string& file) {
    std::vector<Dropped> dropped;
    TriangleMesh surface = take_surface(run, file, &dropped);
    report_dropped(dropped, file, report);
    return count(std::move(surface));
  };
  bool split = false;
  for (const std::string& file : line.inputs) {
    if (!is_object(run, file) && is_vdb(file)) {
      for (NamedSurface& s : read_level_sets(file))
        add(s.name.empty() ? file_stem(file) : s.name, file, count(std::move(s.surface)));
    } else if (line.split_solids) {
      std::vector<NamedSurface> solids = split_solids(read(file), material_name_of(run, file));
      split |= solids.size() > 1;
      for (NamedSurface& s : solids)
        add(s.name, solids.size() > 1 ? file + ", '" + s.name + "'" : file, std::move(s.surface));
    } else {
      add(material_name_of(run, file), file, read(file));
    }
  }
  if (line.split_solids && !split)
    throw InputError(line.inputs.empty() ? line.materials.front().value : line.inputs.front(), 0,
                     "--split-solids finds no solids, groups or labels that tell its parts apart; leave the "
                     "option out (it does not split what --material names)");
  for (const NamedValue& m : line.materials)
    add(m.name, m.value,
        !is_object(run, m.value) && is_vdb(m.value) ? count(read_one_level_set(m)) : read(m.value));
  return surfaces;
}

MesherInput read_surfaces(CommandRun& run) {
  std::vector<MaterialSurface> surfaces = read_material_surfaces(run);
  std::vector<MaterialLayer> layers;
  for (const NamedValue& l : run.line.layers)
    layers.push_back(
        {l.name, static_cast<MaterialTag>(surfaces.size() + layers.size() + 1), std::stod(l.value)});
  run.progress.throw_if_stopped();
  MesherInput input = make_mesher_input(std::move(surfaces), std::move(layers), run.line.nested);
  run.report.findings.insert(run.report.findings.end(), input.findings.begin(), input.findings.end());
  run.report.patches = patches_of_input(input);
  return input;
}

/// The options that do not depend on the kind of input.
MesherOptions common_options(const CommandLine& line) {
  MesherOptions options;
  options.voxel_size = line.voxel_size;
  options.uniform = line.uniform;
  options.adaptivity = line.adaptivity;
  options.keep_outside = line.keep_outside;
  options.feature_angle = line.feature_angle;
  if (line.resolution) options.resolution = line.resolution;
  // Measured: the simplifier's tets with all that belongs to them; the text of a file, which is held in
  // memory beside the mesh.
  constexpr double simplifier_bytes = 110, text_bytes = 130;
  if (line.command == Command::prepare)
    options.later_bytes_per_tet = simplifier_bytes;
  else if (!line.output.ends_with(".vtu"))
    options.later_bytes_per_tet = text_bytes;
  return options;
}

/// Makes cells that nobody asked for larger until memory holds what they take, by estimate.
template <class Input>
void fit_memory(const Input& input, MesherOptions& options, CommandRun& run) {
  constexpr double growth = 1.25;
  constexpr double estimate_margin = 1.25;      // estimates are mostly within this
  constexpr double min_fitted_resolution = 16;  // fewer cells show nothing of a body
  const double available = available_memory() / estimate_margin;
  const MesherEstimate wanted = estimate_mesh(input, options);
  if (static_cast<double>(wanted.bytes) <= available) return;
  const auto cell = [&](const MesherOptions& o) {
    return o.voxel_size > 0 ? o.voxel_size : longest_side(input) / o.resolution;
  };
  MesherOptions larger = options;
  do {
    if (options.voxel_size > 0)
      larger.voxel_size *= growth;
    else
      larger.resolution = static_cast<int>(larger.resolution / growth);
    if (longest_side(input) / cell(larger) < min_fitted_resolution) return;  // refused with its numbers
  } while (static_cast<double>(estimate_mesh(input, larger).bytes) > available);
  run.report.coarser = {cell(options), cell(larger), static_cast<double>(wanted.bytes)};
  options = larger;
}

DenseMesh mesh_input(const MesherInput& surfaces, CommandRun& run) {
  const CommandLine& line = run.line;
  MesherOptions options = common_options(line);
  if (line.uniform && line.max_refinement.value_or(0) > 0)
    throw UsageError("--uniform has cells of one size; leave out --max-refinement, or --uniform");
  if (!line.layers.empty() && line.min_thickness.value > 0)
    throw UsageError(
        "--min-thickness leaves out walls of surfaces without layers; leave out --layer, or --min-thickness");
  const double diagonal = (surfaces.high - surfaces.low).norm();
  read_sizes(run, {surfaces.low, surfaces.high});
  for (const MesherInput::Body& body : surfaces.bodies) require_sizes_at(run, body.surface.points);
  options.max_refinement = line.max_refinement;
  options.min_gap = line.min_gap.in_input_units(diagonal);
  options.min_thickness = line.min_thickness.in_input_units(diagonal);
  const bool choose = !line.resolution && line.voxel_size == 0;
  const bool prepares = line.command == Command::prepare;
  if (choose && line.target_tets > 0)
    options.resolution = resolution_for_target(surfaces, line.target_tets, line.feature_angle);
  if (choose && prepares)
    choose_cells_for_sizes(surfaces, run.report.sizes.target_length.get(), run.report.sizes.limits.max_edge,
                           options);
  if (choose) fit_memory(surfaces, options, run);
  if (line.tolerance.value == 0) return mesh_surfaces(surfaces, options, &run.progress);
  run.report.tolerance = tolerance_of(line, diagonal);
  if (!choose) return mesh_surfaces(surfaces, options, &run.progress);
  const RequestedSizes& sizes = run.report.sizes;
  if (line.target_tets == 0 && !sizes.target_length && !std::isfinite(sizes.limits.max_edge))
    options.resolution = 0;
  return mesh_within(surfaces, options, run.report.tolerance, &run.progress);
}

Box3 box_of(const LabelInput& labels) {
  Box3 box;
  for (int k = 0; k < 8; ++k) {
    const Vec3 corner((k & 1) * labels.size[0], (k >> 1 & 1) * labels.size[1], (k >> 2) * labels.size[2]);
    // Voxels reach half a spacing beyond their centres.
    box.add(labels.origin + labels.directions * (corner - Vec3::Constant(0.5)));
  }
  return box;
}

DenseMesh mesh_input(const LabelInput& labels, CommandRun& run) {
  const CommandLine& line = run.line;
  MesherOptions options = common_options(line);
  if (!line.resolution && line.voxel_size == 0)
    options.voxel_size = line.command == Command::prepare && line.target_tets > 0
                             ? cell_size_for_target(labels, line.target_tets, options)
                             : default_cell_size(labels);
  if (!line.resolution && line.voxel_size == 0) fit_memory(labels, options, run);
  read_sizes(run, box_of(labels));
  if (line.tolerance.value > 0 && line.command == Command::mesh)
    throw UsageError(
        "--tolerance of 'mesh' is for surfaces: the dense mesh of a volume is what 'prepare --tolerance' "
        "keeps "
        "near");
  DenseMesh dense = mesh_labels(labels, options, &run.progress);
  if (line.tolerance.value > 0) run.report.tolerance = tolerance_of(line, diagonal_of(dense.mesh));
  return dense;
}

/// The points of tets that are not of the outside.
std::vector<Vec3> inner_points(const TetMesh& mesh) {
  std::vector<std::uint8_t> used(mesh.points.size(), 0);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    if (mesh.materials[t] != outside_tag)
      for (const Index p : mesh.tets[t]) used[p] = 1;
  std::vector<Vec3> points;
  for (std::size_t p = 0; p < used.size(); ++p)
    if (used[p]) points.push_back(mesh.points[p]);
  return points;
}

}  // namespace

bool is_vdb(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension == ".vdb";
}

ScanInput read_scan(CommandRun& run) {
  const Stopwatch watch;
  run.progress.begin_stage("read");
  check_input_kinds(run);
  std::optional<LabelVolume> vdb_labels;
  ScanInput input = is_volume(run, vdb_labels) ? ScanInput(read_labels(std::move(vdb_labels), run))
                                               : ScanInput(read_surfaces(run));
  run.report.seconds_read = watch.seconds();
  return input;
}

DenseMesh make_dense_mesh(ScanInput input, CommandRun& run) {
  const Stopwatch watch;
  DenseMesh dense = std::visit([&](const auto& scan) { return mesh_input(scan, run); }, input);
  if (run.line.command == Command::mesh) {
    if (run.line.order < 2) dense.reference.reset();
    if (run.line.write_sdf.empty()) dense.field.reset();
  }
  // The outside has the sizes of the nearest place where the field has none.
  require_sizes_at(run, run.line.keep_outside ? inner_points(dense.mesh) : dense.mesh.points);
  run.report.features = dense.report.features;
  run.report.creases = std::move(dense.report.creases);
  run.report.mesher = std::move(dense.report);
  run.report.seconds_mesh = watch.seconds();
  // What comparing and writing that mesh take of the time it took to make it: 5 s of 20 (4.3 million tets of
  // dragon_vrip_res2.ply, --resolution 200).
  constexpr double finishing_share = 0.25;
  run.reserve_time(finishing_share * run.report.seconds_mesh);
  input = {};  // gigabytes of a large volume
  run.report.dense = mesh_statistics(dense.mesh, run.line.min_solid_angle);
  return dense;
}

}  // namespace tetwright
