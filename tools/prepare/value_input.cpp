// SPDX-License-Identifier: Apache-2.0
#include "tools/prepare/value_input.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <variant>

#include "common/images/grid_box.h"
#include "common/message_text.h"
#include "tetwright/error.h"
#include "tetwright/io.h"
#include "tetwright/resources.h"
#include "tools/prepare/surface_spaces.h"
#include "tools/prepare/value_rules.h"

namespace tetwright {

namespace {

/// Brings a grid into the space of the mesh, and reports what was done.
/// \param what "image" or "mask"
void adapt_space(LabelGrid& grid, const std::string& file, const std::string& what, PrepareRun& run) {
  PrepareReport& report = run.report;
  const bool of_tets = run.task != Task::prepare && run.task != Task::mesh;
  const std::string of_mesh = report.space_of_result(), before = grid.space;
  if (before == of_mesh) return;
  const bool converted = change_space(grid, of_mesh);
  report.diagnostics.push_back(
      {.code = converted ? DiagnosticCode::space_converted : DiagnosticCode::space_unknown,
       .file = file,
       .what = what + " in another space, " + (before.empty() ? "unknown" : before),
       .count = 1,
       .done = converted ? "brought into that of the mesh, " + of_mesh
                         : "taken as it is, since it cannot be compared with that of the mesh, " +
                               (!of_mesh.empty() ? of_mesh
                                : of_tets        ? std::string("unknown") + mesh_space_hint
                                                 : std::string("unknown"))});
}

double bytes_of(const ImageVolume& image) {
  double bytes = 0;
  for (const std::vector<float>& channel : image.channels)
    bytes += static_cast<double>(channel.size()) * sizeof(float);
  return bytes;
}

double bytes_of(const LabelVolume& labels) {
  return static_cast<double>(labels.labels.size()) * sizeof(MaterialTag);
}

/// Memory of an ImageMask.
void require_mask_memory(const LabelGrid& image, const std::string& file) {
  require_memory(static_cast<double>(image.voxels()) * sizeof(std::uint32_t), "the mask of the image " + file,
                 "crop the image or make it coarser");
}

/// Sets a field, in place of one with this name.
void set_field(std::vector<MeshField>& fields, MeshField field, const char* kind, const std::string& by,
               PrepareReport& report) {
  if (std::erase_if(fields, [&](const MeshField& f) { return f.name == field.name; }) > 0)
    report.diagnostics.push_back({.code = DiagnosticCode::input_dropped,
                                  .file = report.inputs.front(),
                                  .what = std::string(kind) + " field '" + field.name + "'",
                                  .count = 1,
                                  .done = "replaced by " + by});
  fields.push_back(std::move(field));
}

ValueReport report_of(const ValueImage& image, const ImageValues& values, const TetMesh& mesh) {
  ValueReport report;
  report.name = image.name;
  report.file = image.file;
  report.lowest = values.lowest;
  report.highest = values.highest;
  report.partly_outside = values.partly_outside;
  report.nearest = values.nearest;
  report.nearest_points = values.nearest_points;
  report.not_finite = values.not_finite;
  const auto [smallest, largest] = std::minmax_element(values.mean.begin(), values.mean.end());
  report.smallest = *smallest;
  report.largest = *largest;
  double volume = 0, sum = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const Vec3& a = mesh.points[mesh.tets[t][0]];
    const auto edge = [&](std::size_t i) { return Vec3(mesh.points[mesh.tets[t][i]] - a); };
    const double six = std::abs(edge(1).cross(edge(2)).dot(edge(3)));
    volume += six;
    sum += six * values.mean[t];
  }
  report.mean = volume > 0 ? sum / volume : report.smallest;
  return report;
}

void report_findings(const ValueReport& found, const std::string& counting, PrepareReport& report) {
  const auto add = [&](DiagnosticCode code, const char* what, const FoundPlaces& places, std::string done) {
    if (places.count > 0)
      report.diagnostics.push_back({.code = code,
                                    .file = found.file,
                                    .what = what,
                                    .count = places.count,
                                    .done = std::move(done),
                                    .places = {places.first}});
  };
  if (found.not_finite > 0)
    report.diagnostics.push_back({.code = DiagnosticCode::values_not_finite,
                                  .file = found.file,
                                  .what = "voxels that are not finite",
                                  .count = found.not_finite,
                                  .done = "they do not count"});
  add(DiagnosticCode::values_outside, "tets with a part outside the image", found.partly_outside,
      "this part does not count");
  add(DiagnosticCode::values_nearest, "tets without a voxel that counts", found.nearest,
      "they have the value of the nearest one" + counting);
  add(DiagnosticCode::values_nearest, "points without a voxel that counts", found.nearest_points,
      "they have the value of the nearest one" + counting);
}

}  // namespace

