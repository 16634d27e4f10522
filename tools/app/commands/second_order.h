// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/mesh/curved_elements.h"
#include "tools/app/commands/command_run.h"

namespace tetwright {

/// With --order 2 makes the midside nodes of the result, on the surface that it follows where tets stay
/// valid, and reports how many; else does nothing.
void make_second_order(const TetMesh& result, const SurfaceToFollow& surface, CommandRun& run);

/// What the second-order elements made of a tet mesh follow: its interfaces, which are copied. Nothing unless
/// --order 2 asks for them.
std::optional<SurfaceToFollow> followed_interfaces(const TetMesh& input, const CommandRun& run);

}  // namespace tetwright
