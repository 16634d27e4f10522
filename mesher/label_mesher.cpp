// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include "mesher/features/border_creases.h"
#include "mesher/field_mesher.h"
#include "mesher/labels/border_sides.h"
#include "mesher/labels/label_field.h"
#include "mesher/labels/label_thickness.h"
#include "mesher/lattice/redundant_cells.h"
#include "mesher/mesh_estimate.h"
#include "mesher/tuning/cell_tuning.h"
#include "mesher/tuning/domain_tuning.h"
#include "mesher/volume_field.h"
#include "tetwright/error.h"
#include "tetwright/mesher.h"

namespace tetwright {

namespace {

/// Sides of the whole volume, input units.
Vec3 sides(const LabelInput& labels) {
  Vec3 lengths = labels.directions.colwise().norm();
  for (int a = 0; a < 3; ++a) lengths[a] *= labels.size[a];
  return lengths;
}

}  // namespace

double longest_side(const LabelInput& labels) { return sides(labels).maxCoeff(); }

double cell_size(const LabelInput& labels, const MesherOptions& options) {
  const double longest = longest_side(labels);
  const double max_coordinate = labels.origin.cwiseAbs().maxCoeff() + longest;
  const double wanted = finest_cell_size(options, longest, max_coordinate, labels.file);
  MesherOptions smaller = options;
  smaller.voxel_size = std::max({CellTuning::LabelCells::max_side_share * sides(labels).minCoeff(),
                                 CellTuning::LabelCells::min_share_of_wanted * wanted,
                                 longest / DomainTuning::Frames::max_resolution});
  return smaller.voxel_size < wanted ? finest_cell_size(smaller, longest, max_coordinate, labels.file)
                                     : wanted;
}

VolumeField make_volume_field(const LabelInput& labels, const MesherOptions& options, MesherReport& report,
                              Progress* progress, const MesherInput* bodies) {
  report.cell_size = cell_size(labels, options);
  report.resolution = static_cast<int>(std::ceil(longest_side(labels) / report.cell_size - 0.5));
  if (options.keep_outside)
    for (const LabelMaterial& m : labels.materials)
      if (m.tag == outside_tag || m.name == outside_name)
        throw UsageError("the material '" + m.name + "' of tag " + std::to_string(m.tag) +
                         " conflicts with the kept outside; omit --keep-outside or give it "
                         "another name");
  GridFrame voxels = label_frame(labels, report.cell_size, options.uniform);
  if (bodies) voxels = frame_around(*bodies, voxels, labels.file);
  ThinLabels thin;
  if (!options.uniform) thin = find_thin_labels(labels, voxels, progress);
  VolumeField made;
  made.field = LabelField::make(labels, voxels, options.keep_outside, progress);
  drop_redundant_cells(thin.finer, *made.field, thin.island_levels, largest_redundant_cell(labels, voxels),
                       progress);
  report.estimate = estimate_mesh(labels, options, count_thin_cells(labels, voxels, thin.finer));
  for (const ThinPart& p : thin.too_thin)
    report.thin_parts.push_back({p.region == outside_region ? "" : made.field->regions()[p.region].name,
                                 p.places, voxels.to_input(p.first), true});
  if (!options.keep_outside) report.creases = border_creases(labels);
  made.finer = std::move(thin.finer);
  return made;
}

void validate_materials_left(const LabelInput& labels, const std::vector<std::uint8_t>& there) {
  if (std::count(there.begin() + 1, there.end(), 1) == 0)
    throw NothingToMeshError(
        labels.file +
        ": the labels are smaller than a cell; use a higher resolution or a smaller voxel size");
  for (std::size_t r = 1; r < there.size(); ++r)
    if (!there[r])
      throw InputError(
          labels.file, 0,
          "nothing is left of '" + labels.materials[r - 1].name + "' (" +
              std::to_string(labels.materials[r - 1].voxels) +
              " voxels) in cells this large; use a smaller --voxel-size, or merge such islands by a "
              "larger --min-voxels");
}

DenseMesh mesh_labels(const LabelInput& labels, const MesherOptions& options, Progress* progress) {
  MesherReport report;
  Stages stages(progress);
  stages.begin("signed distances");
  // Before the time that the signed distances take.
  validate_estimate(estimate_mesh(labels, options, ThinCells()));
  VolumeField volume = make_volume_field(labels, options, report, progress);
  validate_estimate(report.estimate);
  report.seconds_sdf = stages.seconds();
  report.loops_sdf = stages.loops();

  stages.begin("octree");
  std::vector<MortonKey> interface_voxels = volume.field->interface_voxels();
  DenseMesh dense =
      mesh_field(std::move(volume.field), std::move(interface_voxels), std::move(volume.finer), options,
                 label_memory(labels, cell_size(labels, options)), std::move(report), stages,
                 [&](const std::vector<std::uint8_t>& there) { validate_materials_left(labels, there); })
          .dense;
  dense.mesh.space = labels.space;
  return dense;
}

}  // namespace tetwright
