// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mesher/cut/cutting.h"
#include "mesher/domain/material_field.h"

namespace tetwright {

/// The thickened walls that remain. The last three members describe the worst point: the largest offset
/// relative to the thickness.
struct ThickenedWalls {
  std::size_t points = 0;     ///< interface points still off a thin wall with parallel sides
  double max_offset = 0;      ///< distance from the wall, lattice units
  double thickness = 0;       ///< of the wall there, lattice units
  Vec3 place = Vec3::Zero();  ///< position, lattice units
};

/// Moves the interfaces of thin walls that the field has thickened (see thin_walls.h) back to their true
/// positions, as far as tets keep solid angles of 0.1 sr. Tets that are already below that get no worse. The
/// result does not depend on the number of threads.
/// \param as_is walls.with_true_walls()
/// \return the walls that could not be moved back
ThickenedWalls recover_thin_walls(CutMesh& mesh, const WallChanges& walls, const MaterialField& as_is);

/// The thickened walls that remain in a mesh whose points have moved since; lattice units.
ThickenedWalls find_thickened_walls(const std::vector<Vec3>& points,
                                    const std::vector<std::uint8_t>& is_on_interface,
                                    const WallChanges& walls, const MaterialField& as_is);

}  // namespace tetwright
