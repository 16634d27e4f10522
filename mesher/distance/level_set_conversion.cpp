// OpenVDB's conversion of meshes, whose templates take by far the longest of all to compile.
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/SignedFloodFill.h>

#include "mesher/distance/level_set_grid.h"

namespace tetwright {

namespace {

/// The triangles as OpenVDB wants them.
struct MeshAdapter {
  std::span<const Vec3> points;
  std::span<const Triangle> triangles;
  std::size_t polygonCount() const { return triangles.size(); }
  std::size_t pointCount() const { return points.size(); }
  std::size_t vertexCount(std::size_t) const { return 3; }
  void getIndexSpacePoint(std::size_t n, std::size_t v, openvdb::Vec3d& out) const {
    const Vec3& p = points[triangles[n][v]];
    out = {p.x(), p.y(), p.z()};
  }
};

struct Interrupter {
  Progress* progress;
  void start(const char* = nullptr) {}
  void end() {}
  bool wasInterrupted(int = -1) { return progress && progress->cancelled(); }
};

}  // namespace

DistanceGrid::Ptr unsigned_distances(std::span<const Vec3> points, std::span<const Triangle> triangles,
                                     Progress* progress) {
  initialise_openvdb();
  Interrupter interrupter{progress};
  DistanceGrid::Ptr grid = openvdb::tools::meshToVolume<DistanceGrid>(
      interrupter, MeshAdapter{points, triangles}, *openvdb::math::Transform::createLinearTransform(1.0),
      static_cast<float>(level_set_band), static_cast<float>(level_set_band),
      openvdb::tools::UNSIGNED_DISTANCE_FIELD);
  // An interrupted conversion hands back whatever it has so far.
  if (progress) progress->throw_if_cancelled();
  return grid;
}

void fill_outside_band(DistanceGrid& grid) {
  constexpr auto band = static_cast<float>(level_set_band);
  openvdb::tools::signedFloodFillWithValues(grid.tree(), band, -band);
}

void fill_tiles_outside_band(DistanceGrid& grid, float band) {
  constexpr openvdb::Index level_above_leaves = 1;
  openvdb::tools::signedFloodFillWithValues(grid.tree(), band, -band, true, 1, level_above_leaves);
}

}  // namespace tetwright
