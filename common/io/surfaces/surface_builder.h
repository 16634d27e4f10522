// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tetwright/io.h"
#include "tetwright/surface_mesh.h"

namespace tetwright {

/// Collects and checks the points and polygons of a surface file. Messages name `file` and the location given
/// by the caller.
class SurfaceBuilder {
 public:
  explicit SurfaceBuilder(std::string file) : file_(std::move(file)) {}

  /// \pre `points` and `triangles` have been compared with the size of the file
  void reserve(std::size_t points, std::size_t triangles);

  /// \param place returns the location for messages, such as "line 7" or "byte 120"; called only for an error
  /// \throws InputError if a coordinate is not finite or there are too many points
  template <class Place>
  void add_point(const Vec3& point, const Place& place) {
    if (!point.allFinite() || mesh_.points.size() >= no_index - 1) fail_point(point, place());
    mesh_.points.push_back(point);
  }

  /// Splits a polygon into the fan of triangles around its first vertex. A polygon of fewer than three
  /// vertices is dropped and counted (some programs write loose edges as faces).
  /// \param polygon indices, from 0, of points added before
  /// \throws InputError if an index is out of range
  template <class Place>
  void add_polygon(std::span<const std::int64_t> polygon, const Place& place) {
    for (std::int64_t i : polygon)
      if (i < 0 || static_cast<std::uint64_t>(i) >= mesh_.points.size()) fail_index(i, place());
    if (polygon.size() < 3) dropped_.add("faces of fewer than three vertices");
    add_fan(polygon);
  }

  /// Adds a fan of at least three vertices. The caller checks the indices, before or afterwards, since a file
  /// may refer to points before it lists them.
  void add_fan(std::span<const std::int64_t> polygon);

  /// Assigns subsequent triangles to a group, given by its index in the groups of finish(). The initial group
  /// is 0.
  void begin_group(std::uint32_t group) { group_ = group; }

  /// Counts contents that the surface cannot hold.
  /// \param kind a plural
  void drop(const std::string& kind, std::size_t n = 1) { dropped_.add(kind, n); }

  std::size_t point_count() const { return mesh_.points.size(); }

  /// Returns the surface.
  /// \param dropped receives the dropped contents; may be null
  /// \param groups indexed by begin_group(); duplicates are merged into the first
  /// \param min_groups if fewer groups have triangles, the surface gets no groups
  /// \throws InputError if there is no triangle
  TriangleMesh finish(std::vector<Dropped>* dropped, const std::vector<SurfaceRegion>& groups = {},
                      std::size_t min_groups = 2);

 private:
  [[noreturn]] void fail_point(const Vec3& point, const std::string& place) const;
  [[noreturn]] void fail_index(std::int64_t index, const std::string& place) const;

  void take_groups(const std::vector<SurfaceRegion>& groups, std::size_t min_groups);

  std::string file_;
  TriangleMesh mesh_;
  std::uint32_t group_ = 0;
  KindCounts dropped_;
};

}  // namespace tetwright
