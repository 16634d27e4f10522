// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <optional>
#include <set>
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
  /// The near tets at a point of one of them, ascending.
  const std::vector<Index>& at(Index p) const { return at_.at(p); }
  bool has(Index p) const { return at_.contains(p); }
  bool is_on_boundary(Index p) const { return on_boundary_.contains(p); }

  Label label(Index near) const;
  /// The labels of the near tets at a point, and an empty one for outside. \pre has(p)
  const std::set<Label>& labels_at(Index p) const;
  /// The component of the sheet between two parts of a material, or no_index.
  std::uint32_t component_between(const Label& a, const Label& b) const;
  /// Whether there is a sheet between two labels: parts may also end at the rim of a sheet's zone.
  bool are_divided(const Label& a, const Label& b) const;
  /// Whether any two of some labels are divided.
  bool are_any_divided(const std::set<Label>& labels) const;
  /// The only sheet at a point; nothing if there is none, or several.
  std::optional<std::size_t> sheet_at(Index p) const;

 private:
  void find_neighbours(const std::vector<std::uint8_t>& is_near);
  std::optional<std::size_t> sheet_between(const Label& a, const Label& b) const;

  const TetMesh& mesh_;
  const FeatureSurface& surface_;
  const SheetParts* parts_;
  std::vector<Index> tets_;
  std::vector<std::array<Index, 4>> neighbours_;
  std::map<Index, std::vector<Index>> at_;
  std::map<Index, std::set<Label>> labels_at_;
  std::set<Index> on_boundary_;
};

}  // namespace tetwright
