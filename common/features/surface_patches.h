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

/// Which edges of a surface are creases.
struct FeatureAngle {
  enum class Rule : std::uint8_t {
    automatic,  ///< as for 35 degrees, if the creases found look like those of a part
    off,        ///< none
    degrees     ///< those whose triangles turn by more than `degrees`
  };
  Rule rule = Rule::automatic;
  double degrees = 0;  ///< above 0, below 180
};

struct PatchOptions {
  FeatureAngle angle;
  /// Smaller patches go to the neighbour that they turn from along the smallest share of their border.
  double min_area = 0;
};

/// A surface cut into smooth parts along its creases.
struct SurfacePatches {
  enum class Verdict : std::uint8_t {
    off,           ///< not looked for
    smooth,        ///< no edge turns far enough
    scan,          ///< edges turn far, but what they make up ends anywhere: noise
    intersecting,  ///< not looked for, since the surface intersects itself
    meeting,       ///< not kept, since the surface meets another one, or itself where gaps are closed
    staircase,     ///< creases nearly everywhere, as on the faces of voxels
    part           ///< there are creases
  };
  Verdict verdict = Verdict::off;
  /// For each triangle, from 0 to count - 1, ascending by each patch's first triangle; all 0 unless the
  /// verdict is part or groups were given.
  std::vector<std::uint16_t> patches;
  std::size_t count = 1;
  std::size_t dropped = 0;  ///< smaller than PatchOptions::min_area: they went to neighbours
  /// Shares of the edges that turn by more than 15 and 35 degrees at which a chain of them ends.
  double loose_ends_low = 0, loose_ends_high = 0;

  bool any() const { return count > 1; }
};

/// Cuts a surface into patches: triangles hang together where they turn little, and where the border between
/// two such parts turns by more than the angle along less than half of its length they are one. Cylinders
/// and fillets of facets stay whole, and creases that fade out within a patch are none. In place of a plain
/// threshold, after which patches leak through every edge that turns a little less.
///
/// Automatic: the creases of a part end at other creases, those of noise end anywhere. It is a part unless
/// loose ends are more than 9 % of the edges that turn by 15 degrees or 20 % of those that turn by 35.
///
/// `options.min_area` is the square of the surface's unit. `groups`: empty, or a number for each triangle:
/// patches never cross from one to another, even where the angle is off. Edges at which a group has other
/// than two triangles are borders; so are those of triangles that are oriented against each other, and
/// triangles without area belong to what is beside them.
///
/// `file` is named in messages. Throws InputError where there are more than 65,535 patches (automatic: such a
/// surface is a staircase). O(n log n); the
/// result does not depend on threads.
SurfacePatches find_patches(std::span<const Vec3> points, std::span<const Triangle> triangles,
                            const PatchOptions& options, std::span<const std::uint32_t> groups,
                            const std::string& file);

/// The same of the boundary and the interfaces of a tet mesh, each pair of materials a group of its own:
/// gives `mesh.interfaces`, which it finds if they are empty, their patches, numbered from 0 for each pair,
/// so that a mesh without creases is as if nobody had looked for any. The count and the verdict are those of
/// all of them; what readers gave (patches other than 0) stays apart.
SurfacePatches find_mesh_patches(TetMesh& mesh, const FeatureAngle& angle, const std::string& file);

/// Creases and corners of a surface by its patches.
struct SurfaceCreases {
  struct Segment {
    std::array<Index, 2> ends;             ///< points, ascending
    std::array<std::uint16_t, 2> patches;  ///< that meet in it, ascending
  };
  std::vector<Segment> segments;  ///< ascending by their ends
  /// Points where other than two creases of the same two patches meet, or one turns by more than 45 degrees;
  /// ascending.
  std::vector<Index> corners;
};

/// Edges with two triangles of different patches; an edge with more than two has a segment for each two
/// patches. How far a crease turns is measured between the chords to the places on it that are at least
/// `corner_reach` away (0: the neighbouring points), and within that there is only one such corner: a zigzag
/// from triangle to triangle has none.
SurfaceCreases find_creases(std::span<const Vec3> points, std::span<const Triangle> triangles,
                            std::span<const std::uint16_t> patches, double corner_reach = 0);

/// Creases and corners by themselves, to be compared with.
struct CreaseCurves {
  std::vector<Vec3> points;
  std::vector<std::array<Index, 2>> segments;  ///< indices into points
  std::vector<Vec3> corners;

  void add(const SurfaceCreases& creases, std::span<const Vec3> surface_points);
};

/// Those of the boundary and the interfaces of a mesh, between the patches of each pair of materials.
CreaseCurves mesh_creases(const TetMesh& mesh);

/// The edges in which other than two faces of a pair of materials meet: where three regions do. No corners.
CreaseCurves mesh_junctions(const TetMesh& mesh);

}  // namespace tetwright
