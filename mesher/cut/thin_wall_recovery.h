// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mesher/cut/cutting.h"
#include "mesher/distance/material_field.h"

namespace tetwright {

/// What is left of thickened walls.
struct ThickenedWalls {
  std::size_t points = 0;     ///< of interfaces that are still off a thin wall with parallel sides
  double max_offset = 0;      ///< how far one of them is off, lattice units
  double thickness = 0;       ///< of the wall there, lattice units
  Vec3 place = Vec3::Zero();  ///< that point, lattice units
};

/// Moves the interfaces of thin walls, which the field has thickened (see thin_walls.h), back to where they
/// are, as far as tets keep solid angles of 0.1 sr; tets that are worse already get no worse. `as_is` is
/// field.with_true_walls(). Returns what could not be moved. The same result for any number of threads.
ThickenedWalls recover_thin_walls(CutMesh& mesh, const MaterialField& field, const MaterialField& as_is);

/// What is left of thickened walls in a mesh whose points have moved since. Lattice units.
ThickenedWalls find_thickened_walls(const std::vector<Vec3>& points,
                                    const std::vector<std::uint8_t>& is_on_interface,
                                    const MaterialField& field, const MaterialField& as_is);

}  // namespace tetwright
