// SPDX-License-Identifier: Apache-2.0
#include "tools/bricks/brick_estimate.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "mesher/labels/label_faces.h"
#include "mesher/mesh_estimate.h"
#include "mesher/tuning/cell_tuning.h"
#include "tetwright/prepare.h"

namespace tetwright {

namespace {

/// Bytes, fitted to foams of 128^3 and 256^3 voxels in 8 and 64 bricks.
struct PerItem {
  static constexpr double program = 60e6;
  /// A tet of a brick while it is coarsened, and a coarse one while it is simplified.
  static constexpr double tet = 110, coarse_tet = 140;
  /// A lattice tet while points are moved. What is freed afterwards is only partly used for the tets.
  static constexpr double lattice_tet = 50;
  /// A face of the dense surface: with its brick, with its samples and trees in the simplifier, and in a
  /// file.
  static constexpr double kept_face = 60, face = 150, filed_face = 20;
  /// A coarse tet with its brick, and in a file.
  static constexpr double kept_tet = 30, filed_tet = 10;
};

/// Faces of the dense surface, and of a cut through it: for each dense tet, and for each squared cell and
/// density^(2/3).
constexpr double faces_per_tet = 0.1, cut_faces_per_area = 0.6;
/// Tets after coarsening for each final one, and for each face of a cut and side (coarsen()).
constexpr double coarse_per_final = 8, coarse_per_cut_face = 2;

}  // namespace

BrickEstimate estimate_bricks(const LabelInput& labels, const MesherOptions& options, double dense, int side,
                              std::size_t target, bool scratch) {
  const double cell = cell_size(labels, options);
  std::array<double, 3> voxels, cells;
  double cuts = 0, all_cells = 1;
  for (int a = 0; a < 3; ++a) {
    const double spacing = labels.directions.col(a).norm();
    voxels[a] = std::max(1.0, side * cell / spacing);
    cells[a] = labels.size[a] * spacing / cell;
    all_cells *= cells[a];
  }
  for (int a = 0; a < 3; ++a)
    cuts += (std::ceil(cells[a] / side) - 1) * cells[(a + 1) % 3] * cells[(a + 2) % 3];
  const double density = dense / all_cells;
  const double cut_faces = 2 * cuts * cut_faces_per_area * std::pow(density, 2.0 / 3);
  const double coarse =
      std::min(dense, coarse_per_final * static_cast<double>(target) + coarse_per_cut_face * cut_faces);
  const double faces = faces_per_tet * dense;
  const double largest = dense * largest_share_of_faces(labels, voxels);
  const double grown = std::min(dense, largest * std::pow(1 + 2.0 * CellTuning::Bricks::halo / side, 3));
  const double field = PerItem::program + label_memory(labels).beside;
  const double kept = PerItem::kept_tet * coarse + PerItem::kept_face * faces;
  const double making = PerItem::lattice_tet * grown + PerItem::tet * largest;
  BrickEstimate estimate;
  estimate.memory =
      std::max({PerItem::program + label_memory(labels).before, field + (scratch ? 0 : kept) + making,
                field + PerItem::coarse_tet * coarse + PerItem::face * faces});
  estimate.scratch = PerItem::filed_tet * coarse + PerItem::filed_face * faces;
  return estimate;
}

int largest_bricks(const LabelInput& labels, const MesherOptions& options, double dense, std::size_t target,
                   bool scratch, double available) {
  int side = max_brick_cells;
  while (side > min_brick_cells &&
         estimate_bricks(labels, options, dense, side, target, scratch).memory > available)
    side /= 2;
  return side;
}

}  // namespace tetwright
