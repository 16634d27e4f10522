// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "mesher/complex/labelled_complex.h"

namespace tetwright {

/// Strips that continue sheets beyond their free borders.
struct SheetBorders {
  std::vector<Vec3> points;         ///< those of the complex, followed by others
  std::vector<Triangle> triangles;  ///< oriented like the sheet
  std::vector<Index> faces;         ///< of each triangle: the face of LabelledComplex::sheets next to it
};

/// Continues each sheet of a complex beyond the edges that have no other triangle, in the planes of the
/// triangles at these edges. Strips may cross other surfaces, and each other at concave corners.
/// \param length input units
SheetBorders continue_sheets(const LabelledComplex& complex, double length);

}  // namespace tetwright
