// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/projection_tree.h"
#include "tetwright/mesher.h"
#include "tetwright/mesher_input.h"

namespace tetwright {

/// Finds the faces of a mesh that close holes of the surfaces it was made from. Sharp flat caps have patches
/// of their own already. Faces of other flat caps are nearest to the cap's triangles; those of holes that are
/// not flat are nearest to an edge of the rim, as the surface is farther away beyond it. The borders of these
/// caps follow the faces of the mesh, so that naming them must come after all changes of the mesh.
class SurfaceCapFaces : public CapFaces {
 public:
  /// \param cell edge of a finest cell, input units; smaller holes get no patch unless they have one
  SurfaceCapFaces(const MesherInput& input, double cell);

  CapReport name(TetMesh& mesh) const override;

 private:
  /// Index of the hole that a face closes, or that of none.
  std::size_t hole_of(const TetMesh& mesh, const InterfaceTriangle& face) const;

  std::vector<CapReport::Cap> holes_;  ///< names and kinds
  double near_ = 0;  ///< distances that differ by less are equal where a complex was joined, input units
  /// The kind is 0 for a triangle of the surfaces, 1 + index for one of a flat cap or an edge of a rim.
  ProjectionTree surfaces_, closings_;
};

}  // namespace tetwright
