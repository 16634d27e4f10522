// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/measurable.h"

#include <algorithm>

#include "common/geometry/box_tree.h"
#include "common/message_text.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

/// Cubes of coordinates and values derived from them stay far below the largest double. Single-precision
/// fields hold up to 1e38.
constexpr double max_coordinate = 1e50;

}  // namespace

void require_measurable(double longest_side, double largest_coordinate, const char* what,
                        const std::string& file) {
  if (largest_coordinate <= max_coordinate && longest_side >= 1 / max_coordinate) return;
  throw InputError(file, 0,
                   "a size of " + short_number(longest_side) + " with coordinates up to " +
                       short_number(largest_coordinate) +
                       " is too large or too small to be measured; scale the " + what +
                       " to between 1e-50 and 1e50");
}

void require_measurable(const TetMesh& mesh, const std::string& file) {
  Box3 box;
  for (const Tet& tet : mesh.tets)
    for (const Index p : tet) box.add(mesh.points[p]);
  double largest = 0;
  for (const Vec3& p : mesh.points) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  require_measurable((box.high - box.low).maxCoeff(), largest, "mesh", file);
}

}  // namespace tetwright
