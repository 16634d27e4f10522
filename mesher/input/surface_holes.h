// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "mesher/input/surface_cleaning.h"
#include "tetwright/diagnostic.h"
#include "tetwright/mesher_input.h"

namespace tetwright {

/// Whether an edge has one triangle only. O(n) for closed surfaces.
bool has_free_edges(const std::vector<Triangle>& triangles);

/// Finds the holes of a surface, which are the connected sets of its free edges (*rims*), and closes those
/// that are flat: a *cap* is the part of the rim's plane that the rim encloses, or that lies between several
/// rims in one plane. Its triangles use the points of the rims only and are appended to the surface. Caps of
/// which more than half of the rim turns by more than the feature angle become groups of triangles, so that
/// the rim stays sharp.
///
/// A hole stays open if its cap would intersect the surface or another cap or enclose almost no volume, or
/// if its area is a negligible part of the surface. A surface without free edges is not changed.
///
/// \throws InputError as require_enclosing() does, see OpenSurfaceOptions
///
/// Cost: O(n log n) for surfaces with holes. The result does not depend on the number of threads.
/// \param groups of the surface; groups without a name are appended for sharp caps
/// \return largest first; holes of equal size by their lowest point
std::vector<SurfaceHole> close_flat_holes(CleanedSurface& surface, std::vector<SurfaceRegion>& groups,
                                          const std::string& file, const CapOptions& options,
                                          std::vector<Diagnostic>& findings);

/// Sorts holes by size, largest first; runs of equal sizes by their lowest point: smallest z, then y, then x.
void order_holes(std::vector<SurfaceHole>& holes);

/// Names holes: as the seeds say, the others "cap_1" and so on in their order.
/// \param taken names in use
/// \throws UsageError for a seed that is far from all holes, whose name is taken, or whose hole another one
///   names
void name_holes(std::vector<SurfaceHole>& holes, const std::vector<RegionSeed>& seeds,
                const std::set<std::string>& taken, double diagonal);

}  // namespace tetwright
