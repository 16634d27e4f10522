// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/types.h"

namespace tetwright {

/// A connected component of the surface of a solid.
struct SolidShell {
  Vec3 place = Vec3::Zero();  ///< first point of its first triangle
  double volume = 0;          ///< input units cubed; negative if oriented inwards: a cavity
  std::ptrdiff_t handles = 0;
  std::size_t triangles = 0;
};

/// A solid, described by its shells. A solid in space has as many handles (first Betti number) as all of its
/// shells together.
struct SolidShape {
  /// False if some edge does not have exactly two triangles of opposite direction: then handles are
  /// meaningless, and parts that meet in such an edge count as separate.
  bool manifold = true;
  bool touches_itself = false;     ///< at some point without a common edge
  std::vector<SolidShell> shells;  ///< in the order of their first triangles

  double volume() const;
  std::size_t components() const;  ///< shells oriented outwards
  std::size_t cavities() const { return shells.size() - components(); }
  std::ptrdiff_t handles() const;
};

/// Analyses the solid bounded by closed triangles oriented outwards. Points at which fans of triangles meet
/// without a common edge count once for each fan. O(n log n), 120 bytes for each triangle; parallel except
/// for the chaining of triangles. The result does not depend on the number of threads.
/// \pre ids below the number of points; no intersections
SolidShape solid_shape(std::span<const Vec3> points, std::span<const Triangle> triangles);

}  // namespace tetwright
