// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "mesher/input/sheet_surfaces.h"
#include "tetwright/mesher_input.h"
#include "tetwright/progress.h"

namespace tetwright {

/// The distance up to which surfaces are in contact, input units.
/// \param diagonal of the bounding box of all surfaces, input units
/// \throws UsageError if it is not above 0
double contact_tolerance(const ContactOptions& options, double diagonal);

/// Checks that a body is well above the tolerance.
/// \param size diagonal of the body's bounding box, input units
/// \throws InputError beginning with `file`
void require_larger_than_tolerance(double size, double tolerance, const std::string& name,
                                   const std::string& file);

/// Joins closed bodies that meet: sets MesherInput::complex, contacts and overlaps, and replaces the surfaces
/// of the bodies by what they are in the complex. Nothing changes if no two surfaces come closer than the
/// tolerance. Sheets become faces of the complex inside its regions; parts that are in no region or on other
/// faces are reported.
/// \param progress may be null
/// \throws InputError for surfaces that cannot be joined, a body that the tolerance swallows, bodies that
///   cross with OverlapRule::error, sheets in bodies that are not closed, and a sheet that is in no body
/// \throws UsageError for a tolerance that is not above 0
/// \throws Interrupted
void join_bodies(MesherInput& input, const SheetSoup& sheets, const ContactOptions& options,
                 Progress* progress);

}  // namespace tetwright
