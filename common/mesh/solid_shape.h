// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/types.h"

namespace tetwright {

/// A connected part of the surface of a solid.
struct SolidShell {
  Vec3 place = Vec3::Zero();  ///< the first point of its first triangle
  double volume = 0;          ///< input units cubed; below 0 where it is wound inwards: a cavity
  std::ptrdiff_t handles = 0;
  std::size_t triangles = 0;
};

/// A solid, by the shells around it. A solid in space has as many handles (first Betti number) as all of its
/// shells together.
struct SolidShape {
  /// False where some edge has not just two triangles wound opposite ways: then handles mean nothing, and
  /// parts that meet in such an edge count as separate.
  bool manifold = true;
  bool touches_itself = false;     ///< in some point without a common edge
  std::vector<SolidShell> shells;  ///< in the order of their first triangles

  double volume() const;
  std::size_t components() const;  ///< shells wound outwards
  std::size_t cavities() const { return shells.size() - components(); }
  std::ptrdiff_t handles() const;
};

/// The solid inside closed triangles wound outwards, which must not intersect: ids below the number of
/// points. Points at which fans of triangles meet without a common edge count once for each fan. O(n log n),
/// 120 bytes for each triangle; parallel but for the chaining of triangles. The result does not depend on the
/// threads.
SolidShape solid_shape(std::span<const Vec3> points, std::span<const Triangle> triangles);

}  // namespace tetwright
