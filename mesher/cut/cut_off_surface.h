// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>

#include "common/geometry/projection_tree.h"
#include "mesher/domain/material_field.h"
#include "tetwright/surface_mesh.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// The interfaces of the field of a volume, for a mesh that is cut off at its border. Patch 0 consists of the
/// interfaces between the field's regions. Patches 1 to 6 are the sides of the border: 1 + 2 * axis for the
/// lower one, 2 + 2 * axis for the upper one. Faces and edges of the box are exact; the curves in which
/// interfaces meet the box come from the dense mesh.
class CutOffSurface final : public ReferenceSurface {
 public:
  /// \param mesh cut from the field, its interfaces with their patches; not kept
  CutOffSurface(const TetMesh& mesh, std::shared_ptr<const MaterialField> field);

  double signed_distance(const Vec3& point, MaterialTag material) const override;
  std::optional<Vec3> project(const Vec3& point, MaterialOrOutside first, MaterialOrOutside second,
                              double max_distance) const override;
  bool has_patches() const override { return true; }
  std::optional<Vec3> onto_patch(const Vec3& point, MaterialOrOutside first, MaterialOrOutside second,
                                 std::uint16_t patch, double max_distance) const override;
  std::optional<Vec3> onto_crease(const Vec3& point, double max_distance) const override;
  std::optional<Vec3> onto_corner(const Vec3& point, double max_distance) const override;

 private:
  std::shared_ptr<const MaterialField> field_;
  std::array<Vec3, 3> normals_;  ///< of the faces of the box normal to each axis
  ProjectionTree creases_, corners_;
};

}  // namespace tetwright
