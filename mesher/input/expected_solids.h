// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "common/mesh/solid_shape.h"
#include "mesher/input/mesher_input.h"

namespace tetwright {

/// The solid of a material by its surface and those that carve it.
struct SurfaceSolid {
  /// Input units. Nothing for SurfaceFlaw::open and meeting, and where edges have not just two triangles.
  std::optional<SolidShape> shape;
  SurfaceFlaw flaw = SurfaceFlaw::none;  ///< the first one that is found; none: `shape` is certain
};

/// The solid of each body's material: the body without all later ones. Nothing for the first body where
/// layers are cut from it.
std::vector<std::optional<SurfaceSolid>> expected_solids(const MesherInput& input);

}  // namespace tetwright
