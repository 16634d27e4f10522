// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "mesher/domain/material_field.h"
#include "mesher/labels/carved_volume.h"
#include "tetwright/mesher_input.h"

namespace tetwright {

/// \throws InputError if a surface that vanished from the mesh is flat or not closed
void validate_encloses(const MesherInput& input, const MesherInput::Body& body);

/// Checks that the mesh has every material of surfaces.
/// \param there by region of the field: 0 if nothing of it is left
/// \throws NothingToMeshError if nothing is left at all
/// \throws InputError that names the vanished material and a remedy
void validate_materials_left(const MesherInput& input, const MaterialField& field,
                             const std::vector<std::uint8_t>& there);

/// \param there by region of the volume
/// \throws InputError that names a label of which bodies leave nothing, or which is smaller than a cell
void validate_carved_labels_left(const ImplantedVolume& volume, const std::vector<std::uint8_t>& there);

/// \param there by body
/// \throws InputError that names a body of which protected labels leave nothing
void validate_unprotected_left(const ImplantedVolume& volume, const std::vector<BodyInLabels>& in_labels,
                               const std::vector<std::uint8_t>& there);

}  // namespace tetwright
