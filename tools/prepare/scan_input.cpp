// SPDX-License-Identifier: Apache-2.0
#include "tetwright/prepare_steps.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include "common/lower_case.h"
#include "common/unique_names.h"
#include "common/utf8.h"
#include "mesher/input/qualified_names.h"
#include "tetwright/compare.h"
#include "tetwright/error.h"
#include "tetwright/io.h"
#include "tetwright/mesher_input.h"
#include "tools/prepare/image_input.h"
#include "tools/prepare/implant_input.h"
#include "tools/prepare/mask_input.h"
#include "tools/prepare/surface_spaces.h"
#include "tools/prepare/value_input.h"

namespace tetwright {

namespace {

/// Rejects files whose extension shows that they are not scans.
void check_input_kinds(const std::vector<Input>& inputs, Task task) {
  for (const Input& input : inputs) {
    const std::string& file = input.name;
    const FileKind kind = input.kind();
    if (kind == FileKind::surface || kind == FileKind::volume || is_vdb(file) ||
        may_hold_surface(input.typed_name()))
      continue;
    std::string read = name_of(task);
    read.append(" reads surfaces (").append(known_extensions(FileKind::surface));
    read.append("), level sets (.vdb) and segmented volumes (").append(known_extensions(FileKind::volume));
    read.append(" .vdb)");
    if (kind == FileKind::tet_mesh)
      throw UsageError(
          std::string(file)
              .append(" is a tet mesh, which 'tetwright simplify' and 'tetwright improve' read; ")
              .append(read));
    const std::string extension = std::filesystem::path(file).extension().string();
    const std::string what = extension.empty() ? "no extension" : "unknown extension '" + extension + "'";
    throw UsageError(std::string(file).append(": ").append(what).append("; ").append(read));
  }
}

/// Rejects facts about files of volumes if there is no such file.
void check_volume_file(const std::vector<Input>& inputs, const VolumeFileOptions& options, bool volume) {
  check_volume_options(options);
  const bool file = volume && std::any_of(inputs.begin(), inputs.end(), [](const Input& input) {
                      return !input.is_value() && !input.is_vdb_file();
                    });
  if (options.spacing && !file)
    throw UsageError("--spacing is for volumes in files other than .vdb, and no input is one");
  const bool raw = file && std::any_of(inputs.begin(), inputs.end(), [](const Input& input) {
                     return !input.is_value() && lower_case(input.typed_name()).ends_with(".raw");
                   });
  if ((options.dimensions || !options.voxel_type.empty()) && !raw)
    throw UsageError(
        "--dimensions and --voxel-type are for files of voxels alone (.raw), and no input is one");
}

/// Rejects options for surfaces if there are none.
void check_body_options(const PrepareOptions& options) {
  const CellOptions& cells = options.cells;
  const BodyOptions& bodies = options.bodies;
  if (cells.max_refinement || cells.min_gap || cells.min_thickness)
    throw UsageError(
        "--max-refinement, --min-gap and --min-thickness are for surfaces, and the input is a segmented "
        "volume");
  if (options.feature_angle.rule != FeatureAngle::Rule::automatic)
    throw UsageError("--feature-angle is for surfaces and tet meshes, and the input is a segmented volume");
  if (bodies.split_solids)
    throw UsageError("--split-solids is for surfaces, and the input is a segmented volume");
  if (bodies.nested != NestedRule::automatic)
    throw UsageError("--nested is for surfaces, and the input is a segmented volume");
  if (bodies.contact_tolerance)
    throw UsageError("--contact-tolerance is for surfaces, and the input is a segmented volume");
  if (bodies.regions.rule != RegionRule::cells || !bodies.regions.seeds.empty())
    throw UsageError(
        "--regions and --region are for surfaces, and the input is a segmented volume; --label-names names "
        "its labels");
  if (!bodies.caps.empty()) throw UsageError("--cap is for surfaces, and the input is a segmented volume");
  if (bodies.base || bodies.thickness)
    throw UsageError("--base and --thicken are for surfaces, and the input is a segmented volume");
  if (!bodies.surface_space.empty() && !options.sizes.field)
    throw UsageError("--surface-space is for surfaces and size fields, and the input is a segmented volume");
  if (options.labels.protects_any())
    throw UsageError("--protect-labels is for surfaces in a segmented volume, and there is no surface");
}

/// The volumes and surfaces among the inputs.
struct InputKinds {
  bool volume = false;
  std::vector<Input> implants;  ///< surfaces in a volume, taken from the inputs
  std::optional<LabelVolume> vdb_labels;
};

/// Tells segmented volumes, several masks, images and surfaces apart. The kind of a .vdb file is known only
/// after reading.
InputKinds find_kinds(std::vector<Input>& inputs, const PrepareOptions& options) {
  InputKinds kinds;
  bool& volume = kinds.volume;
  std::optional<LabelVolume>& vdb_labels = kinds.vdb_labels;
  volume = std::any_of(inputs.begin(), inputs.end(),
                       [](const Input& input) { return input.kind() == FileKind::volume; });
  const Input* label_file = nullptr;
  for (const Input& input : inputs) {
    if (!input.material.empty() || !input.is_vdb_file()) continue;
    std::optional<LabelVolume> found = read_label_grid(input.name);
    if (!found) continue;
    if (volume)
      throw UsageError("a .vdb file of labels and another volume cannot be meshed together; leave out " +
                       input.name + " or the others");
    vdb_labels = std::move(found);
    label_file = &input;
    volume = true;
  }
  const LabelOptions& labels = options.labels;
  if (!volume) {
    check_volume_file(inputs, options.volume_file, volume);
    if (options.values.own_label)
      throw UsageError(
          "--values-mask labels is for segmented volumes, and no input is one; give a volume, --values-mask "
          "FILE");
    if (!labels.meshed.empty() || !labels.names_file.empty() || labels.outside || labels.min_voxels)
      throw UsageError(
          "--labels, --label-names, --outside-label and --min-voxels are for segmented volumes, and no "
          "input is one");
    if (labels.protects_any())
      throw UsageError("--protect-labels is for surfaces in a segmented volume, and no input is a volume");
    if (options.images.any())
      throw UsageError("--iso, --outside-probability and --smooth are for images, and no input is a volume");
    return kinds;
  }
  if (std::any_of(inputs.begin(), inputs.end(),
                  [](const Input& input) { return input.role != Input::Role::body; }))
    throw UsageError("--sheet and --partition are for surfaces, and the input is a segmented volume");
  if (!options.bodies.layers.empty())
    throw UsageError("--layer is for surfaces, and the input is a segmented volume");
  if (vdb_labels && options.images.any())
    throw UsageError("--iso, --outside-probability and --smooth are for images, and " + label_file->name +
                     " holds labels");
  kinds.implants = take_implants(inputs, label_file);
  check_volume_file(inputs, options.volume_file, volume);
  if (!kinds.implants.empty()) return kinds;
  check_body_options(options);
  if (options.bodies.overlap != OverlapRule::later && (vdb_labels || !are_masks(inputs)))
    throw UsageError("--on-overlap is for surfaces and masks, and the input is one segmented volume");
  return kinds;
}

LabelChoice label_choice(const LabelOptions& options) {
  LabelChoice choice;
  choice.labels = options.meshed;
  choice.outside_label = options.outside.value_or(0);
  choice.min_voxels = options.min_voxels.value_or(default_min_voxels);
  if (!options.names_file.empty()) {
    choice.names = read_label_names(options.names_file, &choice.name_lines);
    choice.names_file = options.names_file;
  }
  return choice;
}

/// Uses the names in the volume's file, made unique among labels and different from the outside's name.
void take_names(const LabelGrid& volume, LabelChoice& choice) {
  UniqueNames unique(printable_name);
  (void)unique.add("outside");
  for (const auto& [tag, name] : volume.names)
    if (tag != choice.outside_label) choice.names[tag] = unique.add(name);
}

LabelInput read_labels(std::optional<LabelVolume> in_memory, std::vector<Input>& inputs, PrepareRun& run) {
  // Done before reading the volume, which takes longer.
  LabelChoice choice = label_choice(run.options.labels);
  const bool masks = !in_memory && are_masks(inputs);
  if (masks) in_memory = join_masks(inputs, choice, run);
  std::unique_ptr<const LabelSource> source = in_memory
                                                  ? std::make_unique<MemoryLabelSource>(std::move(*in_memory))
                                                  : take_label_source(inputs.front(), run.seconds_waited);
  if (!masks && run.options.labels.names_file.empty()) take_names(source->grid(), choice);
  run.report.material_colours = source->grid().colours;
  if (run.options.values.own_label) {
    run.value_labels = copy_labels(*source);
    run.held.add(static_cast<double>(run.value_labels->labels.size()) * sizeof(MaterialTag));
  }
  LabelInput labels = make_label_input(std::move(source), run.report.inputs.front(), choice, &run.progress);
  run.report.diagnostics.insert(run.report.diagnostics.end(), labels.findings.begin(), labels.findings.end());
  run.report.volume.emplace(labels);
  return labels;
}

LabelInput read_volume(std::optional<LabelVolume> vdb_labels, std::vector<Input>& inputs, PrepareRun& run) {
  if (vdb_labels) return read_labels(std::move(vdb_labels), inputs, run);
  if (are_images(inputs, run)) return read_images(inputs, run);
  try {
    return read_labels({}, inputs, run);
  } catch (const InputError&) {
    // Readers of labels refuse channels and fractions.
    if (!are_images_after_all(inputs, run.options.labels)) throw;
    return read_images(inputs, run);
  }
}

/// Reads the level set of an input that names its material; there must be only one.
TriangleMesh read_one_level_set(const Input& input) {
  std::vector<NamedSurface> level_sets = read_level_sets(input.name);
  if (level_sets.size() > 1)
    throw InputError(input.name, 0,
                     "holds " + std::to_string(level_sets.size()) + " level sets, but --material " +
                         input.material +
                         " is one; give the file as an input, and its grids name the materials");
  return std::move(level_sets[0].surface);
}

/// A file whose solids are materials.
struct SplitFile {
  NamesOfBody names;
  std::vector<std::size_t> surfaces;  ///< indices of its solids among all surfaces
};

/// Qualifies names of solids that other materials also have.
void name_solids(std::vector<SplitFile> files, const std::vector<Layer>& layers,
                 std::vector<MaterialSurface>& surfaces, std::vector<Diagnostic>& findings) {
  UniqueNames taken([](const std::string& name) { return name; });
  std::vector<bool> solid(surfaces.size(), false);
  std::vector<NamesOfBody> names;
  for (SplitFile& file : files) {
    for (const std::size_t i : file.surfaces) solid[i] = true;
    names.push_back(std::move(file.names));
  }
  for (std::size_t i = 0; i < surfaces.size(); ++i)
    if (!solid[i]) (void)taken.add(surfaces[i].name);
  for (const Layer& layer : layers) (void)taken.add(layer.name);
  qualify_names("names of materials", names, taken, findings);
  for (std::size_t f = 0; f < files.size(); ++f)
    for (const std::size_t i : files[f].surfaces) surfaces[i].name = names[f].names.at(surfaces[i].name);
}

/// Reads one material for each surface and level set, or with --split-solids for each solid of a surface.
/// Tags start at 1, in the order of the inputs.
/// \param volume that the surfaces are in, or null
/// \param sheets receives the inputs that are sheets or partitions
std::vector<MaterialSurface> read_material_surfaces(std::vector<Input>& inputs, const LabelInput* volume,
                                                    std::vector<SheetSurface>& sheets, PrepareRun& run) {
  PrepareReport& report = run.report;
  const bool split_solids_asked = run.options.bodies.split_solids;
  std::vector<MaterialSurface> surfaces;
  const auto add = [&](const std::string& name, const std::string& file, TriangleMesh surface) {
    surfaces.push_back({name, static_cast<MaterialTag>(surfaces.size() + 1), std::move(surface), file});
  };
  SurfaceSpaces spaces(run.options.bodies.surface_space);
  if (volume) spaces.begin_with(volume->space, volume->file);
  const auto take = [&](TriangleMesh surface, const Input& input) {
    spaces.add(surface, input);
    report.input_triangles += surface.triangles.size();
    report.input_points += surface.points.size();
    return surface;
  };
  const auto read = [&](Input& input) {
    std::vector<Dropped> dropped;
    TriangleMesh surface = take_surface(input, &dropped, run.seconds_waited);
    report_dropped(dropped, input.name, report);
    return take(std::move(surface), input);
  };
  std::vector<SplitFile> split;
  for (Input& input : inputs) {
    const std::string& file = input.name;
    if (input.role != Input::Role::body) {
      sheets.push_back({input.material, read(input), file, input.role == Input::Role::partition});
    } else if (!input.material.empty()) {
      add(input.material, file, input.is_vdb_file() ? take(read_one_level_set(input), input) : read(input));
    } else if (input.is_vdb_file()) {
      for (NamedSurface& s : read_level_sets(file))
        add(s.name.empty() ? file_stem(file) : s.name, file, take(std::move(s.surface), input));
    } else if (split_solids_asked) {
      std::vector<NamedSurface> solids = split_solids(read(input), input.material_name());
      if (solids.size() == 1) {
        add(solids[0].name, file, std::move(solids[0].surface));
        continue;
      }
      SplitFile& parts = split.emplace_back(SplitFile{{input.material_name(), file, {}}, {}});
      for (NamedSurface& s : solids) {
        parts.names.names[s.name] = s.name;
        parts.surfaces.push_back(surfaces.size());
        add(s.name, file + ", '" + s.name + "'", std::move(s.surface));
      }
    } else {
      add(input.material_name(), file, read(input));
    }
  }
  if (split_solids_asked && split.empty())
    throw InputError(inputs.front().name, 0,
                     "--split-solids finds no solids, groups or labels that distinguish its parts; leave the "
                     "option out (it does not split what --material names)");
  const std::vector<Diagnostic> findings = spaces.findings();
  report.diagnostics.insert(report.diagnostics.end(), findings.begin(), findings.end());
  report.space = spaces.space();
  name_solids(std::move(split), run.options.bodies.layers, surfaces, report.diagnostics);
  return surfaces;
}

/// Diagonal of the bounding box of all surfaces.
double diagonal_of(const std::vector<MaterialSurface>& surfaces) {
  Eigen::AlignedBox3d box;
  for (const MaterialSurface& s : surfaces)
    for (const Vec3& p : s.surface.points) box.extend(p);
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

/// \param volume that the surfaces are in, or null
MesherInput read_surfaces(std::vector<Input>& inputs, const LabelInput* volume, PrepareRun& run) {
  const BodyOptions& options = run.options.bodies;
  SheetOptions sheets;
  std::vector<MaterialSurface> surfaces = read_material_surfaces(inputs, volume, sheets.surfaces, run);
  std::vector<MaterialLayer> layers;
  for (const Layer& l : options.layers)
    layers.push_back({l.name, static_cast<MaterialTag>(surfaces.size() + layers.size() + 1), l.thickness});
  run.progress.throw_if_stopped();
  ContactOptions contact;
  contact.overlap = options.overlap;
  if (options.contact_tolerance && options.contact_tolerance->percent)
    contact.relative_tolerance = options.contact_tolerance->value / 100;
  else if (options.contact_tolerance)
    contact.tolerance = options.contact_tolerance->value;
  const double diagonal = diagonal_of(surfaces);
  if (options.extend) sheets.extend = options.extend->in_input_units(diagonal);
  CapOptions caps;
  caps.feature_angle = run.options.feature_angle;
  caps.names = options.caps;
  caps.open.base = options.base;
  if (options.thickness) caps.open.thickness = options.thickness->in_input_units(diagonal);
  caps.open.accept_sheets = run.options.acceptance.accept_changes;
  MesherInput input = make_mesher_input(std::move(surfaces), std::move(layers), options.nested, contact,
                                        options.regions, &run.progress, sheets, caps);
  std::vector<Diagnostic>& all = run.report.diagnostics;
  all.insert(all.end(), input.findings.begin(), input.findings.end());
  run.report.patches = patches_of_input(input);
  run.report.contacts = input.contacts;
  run.report.overlaps = input.overlaps;
  return input;
}

}  // namespace

ScanInput read_scan(std::vector<Input> inputs, PrepareRun& run) {
  const Stopwatch watch;
  run.progress.begin_stage("read");
  inputs = with_masks_of_folders(std::move(inputs), run.report);
  check_input_kinds(inputs, run.task);
  for (Input& input : inputs) input.volume_file = run.options.volume_file;
  InputKinds kinds = find_kinds(inputs, run.options);
  const auto read = [&]() -> ScanInput {
    if (!kinds.volume) return read_surfaces(inputs, nullptr, run);
    LabelInput labels = read_volume(std::move(kinds.vdb_labels), inputs, run);
    if (kinds.implants.empty()) return labels;
    MesherInput bodies = read_surfaces(kinds.implants, &labels, run);
    return join_implants(std::move(labels), std::move(bodies), run);
  };
  ScanInput input = read();
  run.report.seconds_read = watch.seconds();
  run.report.loops_read = watch.loops();
  return input;
}

}  // namespace tetwright
