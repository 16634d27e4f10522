// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// The patches of a surface: its parts that are connected across edges of exactly two triangles.
struct ConnectedPatches {
  std::vector<Index> of;  ///< by triangle
  Index count = 0;
  /// By patch: it has an edge that no other triangle has, or would have one without those patches that do.
  std::vector<char> open;
  std::vector<double> area;  ///< by patch, input units squared

  bool any_open() const;
  /// True if some patches are closed together, and of each open patch a part of at least
  /// InputTuning::Walls::inside_share may be inside: its triangles reach into the bounding box of these.
  bool open_within_closed(std::span<const Vec3> points, std::span<const Triangle> triangles) const;
};

/// O(n log n).
ConnectedPatches find_connected_patches(std::span<const Vec3> points, std::span<const Triangle> triangles);

}  // namespace tetwright
