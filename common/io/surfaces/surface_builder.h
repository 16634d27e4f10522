// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/io/contents/dropped.h"
#include "common/triangle_mesh.h"

namespace tetwright {

/// Collects the points and polygons of a surface file and checks them. Messages name `file` and the place
/// that the caller gives.
class SurfaceBuilder {
 public:
  explicit SurfaceBuilder(std::string file) : file_(std::move(file)) {}

  /// `points` and `triangles` must already have been compared with the size of the file.
  void reserve(std::size_t points, std::size_t triangles);

  /// Throws InputError for a coordinate that is not finite or too many points. `place()` is called only then
  /// and returns text such as "line 7" or "byte 120".
  template <class Place>
  void add_point(const Vec3& point, const Place& place) {
    if (!point.allFinite() || mesh_.points.size() >= no_index - 1) fail_point(point, place());
    mesh_.points.push_back(point);
  }

  /// Cuts a polygon into the fan of triangles around its first vertex. A polygon of fewer than three vertices
  /// is dropped and counted (some programs write loose edges as faces). Indices count from 0 and must be
  /// those of points added before.
  template <class Place>
  void add_polygon(std::span<const std::int64_t> polygon, const Place& place) {
    for (std::int64_t i : polygon)
      if (i < 0 || static_cast<std::uint64_t>(i) >= mesh_.points.size()) fail_index(i, place());
    if (polygon.size() < 3) dropped_.add("faces of fewer than three vertices");
    add_fan(polygon);
  }

  /// The same for at least three indices that the caller has checked or will check, since a file may name
  /// points before it lists them.
  void add_fan(std::span<const std::int64_t> polygon);

  /// The triangles that follow belong to this group, an index into the groups that finish() gets; 0 before
  /// the first call.
  void begin_group(std::uint32_t group) { group_ = group; }

  /// Counts something that the file holds and the surface has no place for; `kind` is a plural.
  void drop(const std::string& kind, std::size_t n = 1) { dropped_.add(kind, n); }

  std::size_t point_count() const { return mesh_.points.size(); }

  /// Returns the surface and, unless `dropped` is null, appends to it what was dropped. `groups` are those
  /// of begin_group(): of equal ones the first counts, and where fewer than `min_groups` have triangles the
  /// surface gets none. Throws InputError if there is no triangle.
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
