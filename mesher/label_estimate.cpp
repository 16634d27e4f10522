// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "mesher/labels/label_faces.h"
#include "mesher/labels/label_field.h"
#include "mesher/labels/label_thickness.h"
#include "mesher/mesh_estimate.h"

namespace tetwright {

namespace {

/// Dense tets per voxel face (as large as a squared cell) and meshed side of it, see surface_estimate.cpp.
/// Voxel faces have about one and a half times the area of the interface.
constexpr double tets_per_face_side = 21.5, half_full_label_thickness = 0.6;
/// Lattice tets on a side of a face that is not meshed.
constexpr double outside_tets_per_face = 10;
/// Dense tets of uniform cells, per cell and per face to the outside.
constexpr double label_tets_per_cell = 12, tets_per_outer_face = 1;
/// Tets per cell that is split where labels are thin, by whether its centre is in a label.
constexpr double dense_per_thin_cell = 96, lattice_per_thin_cell_outside = 30;
/// Per voxel while the volume is read, bytes: its label in the file and its region.
constexpr double bytes_per_voxel_read = 6;

/// Dense tets as a share of those of finest cells everywhere.
/// \param cell size of a cell, voxels; the interface of labels curves on the scale of voxels
double coarse_share(double cell, double adaptivity) {
  constexpr double largest_with_coarse = 0.1, largest_with_coarsest = 0.025;
  if (!(adaptivity > 0)) return 1;
  return share_of_coarse_cells(std::max(0.0, 1 - cell / largest_with_coarse),
                               std::max(0.0, 1 - cell / largest_with_coarsest));
}

}  // namespace

MesherEstimate estimate_mesh(const LabelInput& labels, const MesherOptions& options) {
  const GridFrame frame = label_frame(labels, cell_size(labels, options), options.uniform);
  if (options.uniform) return estimate_mesh(labels, options, ThinCells());
  return estimate_mesh(labels, options,
                       count_thin_cells(labels, frame, find_thin_labels(labels, frame, nullptr).finer));
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
    size.dense = label_tets_per_cell * meshed + tets_per_outer_face * outer;
    size.lattice = size.dense + outside_tets_per_face * outer;
  } else {
    // Smoothing reduces the area, which only small cells resolve.
    constexpr double small_cell = 0.75, smooth_share = 0.87;
    const double cell = h / voxel_size(labels);
    const double share = (cell < small_cell ? smooth_share : 1) * coarse_share(cell, options.adaptivity);
    size.dense = share * tets_per_face_side * sides / (1 + half_full_label_thickness * sides / meshed) +
                 dense_per_thin_cell * thin.inside;
    size.lattice = size.dense;
    if (!options.keep_outside)
      size.lattice += share * outside_tets_per_face * outer + lattice_per_thin_cell_outside * thin.outside;
  }
  return estimate_of(size, label_memory(labels), options);
}

MemoryModel label_memory(const LabelInput& labels) {
  const auto voxels = static_cast<double>(labels.voxel_count());
  return {label_bytes_per_lattice_tet, bytes_per_voxel * voxels, bytes_per_voxel_read * voxels};
}

}  // namespace tetwright
