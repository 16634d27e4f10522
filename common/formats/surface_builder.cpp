#include "common/formats/surface_builder.h"

#include "common/error.h"

namespace tetwright {

void SurfaceBuilder::reserve(std::size_t points, std::size_t triangles) {
  mesh_.points.reserve(points);
  mesh_.triangles.reserve(triangles);
}

void SurfaceBuilder::add_fan(std::span<const std::int64_t> polygon) {
  for (std::size_t k = 2; k < polygon.size(); ++k)
    mesh_.triangles.push_back(
        {static_cast<Index>(polygon[0]), static_cast<Index>(polygon[k - 1]), static_cast<Index>(polygon[k])});
}

TriangleMesh SurfaceBuilder::finish(std::vector<Dropped>* dropped) {
  if (mesh_.triangles.empty())
    throw InputError(file_ + ": there are no triangles in it (" + std::to_string(mesh_.points.size()) +
                     " points); a surface is needed, not a point cloud");
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
  throw InputError(file_ + ": " + place + ": a face names point " + std::to_string(index) +
                   " (counted from 0), but there are " + std::to_string(mesh_.points.size()) +
                   " points; export the file again");
}

}  // namespace tetwright
