// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "mesher/complex/surface_imprint.h"
#include "tetwright/progress.h"

namespace tetwright {

/// Surfaces of which later ones have adopted triangles of earlier ones.
struct AdoptedContacts {
  SurfaceSoup soup;           ///< surfaces share points and triangles where they are in contact
  std::vector<Index> source;  ///< of each triangle: the triangle of the input it is a part of, or replaces
  bool any = false;
};

/// Replaces what a body has within the tolerance of an earlier one by the earlier one's triangles, divided
/// along the border of that part: the contact is then a part of the earlier surface, whatever facets the
/// later one has. The sides of a thin wedge that are within the tolerance go, too, up to the first edges
/// beyond it. The border moves onto the earlier surface, by up to the tolerance and along it by another.
/// A pair of bodies stays as it is where no such part is found or the bodies would not stay closed.
///
/// O(n log n) for each pair of bodies whose boxes meet.
///
/// \param bodies surfaces from there on are left alone
/// \param tolerance above 0, in the unit of points
/// \param progress may be null
/// \throws Interrupted
AdoptedContacts adopt_contacts(const SurfaceSoup& soup, std::size_t bodies, double tolerance,
                               Progress* progress);

/// Imprints surfaces with adopted triangles.
/// \return nothing if no surface adopts any, or surfaces still meet other than in points and edges; sources
///   are triangles of the soup
/// \throws OutputError as imprint_surfaces()
/// \throws Interrupted
std::optional<ImprintedSurfaces> imprint_adopted(const SurfaceSoup& soup, std::size_t bodies,
                                                 double tolerance, Progress* progress);

}  // namespace tetwright
