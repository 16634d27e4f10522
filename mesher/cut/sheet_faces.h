// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "mesher/cut/cutting.h"
#include "mesher/level_sets/sheeted_field.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// The parts of regions, on either side of sheets, that the tets of a mesh are in.
struct SheetParts {
  std::shared_ptr<const SheetedField> field;
  std::vector<RegionIndex> of_tets;  ///< regions of the field
};

/// A face between two parts.
struct PartFace {
  Triangle ids;
  Index first, second;  ///< tets
};

/// The faces between different parts.
std::vector<PartFace> part_faces(const TetMesh& mesh, const SheetParts& parts);

/// The faces between two parts of a region that are on opposite sides of a sheet, also where the sheet is
/// continued beyond its border. Their material is that on both sides, the normal points to the front of the
/// sheet, and the patch is the number of the sheet's component.
std::vector<InterfaceTriangle> sheet_faces(const TetMesh& mesh, const SheetParts& parts);

/// The regions of the field without sheets.
std::vector<RegionIndex> regions_without_sheets(const std::vector<RegionIndex>& regions,
                                                const SheetedField& field);

/// By point: 1 if it is on the boundary of a region of the field without sheets.
std::vector<std::uint8_t> on_interfaces_without_sheets(const CutMesh& mesh, const SheetedField& field);

}  // namespace tetwright
