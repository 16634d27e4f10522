// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Number of a region inside an EditableMesh: a material, by its index among the ascending tags, or outside.
using RegionId = std::uint32_t;
inline constexpr RegionId outside_id = 0xffffffffu;

/// Number of a patch: a part of the boundary or of an interface that keeps its identity. Faces between the
/// same two regions that differ in their patch meet in a junction curve: a feature edge, or crease.
using PatchId = std::uint16_t;

/// A tet's entry for one of its faces: the tet across it and whether the face is kept as an interface, or
/// outside and the patch of the boundary face. 4 bytes.
class FaceLink {
 public:
  constexpr FaceLink() = default;
  /// \pre tet < max_tets.
  static constexpr FaceLink to(Index tet, bool interface) { return FaceLink(interface ? tet | flag : tet); }
  static constexpr FaceLink outside(PatchId patch) { return FaceLink(~std::uint32_t{patch}); }

  constexpr bool is_outside() const { return word_ >= first_outside; }
  /// Whether the regions on both sides differ (outside counts as a region) or the face belongs to a sheet,
  /// an interface with the same region on both sides.
  constexpr bool is_interface() const { return (word_ & flag) != 0; }
  /// The tet across the face; no_index: outside.
  constexpr Index tet() const { return is_outside() ? no_index : word_ & ~flag; }
  /// Patch of a boundary face.
  constexpr PatchId patch() const { return static_cast<PatchId>(~word_); }
  constexpr bool operator==(const FaceLink&) const = default;

  /// Max number of tets, given the bits for the flag and the codes for outside.
  static constexpr std::size_t max_tets = std::size_t{1} << 30;

 private:
  static constexpr std::uint32_t flag = 0x80000000u, first_outside = 0xffff0000u;
  explicit constexpr FaceLink(std::uint32_t word) : word_(word) {}
  std::uint32_t word_ = ~std::uint32_t{0};
};

/// The connectivity of a tet: half a cache line, and all that a walk through the mesh reads.
struct alignas(32) TetRecord {
  Tet points;                     ///< no_index four times: dead
  std::array<FaceLink, 4> links;  ///< across the face opposite each point
};
static_assert(sizeof(TetRecord) == 32);

/// The points of a face, as seen from outside of a positive tet.
inline Triangle face_of(const Tet& points, int face) {
  const auto& c = tet_faces[face];
  return {points[c[0]], points[c[1]], points[c[2]]};
}

/// Slot of `point` in a tet. Branch-free, since the branches would be unpredictable.
/// \pre The tet has the point.
inline int slot_in(const Tet& points, Index point) {
  return (points[1] == point) + 2 * (points[2] == point) + 3 * (points[3] == point);
}

/// Placeholder for the point that an operation is about to add, until it gets a number.
inline constexpr Index unnumbered_point = no_index - 1;

inline constexpr Tet dead_tet{no_index, no_index, no_index, no_index};

/// A face between two regions, one of which may be outside, or a face of a sheet.
struct InterfaceFace {
  Triangle ids;  ///< the normal points out of `inside`
  RegionId inside, across;
  PatchId patch;

  bool is_sheet() const { return inside == across; }
};

}  // namespace tetwright
