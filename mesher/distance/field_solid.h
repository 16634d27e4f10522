// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/mesh/solid_shape.h"
#include "mesher/distance/material_field.h"

namespace tetwright {

/// The solid of a region of a field as its voxels show it, in input units: each voxel is split into six tets
/// (Kuhn 1960), and the surface cuts their edges where the distances say. `interface_voxels` are those of the
/// field.
SolidShape field_solid(const MaterialField& field, const std::vector<MortonKey>& interface_voxels,
                       RegionIndex region);

}  // namespace tetwright
