// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "common/message_text.h"
#include "mesher/input/label_input.h"
#include "mesher/labels/label_thickness.h"
#include "mesher/lattice/octree_memory.h"
#include "mesher/mesher.h"

namespace tetwright {

// What meshing takes is known ever better: from the input alone (estimate_mesh() in mesher.h), from the
// octree, and nearly exactly once every lattice point has its region. The constants were fitted to the inputs
// in README.md.

inline constexpr int max_resolution = 4096;  ///< finest cells along the longest side

/// Peak memory for each tet of the lattice, bytes, while its points are moved and it is cut.
inline constexpr double surface_bytes_per_lattice_tet = 40, label_bytes_per_lattice_tet = 33;
/// Uniform cells have their peak while the lattice is laid out, as most of their leaves are far from
/// interfaces.
inline constexpr double uniform_bytes_per_lattice_tet = 19, uniform_bytes_per_leaf = 124;
/// For each voxel of a volume: its region and the labels' distances.
inline constexpr double bytes_per_voxel = 4;

/// Dense tets at interfaces as a share of those that finest cells would give, where some of the interface is
/// so flat that its cells have twice the size, and some of that so flat that they have four times the size.
inline double share_of_coarse_cells(double coarse, double coarsest) {
  constexpr double tets_at_coarse = 0.15, tets_at_coarsest = 0.08;
  return (1 - coarse) + tets_at_coarse * (coarse - coarsest) + tets_at_coarsest * coarsest;
}

/// How much of everything there is of a mesh.
struct MeshSize {
  double leaves = 0;   ///< of the octree; used for uniform cells only
  double lattice = 0;  ///< tets before cutting
  double dense = 0;    ///< tets of the mesh
};

/// What memory depends on beside the size, bytes.
struct MemoryModel {
  double per_lattice_tet = surface_bytes_per_lattice_tet;  ///< of an adaptive octree
  double beside = 0;  ///< of the input and its distances, as long as there is a lattice
  double before = 0;  ///< at the peak before there is an octree
};

/// The memory model of segmented volumes.
MemoryModel label_memory(const LabelInput& labels);

/// The estimate for a size.
MesherEstimate estimate_of(const MeshSize& size, const MemoryModel& memory, const MesherOptions& options);

/// Throws OutputError where the mesh would have more tets than can be numbered or take more memory than there
/// is, see require_memory().
void validate_estimate(const MesherEstimate& estimate);

/// estimate_mesh() where it is known which cells are split because labels are thin.
MesherEstimate estimate_mesh(const LabelInput& labels, const MesherOptions& options, const ThinCells& thin);

/// The edge of a finest cell, input units.
double cell_size(const MesherInput& input, const MesherOptions& options);
double cell_size(const LabelInput& labels, const MesherOptions& options);

/// The longest side of a volume along its axes, input units.
double longest_side(const LabelInput& labels);

}  // namespace tetwright
