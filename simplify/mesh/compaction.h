// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "common/tet_mesh.h"
#include "simplify/mesh/editable_mesh.h"
#include "simplify/mesh/face_patches.h"

namespace tetwright {

/// Removes an EditableMesh's dead tets and points and renumbers the others.
/// \pre No task runs.
class MeshCompaction {
 public:
  explicit MeshCompaction(EditableMesh& mesh) : mesh_(mesh) {}
  /// See EditableMesh::compact().
  void run(std::size_t spare_tets, std::size_t spare_points, SlotNumbers* numbers);
  /// See EditableMesh::to_mesh().
  TetMesh to_mesh();

 private:
  /// The live points in Morton order within the bounding box.
  std::vector<Index> points_in_curve_order() const;
  void move_points(const std::vector<Index>& order, const std::vector<Index>& new_point, std::size_t spare);
  /// New numbers of the live tets, ordered by the smallest new number of their points.
  ///
  /// \param points number of points.
  /// \param live gets the number of live tets.
  std::vector<Index> number_tets(const std::vector<Index>& new_point, std::size_t points,
                                 std::size_t& live) const;
  void move_tets(const std::vector<Index>& new_point, const std::vector<Index>& new_tet, std::size_t live,
                 std::size_t spare);

  /// The patches other than 0, by ascending points.
  ///
  /// \param number new number of each point.
  FacePatches patches(const std::vector<Index>& number) const;

  EditableMesh& mesh_;
};

}  // namespace tetwright
