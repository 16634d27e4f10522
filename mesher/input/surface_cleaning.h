// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tetwright/diagnostic.h"
#include "tetwright/mesher_input.h"
#include "tetwright/surface_mesh.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// A file's surface with merged points and each triangle once, before it is oriented.
struct CleanedSurface {
  std::vector<Vec3> points;           ///< input units, no two equal, all used
  std::vector<Triangle> triangles;    ///< three different corners each, no two with the same
  std::vector<std::uint32_t> groups;  ///< as RepairedSurface::groups
  std::vector<char> two_sided;        ///< by triangle: wound both ways in the file
  std::vector<char> even;             ///< by triangle: listed an even number of times
};

/// Merges equal points, and drops unused points and triangles with equal corners. Keeps one of each set of
/// triangles with the same corners, oriented like the majority, in the group of the first one in the file.
/// \throws InputError beginning with `file`: no triangles or only flat ones, coordinates that are not finite,
///   indices out of range
CleanedSurface clean_surface(const TriangleMesh& surface, const std::string& file,
                             std::vector<Diagnostic>& findings);

/// The points that triangles use, in order; renumbers the triangles accordingly.
std::vector<Vec3> keep_used(const std::vector<Vec3>& points, std::vector<Triangle>& triangles);

/// Orients, splits and arranges a cleaned surface, see repair_surface().
/// \param findings those of cleaning, which come first
SurfaceRepair repair_cleaned(CleanedSurface cleaned, const std::string& file, NestedRule nested,
                             std::vector<Diagnostic> findings);

}  // namespace tetwright
