// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/geometry/box_tree.h"
#include "tetwright/surface_mesh.h"
#include "tetwright/tet_mesh.h"
#include "tools/app/commands/command_run.h"
#include "tools/prepare/surface_spaces.h"

namespace tetwright {

/// Brings surfaces that a command compares with its tet mesh into the space of that mesh.
class SpacesOfSurfaces {
 public:
  /// Notes the space of the mesh in the report, see space_of_tets().
  /// \param mesh first input of the run
  /// \throws UsageError if there is --surface-space, and the space of the mesh is unknown
  SpacesOfSurfaces(const TetMesh& mesh, CommandRun& run);

  /// Brings a surface into the space of the mesh, if both are known.
  /// \param input of the surface, which may have been moved out of it
  /// \throws InputError with the boxes and spaces of both if they do not meet
  void add(TriangleMesh& surface, const Input& input);

  /// Adds notes about the surfaces that were added to the report of the run.
  void report();

 private:
  CommandRun& run_;
  SurfaceSpaces spaces_;
  Box3 box_;  ///< of the tets
};

}  // namespace tetwright
