// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "mesher/images/material_image.h"
#include "mesher/labels/label_bricks.h"
#include "mesher/labels/label_faces.h"
#include "mesher/labels/label_field.h"
#include "mesher/labels/label_thickness.h"
#include "mesher/mesh_estimate.h"
#include "mesher/tuning/estimate_tuning.h"
#include "mesher/tuning/label_tuning.h"

namespace tetwright {

namespace {

/// Number of dense tets as a fraction of their number with finest cells everywhere.
/// \param cell size of a cell, voxels; the interface of labels curves on the scale of voxels
double coarse_share(double cell, double adaptivity) {
  if (!(adaptivity > 0)) return 1;
  return share_of_coarse_cells(std::max(0.0, 1 - cell / EstimateTuning::Adaptivity::largest_with_coarse),
                               std::max(0.0, 1 - cell / EstimateTuning::Adaptivity::largest_with_coarsest));
}

/// \param cell edge of a finest cell, input units
MemoryModel memory_of(const LabelInput& labels, double cell, const FaceAreas& areas) {
  constexpr double brick_voxels = LabelBricks::cells * LabelBricks::cells * LabelBricks::cells;
  const auto voxels = static_cast<double>(labels.voxel_count());
  const double regions =
      static_cast<double>(labels.regions.bytes()) + (labels.image ? labels.image->bytes() : 0);
  double distances = EstimateTuning::Memory::per_label_face * areas.faces +
                     sizeof(LabelBricks::Brick) / brick_voxels * voxels;
  if (needs_depths(labels, cell)) distances += voxels;
  const double thin = thin_search_bytes(labels);
  return {EstimateTuning::Memory::per_label_lattice_tet, regions + distances,
          regions + std::max(thin, distances)};
}

}  // namespace

MesherEstimate estimate_mesh(const LabelInput& labels, const MesherOptions& options) {
  const GridFrame frame = label_frame(labels, cell_size(labels, options), options.uniform);
  if (options.uniform) return estimate_mesh(labels, options, ThinCells());
  RefinementRegions finer = find_thin_labels(labels, frame, nullptr).finer;
  const ThinCells all = count_thin_cells(labels, frame, finer);
  for (std::size_t level = 0; level < finer.cells.size(); ++level)
    if (std::ldexp(1.0, static_cast<int>(level) - finer.refinement) <= largest_redundant_cell(labels, frame))
      finer.cells[level].clear();
  ThinCells kept = count_thin_cells(labels, frame, finer);
  // Which of the others are redundant is known only once there is a field.
  kept.inside += EstimateTuning::Labels::kept_thin_cells * (all.inside - kept.inside);
  kept.outside += EstimateTuning::Labels::kept_thin_cells * (all.outside - kept.outside);
  return estimate_mesh(labels, options, kept);
}

MesherEstimate estimate_mesh(const LabelInput& labels, const MesherOptions& options, const ThinCells& thin) {
  const double h = cell_size(labels, options);
  const FaceAreas areas = face_areas(labels);
  const double all = static_cast<double>(labels.voxel_count());
  const double voxel = std::abs(labels.directions.determinant());
  double inside = 0;
  for (const LabelMaterial& m : labels.materials) inside += static_cast<double>(m.voxels);
  const double meshed = voxel * (options.keep_outside ? all : inside) / (h * h * h);
  const double outer = areas.outer / (h * h), inner = areas.inner / (h * h);
  const double sides = 2 * inner + (options.keep_outside ? 2 : 1) * outer;
  MeshSize size;
  if (options.uniform) {
    size.leaves = voxel * all / (h * h * h);
    size.dense =
        EstimateTuning::Uniform::tets_per_cell * meshed + EstimateTuning::Labels::tets_per_outer_face * outer;
    size.lattice = size.dense + EstimateTuning::Labels::outside_tets_per_face * outer;
  } else {
    const double cell = h / voxel_size(labels);
    const double share =
        (cell < EstimateTuning::Labels::small_cell ? EstimateTuning::Labels::smooth_share : 1) *
        coarse_share(cell, options.adaptivity);
    size.dense = share * EstimateTuning::Labels::tets_per_face_side * sides /
                     (1 + EstimateTuning::Labels::half_full_thickness * sides / meshed) +
                 EstimateTuning::Labels::dense_per_thin_cell * thin.inside;
    size.lattice = size.dense;
    if (!options.keep_outside)
      size.lattice += share * EstimateTuning::Labels::outside_tets_per_face * outer +
                      EstimateTuning::Labels::lattice_per_thin_cell_outside * thin.outside;
  }
  return estimate_of(size, memory_of(labels, h, areas), options);
}

MemoryModel label_memory(const LabelInput& labels, double cell) {
  return memory_of(labels, cell, face_areas(labels));
}

}  // namespace tetwright
