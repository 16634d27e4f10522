// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "mesher/domain/material_field.h"
#include "tetwright/mesh_quality.h"

namespace tetwright {

/// The solid of a region as the field's voxels represent it, in input units: each voxel is split into six
/// tets (Kuhn 1960), whose edges are cut according to the distances.
/// \param interface_voxels of the field
SolidShape field_solid(const MaterialField& field, const std::vector<MortonKey>& interface_voxels,
                       RegionIndex region);

}  // namespace tetwright
