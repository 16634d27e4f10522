// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "common/features/surface_patches.h"
#include "common/geometry/projection_tree.h"
#include "common/reference_surface.h"
#include "common/tet_mesh.h"
#include "common/types.h"
#include "mesher/distance/material_field.h"
#include "mesher/input/mesher_input.h"

namespace tetwright {

/// The surfaces of an input with their patches, creases and corners, for nearest places. Input units; all
/// functions may be called concurrently.
class FeatureSurface : public ReferenceSurface {
 public:
  using Patch = std::uint16_t;
  /// Two patches that meet in a crease, ascending.
  using PatchPair = std::array<Patch, 2>;
  struct Place {
    Vec3 point;
    Vec3 normal;  ///< unit, out of its body
    Patch patch;
  };
  struct CreasePlace {
    Vec3 point;
    PatchPair patches;
  };
  struct Corner {
    Vec3 point;
    std::vector<Patch> patches;  ///< that meet there, ascending
  };

  /// `patches[b]` are those of body b; they are numbered from 0 on, body by body. `corner_reach` as for
  /// find_creases(). `field` answers for what has no patches.
  FeatureSurface(const MesherInput& input, const std::vector<SurfacePatches>& patches, double corner_reach,
                 std::shared_ptr<const MaterialField> field);

  double signed_distance(const Vec3& point, MaterialTag material) const override {
    return field_->signed_distance(point, material);
  }
  std::optional<Vec3> project(const Vec3& point, MaterialOrOutside first, MaterialOrOutside second,
                              double max_distance) const override {
    return field_->project(point, first, second, max_distance);
  }
  bool has_patches() const override { return true; }
  std::optional<Vec3> onto_patch(const Vec3& point, MaterialOrOutside first, MaterialOrOutside second,
                                 Patch patch, double max_distance) const override;
  std::optional<Vec3> onto_crease(const Vec3& point, double max_distance) const override;
  std::optional<Vec3> onto_corner(const Vec3& point, double max_distance) const override {
    return corner_points_.nearest(point, {}, max_distance);
  }

  /// The body whose surface a face between materials is on: later bodies carve earlier ones, so that it is
  /// the later one of both; nothing between layers of one body and at the box of an outside that is meshed,
  /// too.
  std::optional<std::size_t> body_of(const InterfaceTriangle& face) const;
  /// The nearest place of a body within `at_most`; with `facing` only on triangles whose normal is not
  /// opposite to it.
  std::optional<Place> nearest(const Vec3& p, std::size_t body, double at_most,
                               const Vec3* facing = nullptr) const;
  /// The patch of faces that are on no surface: the field answers for them.
  Patch no_patch() const { return no_patch_; }
  /// The same of one patch.
  std::optional<Place> nearest_of_patch(const Vec3& p, Patch patch, double at_most) const;
  /// The nearest place of the creases between two patches.
  std::optional<Vec3> onto_crease_between(const Vec3& p, const PatchPair& pair, double at_most) const;
  /// The nearest place of the creases for which `accepts(pair)` holds.
  template <class Accepts>
  std::optional<CreasePlace> nearest_crease(const Vec3& p, double at_most, const Accepts& accepts) const {
    const auto pair_of = [](const ProjectionTree::Item& item) {
      return PatchPair{static_cast<Patch>(item.kind[0]), static_cast<Patch>(item.kind[1])};
    };
    const auto hit = creases_.nearest_of(
        p, at_most, [&](const ProjectionTree::Item& item) { return accepts(pair_of(item)); });
    if (!hit) return {};
    return CreasePlace{hit->point, pair_of(creases_.items()[hit->item])};
  }
  const std::vector<Corner>& corners() const { return corners_; }
  /// The group of the input that a patch belongs to, or none.
  SurfaceRegion group_of(Patch patch) const {
    return patch < groups_.size() ? groups_[patch] : SurfaceRegion{};
  }

 private:
  std::shared_ptr<const MaterialField> field_;
  Patch no_patch_ = 0;
  std::map<MaterialTag, std::size_t> bodies_;  ///< of each material and layer
  ProjectionTree triangles_, creases_, corner_points_;
  std::vector<Vec3> normals_;  ///< of the items of triangles_
  std::vector<Corner> corners_;
  std::vector<SurfaceRegion> groups_;  ///< by patch
};

}  // namespace tetwright
