// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>

#include "mesher/complex/labelled_complex.h"
#include "tetwright/mesher_input.h"

namespace tetwright {

/// Names the faces that two bodies share and that are in a group of each. They belong to neither alone, so
/// they become a group of their own in MesherInput::groups: NAME+NAME, in the order of the bodies. Their area
/// is subtracted from both groups; one that has no other faces is left out. Adds a note.
/// \pre input.complex
void name_contact_groups(MesherInput& input);

/// Finds the groups of the faces of a complex.
class FaceGroups {
 public:
  /// \pre input.complex; it must outlive this
  explicit FaceGroups(const MesherInput& input);

  /// \return the group made by name_contact_groups() if there is one, otherwise that of the last body with a
  ///   group there, or none
  SurfaceRegion of(Index face) const;

 private:
  const MesherInput& input_;
  std::map<std::array<SurfaceRegion, 2>, SurfaceRegion> joined_;
};

}  // namespace tetwright
