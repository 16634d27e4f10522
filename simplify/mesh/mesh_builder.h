// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "simplify/mesh/editable_mesh.h"
#include "simplify/mesh/local_numbers.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Turns a TetMesh into an EditableMesh; see EditableMesh's constructor for what it accepts.
class MeshBuilder {
 public:
  /// \param name the mesh's name in messages; must outlive this object.
  MeshBuilder(EditableMesh& mesh, const std::string& name) : mesh_(mesh), name_(name) {}
  void build(TetMesh&& input);
  /// Replaces the tets of a mesh that has been built, with other points than `tets` dead, and links them.
  ///
  /// \param faces those between two regions and of sheets, with their patches.
  /// \throws InputError if a face has more than two tets, or two on one side, or if `faces` are others than
  /// the
  ///   tets have.
  void replace_tets(std::vector<Tet>&& tets, std::vector<RegionId>&& regions,
                    const std::vector<InterfaceFace>& faces);

 private:
  void take_points(std::vector<Vec3>&& points);
  void take_tets(const TetMesh& input);
  void link_faces();
  /// Marks the links across faces of the input's sheets.
  void take_sheets(const std::vector<InterfaceTriangle>& interfaces);
  /// Freezes the corners of sheets: the borders of sheets and the curves in which they meet other sheets or
  /// interfaces are kept, and so must be the points at which these curves turn.
  void freeze_sheet_corners();
  std::vector<Index> sheet_corners() const;
  /// Sets the faces' patches from the input's interfaces.
  void take_patches(const std::vector<InterfaceTriangle>& interfaces);
  /// Marks the links across sheets and sets all patches.
  void set_faces(const std::vector<InterfaceFace>& faces);
  /// Splits points whose star consists of parts not joined by faces, and freezes them with all their tets.
  /// Also freezes tets that share more than one face with another.
  void split_stars();
  std::vector<Index> points_with_split_stars() const;
  /// The points of tets that share more than one face with another tet, and so do not form a simplicial
  /// complex.
  std::vector<Index> points_of_glued_tets() const;
  /// Adds a copy of each listed point for each part of its star beyond the first. Appends the copies to
  /// `frozen`.
  ///
  /// \return pairs of a copy and its original.
  std::vector<std::array<Index, 2>> split_points(const std::vector<Index>& split, std::vector<Index>& frozen);
  /// Collects the tets at `point` that are connected to the tet `first` across faces.
  void part_of_star(Index point, Index first, LocalNumbers& seen, std::vector<Index>& part) const;

  EditableMesh& mesh_;
  const std::string& name_;
};

}  // namespace tetwright
