// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "common/message_text.h"
#include "mesher/labels/label_thickness.h"
#include "mesher/tuning/estimate_tuning.h"
#include "tetwright/mesher.h"
#include "tetwright/mesher_input.h"

namespace tetwright {

// Three estimates of tets and memory, each better than the last: from the input alone (estimate_mesh() in
// mesher.h), from the octree, and, nearly exact, from the regions of the lattice points. EstimateTuning has
// the constants.

/// Number of dense tets at interfaces, as a fraction of their number with finest cells everywhere.
/// \param coarse fraction of the interface flat enough for cells of twice the size
/// \param coarsest fraction of the interface flat enough for cells of four times the size, part of `coarse`
inline double share_of_coarse_cells(double coarse, double coarsest) {
  return (1 - coarse) + EstimateTuning::Adaptivity::tets_at_coarse * (coarse - coarsest) +
         EstimateTuning::Adaptivity::tets_at_coarsest * coarsest;
}

/// Sizes of a mesh and its intermediate structures.
struct MeshSize {
  double leaves = 0;   ///< leaves of the octree; used for uniform cells only
  double lattice = 0;  ///< tets before cutting
  double dense = 0;    ///< tets of the mesh
};

/// Memory that does not follow from MeshSize, bytes.
struct MemoryModel {
  double per_lattice_tet = EstimateTuning::Memory::per_surface_lattice_tet;  ///< of an adaptive octree
  double beside = 0;  ///< input and its distances, while there is a lattice
  double before = 0;  ///< peak before there is an octree
};

/// The memory model of segmented volumes that have been read. Parallel over the voxels.
/// \param cell edge of a finest cell, input units
MemoryModel label_memory(const LabelInput& labels, double cell);

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
