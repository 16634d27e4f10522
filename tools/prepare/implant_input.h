// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tetwright/prepare_steps.h"

namespace tetwright {

/// Removes the surfaces from inputs with a volume: they are bodies that carve its labels.
/// \param label_file the .vdb file that holds labels, or null; other .vdb files hold level sets
/// \return the surfaces, in their order
/// \throws UsageError if a surface comes before a volume
std::vector<Input> take_implants(std::vector<Input>& inputs, const Input* label_file);

/// Puts bodies into a volume. Their tags become free ones above those of the labels. Adds findings to the
/// report.
/// \throws UsageError if LabelOptions::protected_labels names a label that the volume does not have
/// \throws Error in the cases of make_implanted_volume()
ImplantedVolume join_implants(LabelInput labels, MesherInput bodies, PrepareRun& run);

/// Enters what bodies take of the labels into the report, by which labels and contacts are compared.
void report_carving(const CarvedLabels& carved, VolumeReport& volume);

}  // namespace tetwright
