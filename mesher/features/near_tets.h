// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "mesher/cut/sheet_faces.h"
#include "mesher/features/feature_surface.h"
#include "mesher/features/strip_finder.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// The tets of a mesh near some of its points, by number, with their neighbours and labels.
class NearTets {
 public:
  using Label = StripFinder::Label;
  /// Instead of a neighbour: it is not near, or there is none.
  static constexpr Index far = no_index, none = no_index - 1;

  /// \param is_near by point
  /// \param parts null, or those of the mesh; kept, as the mesh and the surface
  NearTets(const TetMesh& mesh, const FeatureSurface& surface, const SheetParts* parts,
           const std::vector<std::uint8_t>& is_near);

  std::size_t size() const { return tets_.size(); }
  /// Index of a near tet in the mesh.
  Index in_mesh(Index near) const { return tets_[near]; }
  const Tet& points_of(Index near) const { return mesh_.tets[tets_[near]]; }
  /// A face of a near tet, counterclockwise as seen from it.
  Triangle face_of(Index near, Index k) const {
    const Tet& t = points_of(near);
    return {t[tet_faces[k][0]], t[tet_faces[k][2]], t[tet_faces[k][1]]};
  }
  /// The near tet beyond a face, or far or none.
  Index neighbour(Index near, Index k) const { return neighbours_[near][k]; }
  /// The near tets at a point, ascending. \pre has(p)
  const std::vector<Index>& at(Index p) const { return at_[number_[p]]; }
  /// Whether some near tet has this point.
  bool has(Index p) const { return number_[p] != no_index; }
  /// \pre has(p)
  bool is_on_boundary(Index p) const { return is_on_boundary_[number_[p]] != 0; }

  Label label(Index near) const;
  /// The labels of the near tets at a point, ascending, and an empty one for outside. \pre has(p)
  const std::vector<Label>& labels_at(Index p) const { return labels_at_[number_[p]]; }
  /// The component of the sheet between two parts of a material, or no_index.
  std::uint32_t component_between(const Label& a, const Label& b) const;
  /// Whether there is a sheet between two labels: parts may also end at the rim of a sheet's zone.
  bool are_divided(const Label& a, const Label& b) const;
  /// Whether any two of some labels are divided.
  bool are_any_divided(const std::vector<Label>& labels) const;
  /// The only sheet at a point; nothing if there is none, or several.
  std::optional<std::size_t> sheet_at(Index p) const;

 private:
  void find_neighbours(const std::vector<std::uint8_t>& is_near);
  void number_points();
  std::optional<std::size_t> sheet_between(const Label& a, const Label& b) const;

  const TetMesh& mesh_;
  const FeatureSurface& surface_;
  const SheetParts* parts_;
  std::vector<Index> tets_;
  std::vector<std::array<Index, 4>> neighbours_;
  std::vector<Index> number_;  ///< by point of the mesh, in the following lists
  std::vector<std::vector<Index>> at_;
  std::vector<std::vector<Label>> labels_at_;
  std::vector<std::uint8_t> is_on_boundary_;
};

}  // namespace tetwright
