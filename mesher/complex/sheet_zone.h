// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/geometry/box_tree.h"
#include "common/geometry/morton.h"
#include "mesher/complex/labelled_complex.h"
#include "mesher/complex/sheet_branches.h"
#include "mesher/domain/grid_frame.h"

namespace tetwright {

/// On which side of the sheets near it a point is. Sheets are continued beyond their free borders in the
/// planes of their triangles, and a point has a side of a component up to SheetZone::reach() from it. Voxel
/// coordinates; immutable, all functions may be called concurrently.
class SheetZone {
 public:
  using Near = NearSheet;

  /// \pre the complex has sheets
  SheetZone(const LabelledComplex& complex, const GridFrame& voxels);

  /// Lists the components within twice the reach, ascending.
  void find(const Vec3& point, std::vector<Near>& out) const;
  /// True if the component has faces in the region.
  bool is_in(std::uint32_t component, RegionIndex region) const;
  const SheetBranches& branches() const { return branches_; }
  /// Distance, voxels, up to which points have a side.
  static double reach();
  /// The voxels through which sheets pass, as ascending Morton keys.
  const std::vector<MortonKey>& voxels() const { return voxels_; }

 private:
  struct Face {
    std::array<Vec3, 3> corners;
    Vec3 normal;  ///< unit
    bool continued;
  };
  struct Component {
    BoxTree tree;
    std::vector<Face> faces;           ///< in the order of the tree
    Box3 box;                          ///< within which points may be near
    std::vector<RegionIndex> regions;  ///< ascending
  };
  struct Foot {
    double squared;
    Vec3 away;  ///< from the nearest position
    const Face* face = nullptr;
  };

  void add_faces(const LabelledComplex& complex, const GridFrame& voxels);
  void find_voxels(const GridFrame& voxels);
  static Foot nearest(const Component& component, const Vec3& point, bool continued);
  static double side(const Foot& foot) { return foot.face->normal.dot(foot.away); }

  std::vector<Component> components_;
  SheetBranches branches_;
  std::vector<MortonKey> voxels_;
};

}  // namespace tetwright
