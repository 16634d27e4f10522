// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "common/types.h"

namespace tetwright {

/// The material on one side of a face; nothing for outside.
using MaterialOrOutside = std::optional<MaterialTag>;

/// What a simplified mesh is measured against and its points are projected onto: the interfaces of the
/// original.
///
/// `mesher/` implements it by its signed distance fields, `simplify/` needs nothing else of them.
/// All functions may be called concurrently.
class ReferenceSurface {
 public:
  virtual ~ReferenceSurface() = default;

  /// Distance of `point` from the surface of `material`, negative inside it, in input units. Farther away
  /// than the reference's band the value only has the right sign and is at least the band in size.
  virtual double signed_distance(const Vec3& point, MaterialTag material) const = 0;

  /// The point of the interface between two regions near `point`, or nothing where there is none within
  /// `max_distance` (input units). It need not be the nearest one, and no farther than twice the nearest's
  /// distance.
  virtual std::optional<Vec3> project(const Vec3& point, MaterialOrOutside first, MaterialOrOutside second,
                                      double max_distance) const = 0;

  /// Whether it knows the patches of the mesh's interfaces, by their numbers, with the creases and corners
  /// where they meet. If so, what is asked for below is exact; else nothing is found, and the borders of the
  /// patches that the mesh has are kept as its junction curves are.
  virtual bool has_patches() const { return false; }
  /// The nearest point of a patch of the interface between two regions within `max_distance` (input units).
  virtual std::optional<Vec3> onto_patch(const Vec3& /*point*/, MaterialOrOutside /*first*/,
                                         MaterialOrOutside /*second*/, std::uint16_t /*patch*/,
                                         double /*max_distance*/) const {
    return {};
  }
  /// The same of the creases between any patches.
  virtual std::optional<Vec3> onto_crease(const Vec3& /*point*/, double /*max_distance*/) const { return {}; }
  /// The same of corners.
  virtual std::optional<Vec3> onto_corner(const Vec3& /*point*/, double /*max_distance*/) const { return {}; }
};

}  // namespace tetwright
