// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "simplify/constraints/surface_grid.h"
#include "simplify/constraints/volume_ledger.h"
#include "simplify/mesh/editable_mesh.h"

namespace tetwright {

/// A mesh with everything that constrains its operations: a grid of its surfaces, the volumes of its
/// materials and the frozen vertices.
struct ConstrainedMesh {
  /// Takes ownership of the mesh. Does not build the grid; callers do so before operations.
  ///
  /// \param name the mesh's name in messages.
  /// \param frozen one value for each point, nonzero if frozen; empty: no point is frozen.
  /// \param fix_boundary freezes all points of the boundary and the interfaces.
  /// \param keep_volumes bounds the volume of each material for as long as this object exists.
  /// \param volumes to be kept, by material, input units cubed; null: those of the mesh.
  /// \throws InputError if the sum of the tets' signed volumes is not positive.
  ConstrainedMesh(TetMesh&& input, const std::string& name, const std::vector<std::uint8_t>& frozen,
                  bool fix_boundary, bool keep_volumes,
                  const std::map<MaterialTag, double>* volumes = nullptr);
  ConstrainedMesh(const ConstrainedMesh&) = delete;
  ConstrainedMesh& operator=(const ConstrainedMesh&) = delete;

  /// Copies the patches of interface faces from the grid, which keeps them during operations, to the mesh.
  /// Call this before rebuilding the grid and before taking the mesh.
  void keep_patches();

  EditableMesh mesh;
  SurfaceGrid grid;
  VolumeLedger ledger;
};

}  // namespace tetwright
