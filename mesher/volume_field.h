// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "mesher/domain/refinement_regions.h"
#include "mesher/labels/label_field.h"
#include "tetwright/mesher.h"
#include "tetwright/mesher_input.h"

namespace tetwright {

/// Field and cells that determine the mesh of a segmented volume.
struct VolumeField {
  std::shared_ptr<const LabelField> field;  ///< unrefined
  RefinementRegions finer;                  ///< cells that are halved because labels are thin
};

/// Computes the distances of the labels and finds the cells that are halved.
/// \param bodies that are put into the volume, or null: the frame continues where they come near its border
/// \param report receives cell size, estimate, thin parts and creases
/// \throws UsageError for options that conflict with the labels
/// \throws Interrupted
VolumeField make_volume_field(const LabelInput& labels, const MesherOptions& options, MesherReport& report,
                              Progress* progress, const MesherInput* bodies = nullptr);

/// Checks that the mesh has every label.
/// \param there by region: 0 if nothing of it is left
/// \throws NothingToMeshError if nothing is left at all
/// \throws InputError naming a label of which nothing is left
void validate_materials_left(const LabelInput& labels, const std::vector<std::uint8_t>& there);

}  // namespace tetwright
