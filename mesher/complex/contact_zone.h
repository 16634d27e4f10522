// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bitset>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "common/geometry/box_tree.h"
#include "common/geometry/projection_tree.h"
#include "mesher/complex/labelled_complex.h"
#include "mesher/domain/grid_frame.h"

namespace tetwright {

/// An edge of a complex in which bodies touch: the outside is in two or more sectors around it.
struct TouchingEdge {
  std::array<Index, 2> ends;         ///< ascending
  std::vector<RegionIndex> regions;  ///< of the bodies, ascending; two or more
  /// Pairs of them that have a common face at the edge, ascending.
  std::vector<std::pair<RegionIndex, RegionIndex>> joined = {};
};

/// The edges in which bodies touch, ascending.
std::vector<TouchingEdge> touching_edges(const LabelledComplex& complex);

/// Regions and distances around the contacts and junctions of a complex, computed from its triangles: a point
/// belongs to the region on its side of the nearest triangle, so that no gap opens between bodies that share
/// a sheet. Where a region is thinner than a cell between two others, it gives way to one of them (Narrow);
/// so does the outside around lines in which bodies touch, as far as cells need to join them in one piece.
/// Voxel coordinates; immutable, all functions may be called concurrently.
class ContactZone {
 public:
  struct Distance {
    double value;   ///< unsigned
    Vec3 gradient;  ///< unit, away from the surface
  };
  /// The complex's nearest triangle.
  struct Nearest {
    RegionIndex region, across;  ///< on the point's side, and on the other; numbers of the complex
    Distance distance;
  };
  /// A part of a region between two others that face each other.
  struct Narrow {
    RegionIndex across;  ///< on the farther side
    Distance distance;   ///< of the farther side
    double thickness;    ///< sum of the distances of both sides
    double cosine;       ///< between the gradients of both distances
    /// By how much the region gives way: 0 where it is thick enough, and growing continuously.
    double deficit;
    /// Gradient of the deficit. Changes of the angle between both sides are left out: beside plane faces
    /// there are none.
    Vec3 slope;
  };

  ContactZone(const LabelledComplex& complex, const GridFrame& voxels);

  /// True if the voxel that holds the point is in the zone.
  bool contains(const Vec3& point) const;
  /// \pre contains(point)
  Nearest nearest(const Vec3& point) const;
  /// The narrow part of a region that holds the point, or nothing if no third region is near or does not face
  /// the nearest triangle.
  /// \param at nearest(point)
  std::optional<Narrow> narrow(const Vec3& point, const Nearest& at) const;
  /// Distance from the boundary of a region; nothing beyond the band.
  std::optional<Distance> distance(const Vec3& point, RegionIndex region) const;

 private:
  using Mask = std::bitset<512>;

  struct Face {
    std::array<Vec3, 3> corners;
    Vec3 normal;  ///< unit
    RegionIndex behind, front;

    bool bounds(RegionIndex region) const { return behind == region || front == region; }
    RegionIndex across(RegionIndex region) const { return behind == region ? front : behind; }
    /// Ascending.
    std::pair<RegionIndex, RegionIndex> pair() const { return std::minmax(behind, front); }
  };

  /// A point near a line in which bodies touch.
  struct NearLine {
    Vec3 away;  ///< from the nearest point of the line
    /// Distance from the plane across the line's end, at least that along the line less the one from it;
    /// infinite if the line goes on.
    double from_end;
    Vec3 inwards;  ///< gradient of that
  };
  /// Where a line in which bodies touch ends.
  struct EndOfLine {
    Vec3 point;
    Vec3 inwards;  ///< unit, along the line
  };
  /// An end near an edge of its line.
  struct NearEnd {
    Index end;
    Vec3 from;     ///< the edge's point that is nearer to the end along the line
    double along;  ///< distance of that point from the end, along the line
  };

  void add_junctions(const LabelledComplex& complex, const std::vector<Vec3>& points,
                     const std::array<int, 3>& cells);
  void add_narrow_parts(const std::array<int, 3>& cells);
  void add_touching_edges(const LabelledComplex& complex, const std::vector<Vec3>& points);
  /// The nearest line in which both bodies touch, if one is near; with outside_region, any bodies.
  std::optional<NearLine> near_line(const Vec3& point, RegionIndex first, RegionIndex second) const;
  static void give_way(const NearLine& line, Narrow& narrow);
  bool faces_another_pair(const Face& face) const;
  /// The nearest face within `limit` for which `accepts(face)` holds, or null, and the vector from it to the
  /// point.
  template <class Accepts>
  std::pair<const Face*, Vec3> nearest_face(const Vec3& point, double limit, const Accepts& accepts) const;
  void add(const std::vector<std::uint64_t>& keys);

  BoxTree tree_;
  std::vector<std::vector<RegionIndex>> touching_regions_;
  ProjectionTree touching_;  ///< touching_edges(); kinds: indices into touching_regions_ and near_ends_
  std::vector<EndOfLine> ends_;
  std::vector<std::vector<NearEnd>> near_ends_;  ///< by touching edge: ends within reach along its line
  std::vector<Face> faces_;                      ///< in the order of the tree
  std::unordered_map<std::uint64_t, Mask> leaves_;
};

}  // namespace tetwright
