// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "common/message_text.h"
#include "mesher/input/label_input.h"
#include "mesher/labels/label_thickness.h"
#include "mesher/lattice/octree_memory.h"
#include "mesher/mesher.h"

namespace tetwright {

// Three estimates of tets and memory, each better than the last: from the input alone (estimate_mesh() in
// mesher.h), from the octree, and, nearly exact, once every lattice point has its region. The constants were
// fitted to the inputs in README.md.

inline constexpr int max_resolution = 4096;  ///< finest cells along the longest side

/// Peak memory per lattice tet while points are moved and tets cut, bytes.
inline constexpr double surface_bytes_per_lattice_tet = 40, label_bytes_per_lattice_tet = 33;
/// Peak memory with uniform cells, bytes. It occurs while the lattice is built, as most leaves are far from
/// interfaces.
inline constexpr double uniform_bytes_per_lattice_tet = 19, uniform_bytes_per_leaf = 124;
/// Per voxel of a volume: its region and the labels' distances, bytes.
inline constexpr double bytes_per_voxel = 4;

/// Dense tets at interfaces as a share of those of finest cells.
/// \param coarse fraction of the interface flat enough for cells of twice the size
/// \param coarsest fraction of the interface flat enough for cells of four times the size, part of `coarse`
inline double share_of_coarse_cells(double coarse, double coarsest) {
  constexpr double tets_at_coarse = 0.15, tets_at_coarsest = 0.08;
  return (1 - coarse) + tets_at_coarse * (coarse - coarsest) + tets_at_coarsest * coarsest;
}

/// Sizes of a mesh and its intermediate structures.
struct MeshSize {
  double leaves = 0;   ///< leaves of the octree; used for uniform cells only
  double lattice = 0;  ///< tets before cutting
  double dense = 0;    ///< tets of the mesh
};

/// Memory that does not follow from MeshSize, bytes.
struct MemoryModel {
  double per_lattice_tet = surface_bytes_per_lattice_tet;  ///< of an adaptive octree
  double beside = 0;  ///< input and its distances, while there is a lattice
  double before = 0;  ///< peak before there is an octree
};

/// The memory model of segmented volumes.
MemoryModel label_memory(const LabelInput& labels);

/// The tets and memory of a mesh of this size.
MesherEstimate estimate_of(const MeshSize& size, const MemoryModel& memory, const MesherOptions& options);

/// \throws OutputError if the mesh has more tets than can be numbered or needs more memory than is available,
///   see require_memory()
void validate_estimate(const MesherEstimate& estimate);

/// estimate_mesh() with known cells that are split because labels are thin.
MesherEstimate estimate_mesh(const LabelInput& labels, const MesherOptions& options, const ThinCells& thin);

/// The edge of a finest cell, input units.
double cell_size(const MesherInput& input, const MesherOptions& options);
double cell_size(const LabelInput& labels, const MesherOptions& options);

/// The longest side of a volume along its axes, input units.
double longest_side(const LabelInput& labels);

}  // namespace tetwright
