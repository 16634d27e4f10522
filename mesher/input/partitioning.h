// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mesher/input/surface_cleaning.h"
#include "mesher/input/wall_approach.h"
#include "tetwright/mesher_input.h"

namespace tetwright {

/// A surface that divides bodies, oriented and continued beyond its border.
struct Partition {
  std::string name, file;
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  std::vector<char> continued;  ///< by triangle
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
};

/// Cleans a surface that divides bodies, and continues it beyond its border in the planes of the triangles
/// there, except where it would meet a wall at a narrow angle: there it turns onto the wall.
/// \param extend length of the continuation, input units; 0: none
/// \param walls of the bodies
/// \throws InputError as clean_surface() does; if the continued surface would cross itself, or has too long a
///   border
Partition make_partition(const SheetSurface& surface, double extend, const WallApproach& walls,
                         std::vector<Diagnostic>& findings);

/// A body's surface together with the surfaces that divide it.
struct PartitionedSurface {
  CleanedSurface surface;
  std::vector<SurfaceRegion> groups;     ///< those of the body, then one for each partition
  std::size_t body_triangles = 0;        ///< the first ones are the body's
  std::vector<std::uint32_t> partition;  ///< of each triangle after them
  std::vector<char> continued;           ///< likewise
  bool any() const { return !partition.empty(); }
};

/// Adds the partitions whose boxes meet that of the body.
PartitionedSurface with_partitions(const CleanedSurface& body, const std::vector<SurfaceRegion>& groups,
                                   const std::vector<Partition>& partitions);

}  // namespace tetwright
