// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/tet_mesh.h"
#include "simplify/mesh/editable_mesh.h"
#include "simplify/mesh/local_numbers.h"

namespace tetwright {

/// Turns a TetMesh into an EditableMesh; what it accepts stands at EditableMesh's constructor.
class MeshBuilder {
 public:
  /// `name`: what messages call the mesh.
  MeshBuilder(EditableMesh& mesh, const std::string& name) : mesh_(mesh), name_(name) {}
  void build(TetMesh&& input);

 private:
  void take_points(std::vector<Vec3>&& points);
  void take_tets(const TetMesh& input);
  void link_faces();
  /// Gives the faces the patches of the interfaces that the mesh came with.
  void take_patches(const std::vector<InterfaceTriangle>& interfaces);
  /// Splits points whose star falls into parts that no face joins. They are frozen with all their tets, as
  /// are tets that share more than one face.
  void split_stars();
  std::vector<Index> points_with_split_stars() const;
  /// The points of tets that share more than one face with another one: no complex to operate on.
  std::vector<Index> points_of_glued_tets() const;
  /// Adds a copy of each listed point for each further part of its star. Appends the copies to
  /// `frozen` and returns them with the points they were split off from.
  std::vector<std::array<Index, 2>> split_points(const std::vector<Index>& split, std::vector<Index>& frozen);
  /// The tets at `point` that faces join with the tet `first`.
  void part_of_star(Index point, Index first, LocalNumbers& seen, std::vector<Index>& part) const;

  EditableMesh& mesh_;
  const std::string& name_;
};

}  // namespace tetwright
