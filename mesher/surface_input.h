#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/triangle_mesh.h"
#include "common/types.h"

namespace tetwright {

/// What becomes of components inside other ones that they do not intersect.
enum class NestedRule {
  automatic,  ///< wound against the encloser: a cavity, or a body within a cavity; alike: nothing changes
              ///< there
  cavity,     ///< solid and cavity take turns from the outside to the inside
  solid,      ///< no cavities
  material    ///< closed ones become surfaces of their own
};

/// A surface ready to be turned into signed distances: inside is where the generalised winding number is at
/// least 0.5.
struct PreparedSurface {
  std::vector<Vec3> points;  ///< input units, no two equal, all used
  std::vector<Triangle>
      triangles;  ///< wound alike in each component; no repeats, three different corners each
  /// The first so many triangles make up the closed components, all of whose edges balance: there the winding
  /// number is a whole number off the surface.
  std::size_t closed = 0;
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();  ///< bounding box
  double area = 0;                               ///< input units squared
  /// Input units cubed, cavities taken off; of open components their cone from the middle of the box.
  double volume = 0;
};

/// Something in an input that a clean closed surface does not have.
struct SurfaceFinding {
  std::string what;           ///< plural, for example "boundary edges of holes"
  std::size_t count = 0;      ///< at least 1
  std::optional<Vec3> place;  ///< of the first one, input units
  std::string done;           ///< what was done about it
};

/// Something found in an input and what was done about it.
struct InputFinding {
  std::string file;
  SurfaceFinding finding;
};

struct SurfaceInput {
  PreparedSurface surface;
  /// With NestedRule::material the enclosed components, wound outwards, enclosing ones before what they
  /// enclose, so that later ones carve earlier ones.
  std::vector<PreparedSurface> nested;
  std::vector<SurfaceFinding> findings;
};

/// Makes the best of what a file says and lists whatever is done to it, so that a clean closed surface has no
/// findings. In this order:
///
/// - equal points become one; unused points, triangles with fewer than three different points and repeated
///   triangles (whichever way they are wound) go;
/// - triangles are wound alike and in components, inner walls go (surface_components.h);
/// - components that nothing encloses are turned outwards together with what they enclose, and enclosed ones
///   as `nested` says (surface_nesting.h). A component counts as enclosed where it does not intersect the
///   other one. Where an open component's outside is unclear it stays as it is.
///
/// Holes and self-intersections stay: the winding number deals with them. A cavity where two overlapping
/// components both enclose it is filled, as the winding number there is 1 + 1 - 1.
///
/// O(n log n) and pairs of triangles that intersect; the same for any number of threads.
///
/// Throws InputError that begins with `file`: no triangles or only flat ones, coordinates that are not
/// finite, indices out of range, a one-sided surface.
SurfaceInput prepare_surface(const TriangleMesh& surface, const std::string& file,
                             NestedRule nested = NestedRule::automatic);

}  // namespace tetwright
