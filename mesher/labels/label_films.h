// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "mesher/labels/label_field.h"
#include "tetwright/mesher.h"
#include "tetwright/mesher_input.h"
#include "tetwright/surface_mesh.h"

namespace tetwright {

/// Finds where interfaces of labels are less than a cell from bodies, so that cells must be halved.
///
/// Between a body's surface and an interface, or the border of the volume, measured along the outer normal,
/// the body leaves a film of a label; cells are halved until one fits into it. Films thinner than `layer` are
/// left to the layer around bodies (CarvedField), but where they end at creases, along which interfaces run
/// there, cells are halved until they are as small as the layer. Parallel over triangles.
/// \param patches of each body
/// \param labels unrefined
/// \param layer voxels of the frame
/// \return points along surfaces and creases
std::vector<RefinementRegion> find_films(const MesherInput& bodies,
                                         const std::vector<SurfacePatches>& patches, const LabelField& labels,
                                         double layer);

}  // namespace tetwright
