// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/geometry/projection_tree.h"
#include "mesher/domain/material_field.h"
#include "mesher/features/complex_patches.h"
#include "mesher/features/given_up_zone.h"
#include "mesher/tuning/cut_tuning.h"
#include "tetwright/mesher_input.h"
#include "tetwright/surface_mesh.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Closest-point queries on the surfaces of an input with their patches, creases and corners. Input units;
/// all functions may be called concurrently.
class FeatureSurface : public ReferenceSurface {
 public:
  using Patch = std::uint16_t;
  /// Two patches that meet in a crease, ascending.
  using PatchPair = std::array<Patch, 2>;
  struct Place {
    Vec3 point;
    Vec3 normal;  ///< unit, out of the body
    Patch patch;
  };
  struct CreasePlace {
    Vec3 point;
    PatchPair patches;
  };
  struct Corner {
    Vec3 point;
    std::vector<Patch> patches;  ///< patches that meet there, ascending
  };

  /// \param patches of each body, in the order of `input.bodies`; renumbered from 0, body by body
  /// \param corner_reach as for find_creases()
  /// \param field answers queries for faces without patches
  /// \param complex patches of the input's complex, if there is one; used instead of `patches`
  /// \param caps of each body's holes, input units, or empty; each triangle continues the patch of the
  /// nearest
  ///   triangle of the body
  /// \param given_up where there are no creases, and queries for patches go to the field
  /// \param cells at each body, input units, or empty
  /// \param surroundings answers queries for faces between two materials of which none is a body, the labels
  ///   of a volume around the bodies; null for surfaces alone
  FeatureSurface(const MesherInput& input, const std::vector<SurfacePatches>& patches, double corner_reach,
                 std::shared_ptr<const MaterialField> field, const ComplexPatches* complex = nullptr,
                 const std::vector<TriangleMesh>& caps = {}, GivenUpZone given_up = {},
                 std::vector<double> cells = {}, std::shared_ptr<const ReferenceSurface> surroundings = {});

  double signed_distance(const Vec3& point, MaterialTag material) const override {
    return surroundings_ ? surroundings_->signed_distance(point, material)
                         : field_->signed_distance(point, material);
  }
  std::optional<Vec3> project(const Vec3& point, MaterialOrOutside first, MaterialOrOutside second,
                              double max_distance) const override {
    return field_->project(point, first, second, max_distance);
  }
  bool has_patches() const override { return true; }
  std::optional<Vec3> onto_patch(const Vec3& point, MaterialOrOutside first, MaterialOrOutside second,
                                 Patch patch, double max_distance) const override;
  std::optional<Vec3> onto_crease(const Vec3& point, double max_distance) const override;
  bool lacks_creases(const Vec3& point) const override { return given_up_.affects(point); }
  std::optional<Vec3> onto_corner(const Vec3& point, double max_distance) const override;

  std::uint16_t first_body_patch() const override { return first_body_patch_; }
  bool is_flat(std::uint16_t patch) const override { return patch < flat_.size() && flat_[patch]; }

