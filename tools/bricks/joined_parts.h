// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tools/bricks/brick_part.h"

namespace tetwright {

/// The coarsened meshes of parts of a volume, as one mesh.
struct JoinedParts {
  TetMesh mesh;  ///< with its interfaces
  /// By point: BrickPart::shared if parts were cut off there, otherwise 0.
  std::vector<std::uint8_t> shared;
  std::vector<std::uint32_t> part;  ///< by point: the last part that has it
};

/// Joins parts at their shared points with equal coordinates, in their order. Parallel.
/// \param parts only their meshes and flags are used
JoinedParts join_parts(const std::vector<BrickPart>& parts);

/// Parts, ascending, whose boundary meets that of another one, since both were moved: nothing else can
/// intersect across a cut, where no face is moved. The number of parts stands for what none has moved.
std::vector<std::size_t> meeting_parts(const JoinedParts& joined, std::size_t parts);

/// The boundary of a part, including the faces where it was cut off.
struct PartBoundary {
  std::vector<Vec3> points;
  std::vector<std::uint8_t> shared;      ///< by point
  std::vector<InterfaceTriangle> faces;  ///< with their patches, none with another side
};
PartBoundary boundary_of(const BrickPart& part);

/// Likewise, of parts that need not be in memory together.
std::vector<std::size_t> meeting_parts(const std::vector<PartBoundary>& parts);

}  // namespace tetwright
