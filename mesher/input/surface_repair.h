// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/triangle_mesh.h"
#include "common/types.h"

namespace tetwright {

/// Treatment of components that lie inside other components without intersecting them.
enum class NestedRule {
  automatic,  ///< oriented against the encloser: a cavity, or a body in a cavity; oriented alike: no effect
  cavity,     ///< solids and cavities alternate from the outside to the inside
  solid,      ///< no cavities
  material    ///< closed ones become surfaces of their own
};

/// A surface from which signed distances can be computed: inside is where the generalised winding number is
/// at least 0.5.
struct RepairedSurface {
  std::vector<Vec3> points;  ///< input units, no two equal, all used
  /// Consistently oriented in each component; no repeated triangles, three different corners each.
  std::vector<Triangle> triangles;
  /// Index of each triangle's group in the file (TriangleMesh::groups); empty if the file has none.
  std::vector<std::uint32_t> groups;
  /// The number of triangles of closed components, which come first. All their edges balance, so their
  /// winding number is an integer everywhere off the surface.
  std::size_t closed = 0;
  bool intersects_itself = false;  ///< some triangles meet elsewhere than in shared points and edges
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();  ///< bounding box
  double area = 0;                               ///< input units squared
  /// Input units cubed, without cavities; for open components the volume of their cone from the centre of the
  /// box.
  double volume = 0;
};

/// A defect found in an input, and its treatment.
struct SurfaceFinding {
  std::string what;           ///< plural, for example "boundary edges of holes"
  std::size_t count = 0;      ///< at least 1
  std::optional<Vec3> place;  ///< of the first one, input units
  std::string done;           ///< the treatment
};

/// A finding and the file that it is about.
struct InputFinding {
  std::string file;
  SurfaceFinding finding;
};

struct SurfaceRepair {
  RepairedSurface surface;
  /// With NestedRule::material the enclosed components, oriented outwards; enclosers come first, so that
  /// later surfaces carve earlier ones.
  std::vector<RepairedSurface> nested;
  std::vector<SurfaceFinding> findings;
};

/// Repairs a surface and reports every change, so that a clean closed surface has no findings. Steps, in this
/// order:
///
/// - equal points are merged; unused points, triangles with fewer than three different points and repeated
///   triangles (of either orientation) are removed;
/// - triangles are oriented consistently and split into components, inner walls are removed
///   (surface_components.h);
/// - components that nothing encloses are turned outwards together with those they enclose; enclosed ones are
///   oriented according to `nested` (surface_nesting.h). Only a component that does not intersect the other
///   one counts as enclosed. An open component whose outside is unclear is not turned.
///
/// Holes and self-intersections are kept, since the winding number handles them. A cavity that two
/// overlapping components both enclose is filled, because the winding number there is 1 + 1 - 1.
///
/// Cost: O(n log n + pairs of triangles that intersect). The result does not depend on the number of threads.
/// \throws InputError beginning with `file`: no triangles or only flat ones, coordinates that are not finite,
///   indices out of range, a one-sided surface
SurfaceRepair repair_surface(const TriangleMesh& surface, const std::string& file,
                             NestedRule nested = NestedRule::automatic);

}  // namespace tetwright
