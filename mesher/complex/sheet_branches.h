// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "common/geometry/box_tree.h"
#include "mesher/complex/labelled_complex.h"
#include "mesher/domain/grid_frame.h"

namespace tetwright {

/// How a point lies to a component of the sheets. Voxel units.
struct NearSheet {
  std::uint32_t component;
  double ahead;  ///< distance from the continued sheet, positive in front of it
  Vec3 ahead_gradient;
  double distance;  ///< from the sheet itself
  Vec3 away;        ///< gradient of the distance
  /// False where another sheet, which meets this one, is between the point and this one.
  bool visible;

  bool in_front() const { return ahead > 0; }
};

/// The edges at which components of sheets meet. Around such an edge the sheets divide space into sectors,
/// and a point sees only the two sheets that bound its own. Immutable; all functions may be called
/// concurrently.
class SheetBranches {
 public:
  SheetBranches() = default;
  SheetBranches(const LabelledComplex& complex, const GridFrame& voxels);

  /// Marks sheets that others hide from a point.
  /// \param reach edges farther away than this do not count, voxels
  /// \param near the sheets near the point, ascending by component
  void hide(const Vec3& point, double reach, std::vector<NearSheet>& near) const;

  /// The side of a component, true in front of it, that something is on; nothing if it has none.
  using SideOf = std::function<std::optional<bool>(std::uint32_t component)>;
  /// Whether two sectors around the edge nearest to a point, given by the sides that they have, only touch
  /// each other in the edge: false if they share a sheet, are none of that edge, or are beyond the end of the
  /// curve.
  bool face_across(const Vec3& point, double reach, const SideOf& a, const SideOf& b) const;

 private:
  /// A sheet that ends at an edge, as a half-plane there.
  struct Half {
    std::uint32_t component;
    double angle;        ///< around the edge, see turn_of()
    bool front_follows;  ///< its front is where angles are larger
  };
  struct Edge {
    std::array<Vec3, 2> ends;
    std::array<bool, 2> is_last;  ///< the curve ends there
    Vec3 u, v;                    ///< unit, perpendicular to the edge; angles count from u to v
    std::uint32_t curve;
    std::vector<Half> halves;  ///< ascending by angle
  };

  /// The sectors, by their first half, that fit the sides.
  static std::vector<std::size_t> sectors(const Edge& edge, const SideOf& side);

  BoxTree tree_;
  std::vector<Edge> edges_;  ///< in the order of the tree; of one curve if the same components meet
};

}  // namespace tetwright
