// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "common/geometry/projection_tree.h"
#include "tetwright/mesher.h"
#include "tetwright/mesher_input.h"

namespace tetwright {

/// Finds the faces of a mesh that close holes of the surfaces it was made from. Sharp flat caps have patches
/// of their own already. Faces of other flat caps are nearest to the cap's triangles. Other caps are known by
/// their rims, since the nearest point of the surface is on the rim for points beyond it; and where they are
/// far from the surface by being nearer to the level set's caps. The borders of these caps follow the faces
/// of the mesh, so that naming them must come after all changes of the mesh.
class SurfaceCapFaces : public CapFaces {
 public:
  /// \param caps of each body's holes that are not flat, input units
  /// \param cell edge of a finest cell, input units; smaller holes get no patch unless they have one
  SurfaceCapFaces(const MesherInput& input, const std::vector<TriangleMesh>& caps, double cell);

  CapReport name(TetMesh& mesh, CapNaming naming) const override;

 private:
  /// Index of the hole that a face closes, or that of none.
  std::size_t hole_of(const TetMesh& mesh, const InterfaceTriangle& face) const;

  double cell_;                        ///< input units
  double near_;                        ///< distances that differ by less are equal, input units
  std::vector<CapReport::Cap> holes_;  ///< names and kinds
  /// The kind is 0 for a triangle of the surfaces, 1 + index for one of a flat cap or an edge of a rim.
  ProjectionTree surfaces_, closings_;
  ProjectionTree winding_caps_;  ///< where the winding number is 1/2
};

}  // namespace tetwright
