// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/progress.h"
#include "mesher/distance/material_field.h"
#include "mesher/domain/refinement_regions.h"

namespace tetwright {

/// The largest cell that is wanted at a place; both in input units. May be called concurrently.
using MaxCell = std::function<double(const Vec3&)>;

/// The cells of a field's octree that must be split so that none is larger than `max_cell` asks for: inside,
/// by up to max_refinement levels below a voxel; at interfaces down to a voxel, which their distances show.
/// With `outside` there as well. The field must not be refined. Throws OutputError where these are more cells
/// than memory is there for, Interrupted.
RefinementRegions find_sized_cells(const MaterialField& field, const MaxCell& max_cell, bool outside,
                                   Progress* progress);

}  // namespace tetwright
