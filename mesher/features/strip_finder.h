// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
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

  /// The curves in which four or more sheets meet.
  const ProjectionTree& curves() const { return curves_; }
  /// Faces between regions, or parts of a region, that have no sheet near them.
  std::vector<Triangle> faces(const TetMesh& mesh) const;
  /// Edges at which four or more sheets meet that have no common curve near them: the end of a curve between
  /// four regions, drawn out along the boundary. Ascending.
  std::vector<std::array<Index, 2>> edges(const TetMesh& mesh) const;

 private:
  void add_complex(const LabelledComplex& complex);
  bool is_near_curve(const Vec3& p) const;
  /// True if the sheets, ascending, have a common junction near a point.
  bool meet_near(const std::vector<std::size_t>& sheets, const Vec3& p) const;

  const FeatureSurface& surface_;
  double cell_;
  const SheetParts* parts_;
  ProjectionTree curves_;
  ProjectionTree junctions_;                      ///< kinds are indices into sheets_
  std::vector<std::vector<std::size_t>> sheets_;  ///< that meet in a junction, ascending
};

}  // namespace tetwright
