// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "simplify/constraints/surface_grid.h"
#include "simplify/constraints/volume_ledger.h"
#include "simplify/mesh/editable_mesh.h"

namespace tetwright {

/// A mesh with what operations on it must respect: its surfaces in a grid, the volumes of its materials and
/// the frozen points.
struct ConstrainedMesh {
  /// `name` is what messages call the mesh; `frozen` by point, empty: none; `fix_boundary` freezes boundary
  /// and interfaces. Throws InputError where the volumes of the tets add up to nothing or less. The grid is
  /// built by whoever works on the mesh; volumes are kept for as long as it exists.
  ConstrainedMesh(TetMesh&& input, const std::string& name, const std::vector<std::uint8_t>& frozen,
                  bool fix_boundary, bool keep_volumes);
  ConstrainedMesh(const ConstrainedMesh&) = delete;
  ConstrainedMesh& operator=(const ConstrainedMesh&) = delete;

  /// Patches of faces between materials go from the grid, which knows them, to the mesh: before the grid is
  /// built anew, or the mesh leaves.
  void keep_patches();

  EditableMesh mesh;
  SurfaceGrid grid;
  VolumeLedger ledger;
};

}  // namespace tetwright
