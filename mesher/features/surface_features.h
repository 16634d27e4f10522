// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "mesher/features/complex_patches.h"
#include "mesher/features/given_up_zone.h"
#include "tetwright/mesher.h"
#include "tetwright/mesher_input.h"

namespace tetwright {

/// The patches of all surfaces of an input. Creases are the borders between them.
struct SurfaceFeatures {
  std::vector<SurfacePatches> bodies;
  std::vector<PatchOptions> options;      ///< by which the patches of each body were found
  SheetPatches sheets;                    ///< of the complex, if there is one
  std::optional<ComplexPatches> complex;  ///< likewise; set by settle_features()
  GivenUpZone given_up;                   ///< set by settle_features()
  double cell = 0;                        ///< edge of a finest cell, input units
  std::vector<double> cells;              ///< at each body, at most `cell`; empty: everywhere the same
};

/// Finds the patches of bodies and sheets.
/// \param cell edge of a finest cell, input units; patches that are small for it are merged with neighbours
/// \param cells at each body, if they are smaller there; or empty
/// \throws InputError for more than 65,534 patches
SurfaceFeatures find_features(const MesherInput& input, const MesherOptions& options, double cell,
                              std::vector<double> cells = {});

/// True if there are creases, junctions or named groups to fit.
bool has_features(const MesherInput& input, const SurfaceFeatures& features);

/// The surroundings of bodies.
enum class Surroundings : std::uint8_t {
  outside,
  labels,           ///< of a segmented volume, which the bodies carve
  protected_labels  ///< some of which they do not carve
};

/// Gives up creases where the finished mesh cannot have them, and reports the others in `dense.report`:
/// `features`, `creases`, and the slack that they cause in expected volumes.
/// \param closed_gaps of each body, points on the sides of gaps that are closed, input units
void settle_features(const MesherInput& input, const std::vector<std::vector<Vec3>>& closed_gaps,
                     SurfaceFeatures& features, DenseMesh& dense,
                     Surroundings around = Surroundings::outside);

}  // namespace tetwright
