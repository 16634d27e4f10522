// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "common/types.h"

namespace tetwright {

/// Material on one side of a face; std::nullopt: outside.
using MaterialOrOutside = std::optional<MaterialTag>;

/// Interfaces of the original mesh: a simplified mesh is measured against them and its points are projected
/// onto them.
///
/// `mesher/` implements it with its signed distance fields; `simplify/` depends on nothing else of them. All
/// functions may be called concurrently.
class ReferenceSurface {
 public:
  virtual ~ReferenceSurface() = default;

  /// Signed distance of `point` from the surface of `material`, negative inside, input units. Beyond the band
  /// of the reference only the sign is exact, and the absolute value is at least the band.
  virtual double signed_distance(const Vec3& point, MaterialTag material) const = 0;

  /// Projects `point` onto the interface between two regions.
  /// \param max_distance input units
  /// \return a point of the interface at most twice as far away as the nearest one, or std::nullopt if there
  ///   is none within `max_distance`
  virtual std::optional<Vec3> project(const Vec3& point, MaterialOrOutside first, MaterialOrOutside second,
                                      double max_distance) const = 0;

  /// Whether the patches of the mesh's interfaces are known by number, with the creases and corners where
  /// they meet. If so, the queries below are exact. Otherwise they find nothing, and borders of patches in
  /// the mesh are preserved like its junction curves.
  virtual bool has_patches() const { return false; }
  /// Nearest point of a patch of the interface between two regions within `max_distance` (input units).
  virtual std::optional<Vec3> onto_patch(const Vec3& /*point*/, MaterialOrOutside /*first*/,
                                         MaterialOrOutside /*second*/, std::uint16_t /*patch*/,
                                         double /*max_distance*/) const {
    return {};
  }
  /// Nearest point of the creases between any patches within `max_distance` (input units).
  virtual std::optional<Vec3> onto_crease(const Vec3& /*point*/, double /*max_distance*/) const { return {}; }
  /// Nearest corner within `max_distance` (input units).
  virtual std::optional<Vec3> onto_corner(const Vec3& /*point*/, double /*max_distance*/) const { return {}; }
};

}  // namespace tetwright
