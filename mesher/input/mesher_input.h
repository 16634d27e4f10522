// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/triangle_mesh.h"
#include "common/types.h"
#include "mesher/input/surface_repair.h"

namespace tetwright {

/// A surface and the material that it encloses.
struct MaterialSurface {
  std::string name;
  MaterialTag tag = 0;
  TriangleMesh surface;
  std::string file;  ///< for messages
};

/// A layer below the first surface that becomes a material of its own.
struct MaterialLayer {
  std::string name;
  MaterialTag tag = 0;
  double thickness = 0;  ///< input units
};

/// Repaired surfaces, ready to be meshed.
struct MesherInput {
  struct Body {
    std::string name;
    MaterialTag tag;
    std::string file;
    RepairedSurface surface;
    std::vector<SurfaceRegion> groups;  ///< groups of the file, see RepairedSurface::groups
  };
  /// A group of triangles of a file, before any repair.
  struct Group {
    SurfaceRegion group;
    double area = 0;            ///< input units squared
    Vec3 place = Vec3::Zero();  ///< the centre of its largest triangle, input units
  };
  std::vector<Body> bodies;           ///< later bodies carve earlier ones
  std::vector<MaterialLayer> layers;  ///< of the first body, outermost first
  std::vector<InputFinding> findings;
  std::vector<Group> groups;  ///< groups with triangles, ascending; repair may leave nothing of them
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();  ///< bounding box of all bodies, input units
};

/// Validates and repairs the surfaces, see repair_surface(). With NestedRule::material every enclosed
/// component becomes a body directly after its encloser, with the smallest free tag from 1 up. Where more
/// than one surface has groups of triangles, groups that have only a number are named after their surface.
///
/// \pre non-empty names differ, and so do tags
/// \throws InputError as repair_surface() does; for coordinates too large or a size too small for areas and
///   volumes in double precision; for two groups of one name
/// \throws UsageError for no surface, two materials of one name or tag, a layer whose thickness is not above
///   0, or more than 60,000 materials
MesherInput make_mesher_input(std::vector<MaterialSurface> surfaces, std::vector<MaterialLayer> layers = {},
                              NestedRule nested = NestedRule::automatic);

/// The longest side of the bounding box, input units.
double longest_side(const MesherInput& input);

/// The largest absolute coordinate of the bounding box, input units.
double largest_coordinate(const MesherInput& input);

}  // namespace tetwright