/// Notes a spacing that the file does not give.
void report_spacing(const LabelGrid& grid, const std::string& file, PrepareReport& report) {
  if (grid.spacing_assumed)
    report.diagnostics.push_back({.code = DiagnosticCode::spacing_assumed,
                                  .file = file,
                                  .what = "volume whose file gives no spacing",
                                  .count = 1,
                                  .done = "each voxel has the size 1"});
  if (grid.spacing_replaced)
    report.diagnostics.push_back({.code = DiagnosticCode::spacing_replaced,
                                  .file = file,
                                  .what = "volume whose file gives another spacing",
                                  .count = 1,
                                  .done = "that of --spacing is used"});
}

ValueInputs read_value_inputs(PrepareRun& run) {
  const ValueOptions& options = run.options.values;
  ValueInputs inputs;
  if (options.images.empty()) return inputs;
  run.progress.begin_stage("read images");
  for (const ValueImage& image : options.images) {
    inputs.images.push_back(
        image.image ? image.image
                    : std::make_shared<const ImageVolume>(read_image(image.file, run.options.volume_file)));
    run.held.add(bytes_of(*inputs.images.back()));
    report_spacing(*inputs.images.back(), image.file, run.report);
    run.progress.throw_if_stopped();
    if (const std::size_t channels = inputs.images.back()->channels.size(); channels != 1)
      throw InputError(image.file, 0,
                       "has " + std::to_string(channels) +
                           " channels, and values are taken from images of one; save the channel alone");
  }
  if (!options.mask_file.empty())
    inputs.mask = options.mask ? options.mask
                               : std::make_shared<const LabelVolume>(
                                     read_label_volume(options.mask_file, run.options.volume_file));
  if (inputs.mask) run.held.add(bytes_of(*inputs.mask));
  if (inputs.mask && std::all_of(inputs.mask->labels.begin(), inputs.mask->labels.end(),
                                 [](MaterialTag label) { return label == 0; }))
    throw InputError(options.mask_file, 0,
                     "has no voxel other than 0, so that no voxel of an image counts; give another "
                     "--values-mask, or leave it out");
  return inputs;
}

void check_images_meet(const ValueInputs& inputs, const Box3& box, const std::vector<MaterialTag>& materials,
                       const PrepareRun& run) {
  const ValueOptions& options = run.options.values;
  for (std::size_t i = 0; i < inputs.images.size(); ++i) {
    const std::string& file = options.images[i].file;
    LabelGrid grid = *inputs.images[i];
    (void)change_space(grid, run.report.space_of_result());
    check_image_meets(grid, box.low, box.high, file, run.report.inputs.front());
    ImageMask mask;
    if (options.own_label || inputs.mask) require_mask_memory(grid, file);
    if (options.own_label && run.value_labels) {
      mask = ImageMask::own_label(grid, *run.value_labels);
    } else if (inputs.mask) {
      LabelVolume adapted;
      const bool same = inputs.mask->space == run.report.space_of_result();
      if (!same) {
        adapted = *inputs.mask;
        (void)change_space(adapted, run.report.space_of_result());
      }
      mask = ImageMask::nonzero(grid, same ? *inputs.mask : adapted);
    }
    const CountedVoxels counted = counted_voxels(*inputs.images[i], mask, materials);
    if (counted.count == 0) throw_no_voxel_counts(file);
    for (const ValueBins& bins : options.bins)
      if (bins.modulus && bins.of == options.images[i].name)
        check_modulus(*bins.modulus, bins.of, counted, run.progress);
  }
}

Box3 box_of_scan(const ScanInput& input) {
  Box3 box;
  if (const auto* surfaces = std::get_if<MesherInput>(&input)) {
    for (const MesherInput::Body& body : surfaces->bodies)
      for (const Vec3& p : body.surface.points) box.add(p);
    return box;
  }
  const auto* implanted = std::get_if<ImplantedVolume>(&input);
  const LabelInput& labels = implanted ? implanted->labels : std::get<LabelInput>(input);
  return box_of_voxels(labels.size, labels.origin, labels.directions);
}

