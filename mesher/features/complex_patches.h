// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "mesher/complex/labelled_complex.h"
#include "tetwright/mesher_input.h"

namespace tetwright {

/// The patches of a complex: the faces of one pair of regions that belong to the same patch of each of the
/// bodies whose surface they are.
struct ComplexPatches {
  /// The complex's points; with inner sheets, further ones.
  std::vector<Vec3> points;
  /// The faces of the complex, towards the outside if that is on one side; then those of inner sheets and of
  /// their continuations.
  std::vector<Triangle> triangles;
  std::vector<std::uint16_t> patches;  ///< of each triangle
  /// A *sheet* is the faces of one pair of regions, ascending.
  std::map<std::pair<RegionIndex, RegionIndex>, std::size_t> sheets;
  /// Also a sheet: the faces of one component of inner sheets in one region.
  std::map<std::pair<std::uint32_t, RegionIndex>, std::size_t> inner_sheets;
  std::vector<std::size_t> sheet_of_patch;
  /// Patches from this number on continue inner sheets beyond their free borders, see continue_sheets(). They
  /// belong to the same sheet.
  std::uint16_t first_continued = 0;
  /// Surface region of the input that each patch belongs to, or none; see FaceGroups.
  std::vector<SurfaceRegion> groups;
  std::vector<std::uint8_t> rough;             ///< of each patch, see SurfacePatches::rough
  std::vector<std::array<Index, 2>> touching;  ///< edges of touching_edges(), ascending: no creases
};

/// The patches of inner sheets.
struct SheetPatches {
  SurfacePatches found;  ///< of LabelledComplex::sheets
  double continued = 0;  ///< length of the strips beyond free borders, input units
};

/// \pre input.complex
/// \param patches of each body's surface
/// \param cell edge of a finest cell, input units; parts of patches far below a cell join their neighbours
/// \throws InputError for more than 65,534 patches
ComplexPatches complex_patches(const MesherInput& input, const std::vector<SurfacePatches>& patches,
                               const SheetPatches& of_sheets, double cell);

}  // namespace tetwright
