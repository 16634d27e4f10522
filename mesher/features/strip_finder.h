// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <set>
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
  /// Edges to collapse so that the mesh has the junctions of the complex, ascending:
  /// - between two points at which sheets meet that have no common curve near them, but the same corner: they
  ///   draw out the end of a curve;
  /// - at which a sheet or the boundary of a material touches itself, or that lead away from such a point in
  ///   the smaller part of the surface; only if there are no strips left.
  std::vector<std::array<Index, 2>> edges(const TetMesh& mesh, bool any_strip) const;

 private:
  using Sheets = std::vector<std::size_t>;  ///< that meet, ascending

  void find_own_pinches(const LabelledComplex& complex);
  void add_complex(const LabelledComplex& complex);
  bool is_near_curve(const Vec3& p) const;
  /// Faces with a point near a curve, and the sheet of each.
  struct Faces {
    std::vector<Triangle> ids;
    std::vector<std::size_t> sheets;
  };
  Faces faces_near_curves(const TetMesh& mesh) const;
  using Edges = std::set<std::array<Index, 2>>;
  void add_drawn_out_corners(const TetMesh& mesh, const Faces& near, Edges& edges) const;
  void add_pinches(const TetMesh& mesh, const Faces& near, Edges& edges) const;
  /// The sheets, and after them the boundaries of the materials, that faces are part of: the numbers of
  /// surfaces. Faces occur once for each.
  struct Surfaces {
    std::vector<Triangle> faces;
    std::vector<std::uint32_t> numbers;
    void add(const Triangle& face, std::size_t sheet, const std::array<RegionIndex, 2>& sides,
             std::size_t sheets);
  };
  /// True if a junction near a point, or a corner, has all of these sheets.
  bool meet_near(const ProjectionTree& junctions, const Sheets& sheets, const Vec3& p) const;

  const FeatureSurface& surface_;
  double cell_;
  const SheetParts* parts_;
  ProjectionTree curves_;
  ProjectionTree junctions_, corners_;  ///< kinds are indices into sheets_
  std::vector<Sheets> sheets_;
  std::vector<std::array<RegionIndex, 2>> sides_;  ///< of each sheet
  ProjectionTree pinches_;                         ///< of the complex itself; kinds are numbers of surfaces
};

}  // namespace tetwright
