// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "mesher/domain/material_field.h"
#include "mesher/domain/refinement_regions.h"
#include "tetwright/progress.h"

namespace tetwright {

/// The max cell size at a point; both in input units. May be called concurrently.
using MaxCell = std::function<double(const Vec3&)>;

/// The cells of a field's octree that must be split so that none is larger than `max_cell`: inside, by up to
/// three levels below a voxel; at interfaces down to a voxel, which their distances resolve.
/// \param outside also splits cells outside
/// \pre the field is not refined
/// \throws OutputError if the memory does not suffice for these cells
/// \throws Interrupted
RefinementRegions find_sized_cells(const MaterialField& field, const MaxCell& max_cell, bool outside,
                                   Progress* progress);

}  // namespace tetwright
