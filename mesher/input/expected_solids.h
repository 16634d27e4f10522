// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "tetwright/mesh_quality.h"
#include "tetwright/mesher.h"
#include "tetwright/mesher_input.h"

namespace tetwright {

/// The solid of a material, derived from its surface and the surfaces that carve it.
struct SurfaceSolid {
  /// Input units. Nothing for SurfaceFlaw::open, for meeting surfaces that were not joined, and if an edge
  /// does not have exactly two triangles or a point has more than one fan of them.
  std::optional<SolidShape> shape;
  SurfaceFlaw flaw = SurfaceFlaw::none;  ///< the first one found; none: `shape` is certain
};

/// The solid of each body's material: the body without all later ones. std::nullopt for the first body if
/// layers are cut from it.
std::vector<std::optional<SurfaceSolid>> expected_solids(const MesherInput& input);

/// Area, pieces and border of each sheet inside bodies; empty if there are none.
std::vector<ExpectedSheet> expected_sheets(const MesherInput& input);

}  // namespace tetwright