  /// Whether the bodies are in a volume with labels.
  bool is_surrounded() const { return surroundings_ != nullptr; }
  /// \param surroundings of the finished mesh: the curves in which its border ends are known from that only
  void set_surroundings(std::shared_ptr<const ReferenceSurface> surroundings) {
    surroundings_ = std::move(surroundings);
  }
  /// \param labels around the bodies that these do not carve: faces of bodies with them are not on bodies
  void set_protected(std::vector<MaterialTag> labels) { protected_ = std::move(labels); }
  std::optional<double> creased_size() const override { return creased_size_; }
  /// The planes of the border of the volume in which a point is, see side_planes(); none without a volume.
  /// \param slack max distance, cells
  unsigned border_planes(const Vec3& point, double slack = CutTuning::Fitting::in_border) const;
  /// Puts a point beside planes of the border into them.
  Vec3 onto_border(const Vec3& point, unsigned planes) const;
  /// True for a face between two labels around the bodies, between one and the outside, or of a protected
  /// one.
  bool is_beside_bodies(const InterfaceTriangle& face) const {
    return is_beside_bodies(face.material, face.other);
  }
  /// True for two faces of one pair of materials, if all labels around the bodies count as one.
  bool are_alike(const InterfaceTriangle& a, const InterfaceTriangle& b) const;
  /// The sheet that a face lies on. If the surfaces are one complex, the faces between two of its regions are
  /// a sheet; otherwise each body's surface is one, and a face between two materials lies on that of the
  /// later body, since later bodies carve earlier ones. std::nullopt between layers of one body, on the box
  /// of a meshed outside, and between regions that have no face in common in the complex. A face with one
  /// material on both sides lies on an inner sheet, whose component is the face's patch.
  std::optional<std::size_t> sheet_of(const InterfaceTriangle& face) const;
  /// The region of the complex that a material is.
  RegionIndex region_of(MaterialOrOutside material) const {
    const auto body = material ? bodies_.find(*material) : bodies_.end();
    return static_cast<RegionIndex>(body == bodies_.end() ? outside_region : body->second + 1);
  }
  std::size_t sheet_of(Patch patch) const { return sheet_of_patch_[patch]; }
  /// Size of the cells at a sheet, input units, if it is known: that of the body with the smaller ones.
  std::optional<double> cell_of(std::size_t sheet) const;
  /// The sheet between two regions of the complex, or none.
  std::optional<std::size_t> sheet_between(RegionIndex a, RegionIndex b) const {
    const auto known = sheets_.find(std::minmax(a, b));
    return known == sheets_.end() ? std::nullopt : std::optional(known->second);
  }
  /// The sheet that faces across a closed gap lie on: two bodies of the complex have no face in common, but
  /// the outside between them was thinner than the cells. The later body takes it, so that these faces are on
  /// the earlier body's sheet with the outside. std::nullopt for all other faces, near curves in which both
  /// bodies end, where such faces are strips between regions that only face each other, and near edges in
  /// which bodies touch, around which both of them grow.
  /// \param at a point of the face
  /// \param reach max distance from both sides of the gap
  std::optional<std::size_t> sheet_across_gap(const InterfaceTriangle& face, const Vec3& at,
                                              double reach) const;
  /// True if creases are given up anywhere.
  bool gives_up_creases() const { return given_up_.any(); }
  /// True where the creases of a sheet are given up.
  bool is_given_up(const Vec3& p, std::size_t sheet) const;
  bool has_inner_sheets() const { return !inner_sheets_.empty(); }
  bool is_inner(std::size_t sheet) const { return has_inner_sheets() && sheet >= sheets_.size(); }
  /// True for patches that continue an inner sheet beyond its border.
  bool is_continued(Patch patch) const {
    return has_inner_sheets() && patch >= first_continued_ && patch < no_patch_;
  }
  /// True if creases include the curves in which three or more sheets meet.
  bool has_junctions() const override { return !sheets_.empty(); }
  /// The closest point on a sheet within `at_most`.
  /// \param facing if given, only triangles whose normal is not opposite to it count
  /// \param min_facing smallest cosine between normals that are not opposite
  std::optional<Place> nearest(const Vec3& p, std::size_t sheet, double at_most, const Vec3* facing = nullptr,
                               double min_facing = CutTuning::Labelling::min_facing) const;
  /// The patch of faces that lie on no surface, that of faces between labels if there are any; queries for it
  /// go to the field.
  Patch no_patch() const { return no_patch_; }
  /// The closest point on one patch within `at_most`.
  std::optional<Place> nearest_of_patch(const Vec3& p, Patch patch, double at_most) const;
  /// The closest point on the creases between two patches within `at_most`.
  std::optional<Vec3> onto_crease_between(const Vec3& p, const PatchPair& pair, double at_most) const;
  /// The closest point on the creases for which `accepts(pair)` is true, within `at_most`.
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
  /// The surface region of the input that a patch belongs to, or none.
  SurfaceRegion group_of(Patch patch) const {
    return patch < groups_.size() ? groups_[patch] : SurfaceRegion{};
  }

 private:
  bool is_beside_bodies(MaterialOrOutside first, MaterialOrOutside second) const {
    const auto is_body = [&](MaterialOrOutside m) { return m && bodies_.contains(*m); };
    const auto is_kept = [&](MaterialOrOutside m) {
      return m && std::find(protected_.begin(), protected_.end(), *m) != protected_.end();
    };
    return surroundings_ && ((!is_body(first) && !is_body(second)) || is_kept(first) || is_kept(second));
  }

  std::shared_ptr<const MaterialField> field_;
  std::shared_ptr<const ReferenceSurface> surroundings_;
  std::vector<MaterialTag> protected_;
  GivenUpZone given_up_;
  std::vector<double> cells_;           ///< at each body, input units, or empty
  std::optional<double> creased_size_;  ///< with surroundings, which are larger than bodies
  Patch no_patch_ = 0;
  /// Items of the trees, until these are built.
  struct Items {
    std::vector<Vec3> points;
    std::vector<ProjectionTree::Item> triangles, segments;
  };
  void add_complex(const ComplexPatches& complex, double corner_reach, Items& items);
  void add_bodies(const MesherInput& input, const std::vector<SurfacePatches>& patches, double corner_reach,
                  const std::vector<TriangleMesh>& caps, Items& items);
  /// Adds triangles with their patches, and the creases between these.
  /// \param without edges, ascending, that are no creases
  void add_triangles(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles,
                     const std::vector<std::uint16_t>& patches, const std::vector<std::uint8_t>& rough,
                     Patch first_patch, double corner_reach, Items& items,
                     std::span<const std::array<Index, 2>> without = {});
  /// Finds the patches that lie in a plane. Needs triangles_ and normals_.
  void find_flat_patches();
  void add_segment(const SurfaceCreases::Segment& segment, Index first, const PatchPair& patches,
                   Items& items) const;

  std::map<MaterialTag, std::size_t> bodies_;  ///< body of each material and layer
  /// Sheet of each pair of regions of the complex, ascending; empty without a complex.
  std::map<std::pair<RegionIndex, RegionIndex>, std::size_t> sheets_;
  std::map<std::pair<std::uint32_t, RegionIndex>, std::size_t> inner_sheets_;  ///< by component and region
  Patch first_continued_ = 0;
  std::vector<std::size_t> sheet_of_patch_;
  std::vector<std::array<std::size_t, 2>> bodies_of_sheet_;  ///< of a complex; may be equal
  ProjectionTree triangles_, creases_, corner_points_;
  ProjectionTree touching_edges_;
  std::vector<Vec3> normals_;  ///< of the items of triangles_
  std::vector<Corner> corners_;
  std::vector<SurfaceRegion> groups_;  ///< by patch
  std::vector<std::uint8_t> flat_;     ///< by patch; empty without surroundings
  Patch first_body_patch_ = 0;
};

}  // namespace tetwright