std::vector<MaterialTag> materials_of_scan(const ScanInput& input) {
  std::vector<MaterialTag> tags;
  if (const auto* labels = std::get_if<LabelInput>(&input))
    for (const auto& material : labels->materials) tags.push_back(material.tag);
  if (const auto* implanted = std::get_if<ImplantedVolume>(&input))
    for (const auto& material : implanted->labels.materials) tags.push_back(material.tag);
  return tags;
}

std::shared_ptr<const LabelVolume> copy_labels(const LabelSource& source) {
  auto copy = std::make_shared<LabelVolume>();
  static_cast<LabelGrid&>(*copy) = source.grid();
  require_memory(static_cast<double>(source.grid().voxels()) * sizeof(MaterialTag),
                 "the labels for --values-mask labels", "crop the volume, or make it coarser");
  copy->labels.resize(source.grid().voxels());
  const auto slice = static_cast<std::size_t>(copy->size[0]) * static_cast<std::size_t>(copy->size[1]);
  const int step = std::max(1, source.block()[2]);
  for (int z = 0; z < copy->size[2]; z += step) {
    const int end = std::min(z + step, copy->size[2]);
    source.read({0, 0, z}, {copy->size[0], copy->size[1], end},
                std::span(copy->labels)
                    .subspan(static_cast<std::size_t>(z) * slice, static_cast<std::size_t>(end - z) * slice));
  }
  return copy;
}

void take_values(ValueInputs inputs, Prepared& result, PrepareRun& run) {
  const ValueOptions& options = run.options.values;
  PrepareReport& report = run.report;
  TetMesh& mesh = result.mesh;
  if (options.images.empty()) return;
  if (run.task == Task::values) check_field_names(mesh, run);
  result.bins.resize(options.bins.size());
  std::shared_ptr<const LabelVolume> mask = options.own_label ? run.value_labels : inputs.mask;
  if (mask && !options.own_label && mask->space != report.space_of_result()) {
    auto adapted = std::make_shared<LabelVolume>(*mask);
    adapt_space(*adapted, options.mask_file, "mask", run);
    mask = adapted;
  }
  const std::string counting = options.own_label ? " of their material" : mask ? " of the mask" : "";
  for (std::size_t i = 0; i < options.images.size(); ++i) {
    const ValueImage& from = options.images[i];
    run.progress.begin_stage("values");
    std::shared_ptr<const ImageVolume> image = std::move(inputs.images[i]);
    if (image->space != report.space_of_result()) {
      // Only the grid changes, but it belongs to the caller.
      auto adapted = image.use_count() == 1 ? std::const_pointer_cast<ImageVolume>(image)
                                            : std::make_shared<ImageVolume>(*image);
      adapt_space(*adapted, from.file, "image", run);
      image = adapted;
    }
    if (mask) require_mask_memory(*image, from.file);
    const ImageMask counts = !mask               ? ImageMask()
                             : options.own_label ? ImageMask::own_label(*image, *mask)
                                                 : ImageMask::nonzero(*image, *mask);
    ImageValues values =
        image_values(mesh, *image, counts, {0, options.minimum, options.maximum, options.deviation},
                     from.file, report.inputs.front(), &run.progress);
    report.values.push_back(report_of(from, values, mesh));
    report_findings(report.values.back(), counting, report);
    for (std::size_t b = 0; b < options.bins.size(); ++b)
      if (options.bins[b].of == from.name)
        result.bins[b] = bin_tets(mesh, from.name, values.mean, options.bins[b].rule);
    const std::string of_image = "the values of " + from.file;
    const auto set_cells = [&](const char* suffix, std::vector<double>& of_tets) {
      if (!of_tets.empty())
        set_field(mesh.cell_fields, {from.name + suffix, 1, false, std::move(of_tets)}, "cell", of_image,
                  report);
    };
    set_cells("", values.mean);
    set_cells("_min", values.minimum);
    set_cells("_max", values.maximum);
    set_cells("_deviation", values.deviation);
    set_field(mesh.point_fields, {from.name, 1, false, std::move(values.at_points)}, "point", of_image,
              report);
    for (const TetBins& bins : result.bins)
      if (bins.field == from.name)
        set_field(mesh.cell_fields, field_of_bins(bins), "cell", "the bins of " + from.file, report);
  }
  name_apart(mesh, result.bins);
  for (std::size_t b = 0; b < options.bins.size(); ++b)
    if (options.bins[b].modulus) set_moduli(*options.bins[b].modulus, result.bins[b]);
  report.bins = result.bins;
  for (BinsReport& bins : report.bins) bins.of_tets = {};
  decide_severities(run.options.acceptance, report);
}

}  // namespace tetwright
