// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "mesher/complex/labelled_complex.h"
#include "tetwright/mesher.h"

namespace tetwright {

/// Points between sheets inside a body that face each other at less than two cells: there cells must be
/// halved until two fit in, or the sheets run into each other. Sheets that meet are not narrow where they
/// converge at more than 45 degrees. O(samples log n); the result does not depend on the number of threads.
/// \param cell edge of a finest cell, input units
std::vector<RefinementRegion> find_narrow_sheets(const LabelledComplex& complex, double cell);

}  // namespace tetwright
