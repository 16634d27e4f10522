// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tetwright/label_masks.h"
#include "tetwright/prepare_steps.h"

namespace tetwright {

/// Replaces each folder that holds volumes, and is none itself, by its volumes in the order of their names,
/// as masks. Adds a note of surfaces, tet meshes and .vdb files in it to the
/// report. Folders in it are not searched.
/// \throws UsageError if there is no volume in it, or slices and other volumes
/// \throws InputError if it cannot be read
std::vector<Input> with_masks_of_folders(std::vector<Input> inputs, PrepareReport& report);

/// Whether volumes are masks, whose voxels belong to one material each: several, a named one, or a file of
/// segments that overlap.
/// \throws InputError if a header is malformed
bool are_masks(const std::vector<Input>& volumes);

/// Joins masks to one volume. A mask has the name of its material or file, a segment that in its file. Their
/// tags are those of `names` or, without names, 1, 2, 3 in the order of the inputs; a single file of segments
/// keeps their labels if they differ. Adds overlaps and notes to the report.
/// \param choice receives names and outside label of the joined volume
/// \throws InputError in the cases of the readers and LabelMasks, and if `names` lack a mask
/// \throws NothingToMeshError if all masks are empty
LabelVolume join_masks(std::vector<Input>& volumes, LabelChoice& choice, PrepareRun& run);

/// \param what the inputs for the message: "masks"
/// \throws UsageError that names both files, and says how to name the materials in them
[[noreturn]] void throw_same_name(const std::string& what, const std::string& name, const std::string& file,
                                  const std::string& other);

}  // namespace tetwright
