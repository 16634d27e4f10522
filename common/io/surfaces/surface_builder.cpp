// SPDX-License-Identifier: Apache-2.0
#include "common/io/surfaces/surface_builder.h"

#include <algorithm>
#include <map>

#include "tetwright/error.h"

namespace tetwright {

void SurfaceBuilder::reserve(std::size_t points, std::size_t triangles) {
  mesh_.points.reserve(points);
  mesh_.triangles.reserve(triangles);
}

void SurfaceBuilder::add_fan(std::span<const std::int64_t> polygon) {
  // Most surfaces have one group, so indices are stored only from the second group on.
  if (group_ != 0 && mesh_.triangle_groups.size() < mesh_.triangles.size())
    mesh_.triangle_groups.resize(mesh_.triangles.size(), 0);
  for (std::size_t k = 2; k < polygon.size(); ++k) {
    mesh_.triangles.push_back(
        {static_cast<Index>(polygon[0]), static_cast<Index>(polygon[k - 1]), static_cast<Index>(polygon[k])});
    if (group_ != 0) mesh_.triangle_groups.push_back(group_);
  }
}

void SurfaceBuilder::take_groups(const std::vector<SurfaceRegion>& groups, std::size_t min_groups) {
  std::vector<std::uint32_t>& of_triangle = mesh_.triangle_groups;
  of_triangle.resize(groups.empty() ? 0 : mesh_.triangles.size(), 0);
  // Number the groups in the order of their first triangles.
  std::map<SurfaceRegion, std::uint32_t> numbers;
  for (std::uint32_t& group : of_triangle) {
    const auto [known, added] =
        numbers.emplace(groups[group], static_cast<std::uint32_t>(mesh_.groups.size()));
    if (added) mesh_.groups.push_back(known->first);
    group = known->second;
  }
  if (mesh_.groups.size() >= min_groups &&
      std::any_of(mesh_.groups.begin(), mesh_.groups.end(), [](const SurfaceRegion& g) { return bool(g); }))
    return;
  mesh_.groups.clear();
  of_triangle.clear();
}

TriangleMesh SurfaceBuilder::finish(std::vector<Dropped>* dropped, const std::vector<SurfaceRegion>& groups,
                                    std::size_t min_groups) {
  if (mesh_.triangles.empty())
    throw InputError(file_ + ": there are no triangles in it (" + std::to_string(mesh_.points.size()) +
                     " points); a surface is needed, not a point cloud");
  take_groups(groups, min_groups);
  if (dropped) dropped_.append_to(*dropped);
  return std::move(mesh_);
}

void SurfaceBuilder::fail_point(const Vec3& point, const std::string& place) const {
  if (!point.allFinite())
    throw InputError(file_ + ": " + place + ": a coordinate of point " + std::to_string(mesh_.points.size()) +
                     " (counted from 0) is not finite: " + std::to_string(point.x()) + " " +
                     std::to_string(point.y()) + " " + std::to_string(point.z()) + "; remove or repair it");
  throw InputError(file_ + ": " + place + ": more than " + std::to_string(no_index - 1) +
                   " points; split the surface");
}

void SurfaceBuilder::fail_index(std::int64_t index, const std::string& place) const {
  throw InputError(file_ + ": " + place + ": a face refers to point " + std::to_string(index) +
                   " (counted from 0), but there are " + std::to_string(mesh_.points.size()) +
                   " points; export the file again");
}

}  // namespace tetwright
