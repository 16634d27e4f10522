// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "common/mesh/solid_shape.h"
#include "mesher/input/mesher_input.h"

namespace tetwright {

/// The solid of each body's material, in input units: the body without all later ones. Nothing where the
/// surfaces alone do not determine it:
/// - the body, or one that may carve it, is open or intersects itself;
/// - their surfaces meet;
/// - an edge does not have exactly two triangles, or a point has more than one fan of them;
/// - layers are cut from it (the first body).
std::vector<std::optional<SolidShape>> expected_solids(const MesherInput& input);

}  // namespace tetwright
