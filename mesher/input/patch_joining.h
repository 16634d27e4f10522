// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "mesher/input/wall_separation.h"
#include "tetwright/mesher_input.h"
#include "tetwright/progress.h"

namespace tetwright {

/// Joins open surfaces that close together, such as the sides of a body in files of their own.
///
/// A surface takes part if nearly all of its border lies on other open surfaces within the contact tolerance.
/// Connected sets of them become one surface each, if it then has cells and no border. It has the name,
/// tag, file and position of the first of them; its groups are called like the surfaces. Surfaces that are
/// closed by flat caps alone are bodies, unless others that take part are not. Surfaces that meet along most
/// of their border, but do not close, are reported and left as they are.
///
/// O(n log n). The joined surface, except for names, does not depend on the order of the surfaces.
/// \param surfaces lose those that are joined with an earlier one
/// \param findings receive what was joined
/// \param progress may be null
/// \return the cells of joined surfaces, by index of the surface
/// \throws InputError as clean_surface() does
/// \throws UsageError for a contact tolerance that is not above 0
/// \throws Interrupted
std::map<std::size_t, WalledSurface> join_patches(std::vector<MaterialSurface>& surfaces,
                                                  const ContactOptions& contact,
                                                  std::vector<Diagnostic>& findings, Progress* progress);

}  // namespace tetwright
