// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "mesher/input/flat_caps.h"
#include "mesher/input/surface_components.h"
#include "tetwright/diagnostic.h"
#include "tetwright/mesher_input.h"

namespace tetwright {

/// A surface whose triangles are oriented consistently in each component.
struct OrientedSurface {
  std::vector<Vec3> points;  ///< input units
  std::vector<Triangle> triangles;
  std::vector<Index> component;       ///< by triangle
  std::vector<char> closed;           ///< by component
  std::vector<SurfaceRegion> names;   ///< of groups; the first stands for no region
  std::vector<std::uint32_t> groups;  ///< by triangle, index into names

  /// Index of a group, which is appended unless there is one of this name.
  std::uint32_t group(const std::string& name);
  /// Gives the name to triangles in no group that belong to open components.
  void name_open(const std::string& name);
  void add(const Triangle& triangle, Index own_component, std::uint32_t own_group);
};

/// Makes bodies of surfaces with open components, as the options ask.
/// \throws InputError as clean_surface(), add_base() and thicken() do
/// \throws UsageError if both a base and a thickness are asked for, if that is not above 0, and if no surface
/// is
///   open
void close_open_surfaces(std::vector<MaterialSurface>& surfaces, const OpenSurfaceOptions& options,
                         std::vector<Diagnostic>& findings);

/// Throws InputError for a surface most of whose area is in *sheets*: components with one hole that is almost
/// as large as they are, such as a terrain or a membrane, so that closing it encloses next to nothing.
/// \param component by triangle
/// \param rims find_rims() of the triangles
/// \param has_lid by rim: a flat cap closes it that meets the surface at an angle
void require_enclosing(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles,
                       const std::vector<Index>& component, const std::vector<HoleRim>& rims,
                       const std::vector<char>& has_lid, const std::string& file);

}  // namespace tetwright
