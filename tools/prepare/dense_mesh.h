// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesher/mesher.h"
#include "tools/prepare/run.h"
#include "tools/prepare/scan_input.h"

namespace tetwright {

/// Meshes the input at the resolution that is asked for or that the target needs. Its field and reference are
/// null where nothing more is made of them. Throws as mesh_surfaces() and mesh_labels() do.
DenseMesh make_dense_mesh(ScanInput input, PrepareRun& run);

}  // namespace tetwright
