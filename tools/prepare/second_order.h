// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/mesh/curved_elements.h"
#include "tools/prepare/run.h"

namespace tetwright {

/// With order 2 makes the midside nodes of the result, on the surface that it follows where tets stay
/// valid, and reports how many; else does nothing.
void make_second_order(const TetMesh& result, const SurfaceToFollow& surface, PrepareRun& run);

/// Returns the surface that second-order elements of a tet mesh follow: its interfaces, which are copied.
/// Nothing unless order 2 asks for them.
std::optional<SurfaceToFollow> followed_interfaces(const TetMesh& input, const PrepareRun& run);

}  // namespace tetwright
