// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "mesher/domain/grid_frame.h"
#include "tetwright/mesher_input.h"

namespace tetwright {

/// The frame of a volume, continued beyond its border on the sides that bodies come near.
/// \param voxels from label_frame()
/// \param file of the volume, for messages
/// \throws InputError if the cells would be more than can be numbered
GridFrame frame_around(const MesherInput& bodies, const GridFrame& voxels, const std::string& file);

/// The sides of the volume that bodies cross by more than LabelTuning::Border::slack; bits as for
/// box_faces().
/// \param voxels from frame_around()
unsigned crossed_sides(const ImplantedVolume& volume, const GridFrame& voxels);

/// A body whose faces in the border of the volume are continued beyond it, so that its distances do not
/// vanish there. Except for those faces it is what it was within the border. Open surfaces are unchanged.
/// \param voxels from frame_around()
/// \param crossed crossed_sides(), on which nothing is continued
RepairedSurface continued_beyond(const ImplantedVolume& volume, const GridFrame& voxels, unsigned crossed,
                                 RepairedSurface surface);

}  // namespace tetwright
