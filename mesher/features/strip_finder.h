// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/geometry/projection_tree.h"
#include "mesher/complex/labelled_complex.h"
#include "mesher/cut/sheet_faces.h"
#include "mesher/features/feature_surface.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Finds where a mesh joins what the complex does not, near curves in which four or more sheets meet: a cut
/// cell there joins two regions that only face each other across the curve.
class StripFinder {
 public:
  /// \param cell size of the cells at the surface, input units
  /// \param parts null, or those of the mesh
  StripFinder(const LabelledComplex& complex, const FeatureSurface& surface, double cell,
              const SheetParts* parts);

  /// The edges of the complex at which four or more sheets meet, ascending, and its points, flagged, at which
  /// further sheets meet.
  const std::vector<std::array<Index, 2>>& branching_edges() const { return branching_edges_; }
  const std::vector<std::uint8_t>& curve_ends() const { return curve_ends_; }
  /// The material of a tet and its part, if there are any; nothing outside.
  struct Label {
    MaterialOrOutside material;
    RegionIndex part = 0;
    auto operator<=>(const Label&) const = default;
  };
  /// True if two labels near a curve only face each other across it, so that a face between them at a point
  /// is part of a strip.
  bool are_across_curve(const Vec3& p, const Label& a, const Label& b) const;
  /// Faces between regions, or parts of a region, that have no sheet near them.
  std::vector<Triangle> faces(const TetMesh& mesh) const;

 private:
  using Sheets = std::vector<std::size_t>;  ///< that meet, ascending

  void find_curves(const LabelledComplex& complex);
  bool is_near_curve(const Vec3& p) const;

  const FeatureSurface& surface_;
  double cell_;
  const SheetParts* parts_;
  ProjectionTree curves_;
  std::vector<std::array<Index, 2>> branching_edges_;
  std::vector<std::uint8_t> curve_ends_;
};

}  // namespace tetwright
