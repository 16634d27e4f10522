// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/tet_mesh.h"
#include "common/types.h"

namespace tetwright {

/// Rule for which edges of a surface are creases.
struct FeatureAngle {
  enum class Rule : std::uint8_t {
    automatic,  ///< as for 35 degrees, if the creases found look like those of a mechanical part
    off,        ///< none
    degrees     ///< edges at which the normal turns by more than `degrees`
  };
  Rule rule = Rule::automatic;
  double degrees = 0;  ///< above 0, below 180
};

struct PatchOptions {
  FeatureAngle angle;
  /// Patches below this area are merged with the neighbour whose border has the smallest sharp fraction;
  /// square of the surface's unit.
  double min_area = 0;
};

/// A surface cut into smooth parts along its creases.
struct SurfacePatches {
  enum class Verdict : std::uint8_t {
    off,           ///< not searched
    smooth,        ///< no edge turns far enough
    scan,          ///< sharp edges whose chains end anywhere: noise
    intersecting,  ///< not searched, since the surface intersects itself
    meeting,       ///< not kept, since the surface meets another one, or itself where gaps are closed
    staircase,     ///< creases nearly everywhere, as on the faces of voxels
    part           ///< there are creases
  };
  Verdict verdict = Verdict::off;
  /// Patch of each triangle, from 0 to count - 1, ascending by each patch's first triangle; all 0 unless the
  /// verdict is `part` or groups were given.
  std::vector<std::uint16_t> patches;
  std::size_t count = 1;
  std::size_t dropped = 0;  ///< patches below PatchOptions::min_area, merged with neighbours
  /// Loose ends: chain ends of edges that turn by more than 15 and 35 degrees, over the number of these
  /// edges.
  double loose_ends_low = 0, loose_ends_high = 0;

  bool any() const { return count > 1; }
};

/// Cuts a surface into patches. Regions grow across edges that turn little; two regions merge if less than
/// half of the length of their border turns by more than the angle. Faceted cylinders and fillets thus stay
/// whole, and creases that fade out within a patch disappear. A plain threshold would let patches leak
/// through every edge that turns a little less.
///
/// Automatic: creases of a mechanical part end at other creases, those of noise end anywhere. A surface is a
/// part unless loose ends exceed 9 % of the edges that turn by 15 degrees or 20 % of those that turn by 35.
///
/// Edges at which a group has other than two triangles are borders, as are edges between triangles of
/// opposite orientation. Triangles without area belong to a neighbour's patch. O(n log n); the result does
/// not depend on the number of threads.
/// \param options min_area is the square of the surface's unit
/// \param groups empty, or a number for each triangle: patches never cross from one group to another, even if
///   the angle is off
/// \param file named in messages
/// \throws InputError if there are more than 65,535 patches (automatic: such a surface is a staircase)
SurfacePatches find_patches(std::span<const Vec3> points, std::span<const Triangle> triangles,
                            const PatchOptions& options, std::span<const std::uint32_t> groups,
                            const std::string& file);

/// Cuts the boundary and the interfaces of a tet mesh into patches, each pair of materials as a group of its
/// own. Sets the patches of `mesh.interfaces`, computing the interfaces if they are empty. Patches are
/// numbered from 0 for each pair, so that a mesh without creases equals one that was not searched. Patches
/// set by readers (other than 0) stay separate.
/// \return count and verdict over all pairs
SurfacePatches find_mesh_patches(TetMesh& mesh, const FeatureAngle& angle, const std::string& file);

/// Creases and corners of a surface by its patches.
struct SurfaceCreases {
  struct Segment {
    std::array<Index, 2> ends;             ///< points, ascending
    std::array<std::uint16_t, 2> patches;  ///< patches that meet in it, ascending
  };
  std::vector<Segment> segments;  ///< ascending by their ends
  /// Points where other than two creases between the same two patches meet, or where a crease turns by more
  /// than 45 degrees; ascending.
  std::vector<Index> corners;
};

/// Creases: edges between triangles of different patches. An edge with more than two triangles has a segment
/// for each pair of patches.
/// \param corner_reach a crease's turn is measured between the chords to its nearest points at least this far
///   away (0: the neighbouring points); only one such corner is kept within that distance, so that a zigzag
///   from triangle to triangle has none
SurfaceCreases find_creases(std::span<const Vec3> points, std::span<const Triangle> triangles,
                            std::span<const std::uint16_t> patches, double corner_reach = 0);

/// Creases and corners as polylines, for comparisons.
struct CreaseCurves {
  std::vector<Vec3> points;
  std::vector<std::array<Index, 2>> segments;  ///< indices into points
  std::vector<Vec3> corners;

  void add(const SurfaceCreases& creases, std::span<const Vec3> surface_points);
};

/// Creases of the boundary and the interfaces of a mesh, between the patches of each pair of materials.
CreaseCurves mesh_creases(const TetMesh& mesh);

/// Junction edges: other than two faces of a pair of materials meet, as where three regions do. No corners.
CreaseCurves mesh_junctions(const TetMesh& mesh);

}  // namespace tetwright
