#pragma once

#include <string>
#include <vector>

#include "common/triangle_mesh.h"
#include "common/types.h"

namespace tetwright {

/// A surface that encloses a volume: every edge is run through as often one way as the other, outermost
/// components are wound outwards (normals point out), cavities inwards. It may intersect itself.
struct ClosedSurface {
  std::vector<Vec3> points;  ///< input units, no two equal
  std::vector<Triangle> triangles;
  Vec3 low, high;  ///< bounding box of the triangles
  double area;     ///< input units squared
  double volume;   ///< input units cubed, cavities taken off
};

/// Makes a closed surface of what a file says: exactly equal points become one, triangles with fewer than
/// three different points and repeated triangles go away, triangles are wound alike where the file does not
/// do it, and components that are inside out (a negative volume and in no other component) are turned over
/// together with what they contain.
///
/// Throws InputError that begins with `file`: no triangles, coordinates that are not finite, indices out of
/// range, a surface with holes (with the number of boundary edges and the place of the first one), a surface
/// that cannot be wound consistently.
ClosedSurface close_surface(const TriangleMesh& surface, const std::string& file);

}  // namespace tetwright
