#pragma once

#include <span>
#include <string>

#include "common/triangle_mesh.h"

namespace tetwright {

/// Collects what a surface file says and checks it. Messages name `file` and the place handed in.
class SurfaceBuilder {
 public:
  explicit SurfaceBuilder(std::string file) : file_(std::move(file)) {}

  /// `points` and `triangles` must already have been compared with the size of the file.
  void reserve(std::size_t points, std::size_t triangles);

  /// Throws InputError for a coordinate that is not finite or too many points. `place()` is called
  /// then and gives text such as "line 7" or "byte 120".
  template <class Place>
  void add_point(const Vec3& point, const Place& place) {
    if (!point.allFinite() || mesh_.points.size() >= no_index - 1) fail_point(point, place());
    mesh_.points.push_back(point);
  }

  /// Cuts a polygon into the fan of triangles around its first vertex. Fewer than three vertices are left out
  /// (some programs write loose edges as faces). Indices count from 0 and must be those of points added.
  template <class Place>
  void add_polygon(std::span<const std::int64_t> polygon, const Place& place) {
    for (std::int64_t i : polygon)
      if (i < 0 || static_cast<std::uint64_t>(i) >= mesh_.points.size()) fail_index(i, place());
    add_fan(polygon);
  }

  /// The same for indices the caller has checked or will check, since points may still be to come.
  void add_fan(std::span<const std::int64_t> polygon);

  std::size_t point_count() const { return mesh_.points.size(); }

  /// Throws InputError if there is no triangle.
  TriangleMesh finish();

 private:
  [[noreturn]] void fail_point(const Vec3& point, const std::string& place) const;
  [[noreturn]] void fail_index(std::int64_t index, const std::string& place) const;

  std::string file_;
  TriangleMesh mesh_;
};

}  // namespace tetwright
