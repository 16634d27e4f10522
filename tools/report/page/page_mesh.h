// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "common/tet_mesh.h"
#include "tools/report/page/quantised_points.h"
#include "tools/report/page/surface_distances.h"

namespace tetwright {

/// What bounds the size of the page. With these it has at most 17 MB.
struct PageLimits {
  std::size_t tets = 500'000;  ///< a mesh with more is shown by its skin and the layers behind three cuts
  std::size_t triangles = 250'000;   ///< of that skin
  std::size_t layer_tets = 100'000;  ///< behind each of these cuts; a thicker layer is left out
};

/// The arrays that the page draws, as bytes; README.md has their layout.
struct PageMesh {
  bool whole = true;             ///< all tets are there
  bool coarsened = false;        ///< the skin is not exact, see skin_within()
  std::array<bool, 3> layers{};  ///< not whole: the axes whose middle cut shows tets
  std::size_t point_count = 0, tet_count = 0, triangle_count = 0;
  std::size_t index_bytes = 2;         ///< of an index into the points
  std::size_t material_bytes = 1;      ///< of an index into `materials`
  std::vector<MaterialTag> materials;  ///< ascending
  QuantisedPoints points;
  std::string tets;       ///< four indices each
  std::string tags;       ///< of each tet: index into `materials`
  std::string solid;      ///< 8 bits: smallest solid angle, 255 is the regular tet's
  std::string dihedral;   ///< 8 bits: smallest dihedral angle, 255 is the regular tet's
  std::string layer;      ///< not whole, 8 bits: of which axes' layers the tet is
  std::string triangles;  ///< not whole: three indices each
  std::string sides;     ///< not whole: the materials before and behind each, one more than the last: outside
  std::string distance;  ///< 16 bits for each point, see `max_distance`; 65535: on no interface. May be empty
  double max_distance = 0;  ///< what 65534 stands for, input units
  std::string distance_from;
};

/// The smallest dihedral angle of the regular tet, degrees.
inline constexpr double regular_dihedral = 70.528779365509308;

/// `mesh` has its interfaces, and its ids are in range; `distances` may be null. Parallel; the result does
/// not depend on the threads.
PageMesh page_mesh(const TetMesh& mesh, const SurfaceDistances* distances, const PageLimits& limits = {});

}  // namespace tetwright
