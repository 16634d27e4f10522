// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "common/mesh/solid_shape.h"
#include "mesher/input/mesher_input.h"

namespace tetwright {

/// The solid of each body's material, in input units: the body without all later ones. Nothing where the
/// surfaces alone do not say it: where the body or one that may carve it is open or intersects itself, where
/// their surfaces meet, where edges have not just two triangles or points more than one fan of them, and of
/// the first body where layers are cut from it.
std::vector<std::optional<SolidShape>> expected_solids(const MesherInput& input);

}  // namespace tetwright
