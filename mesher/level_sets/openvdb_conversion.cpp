// SPDX-License-Identifier: Apache-2.0

// OpenVDB's conversions from and to meshes, in a file of their own because their templates take long to
// compile.
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/SignedFloodFill.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <stdexcept>

#include "common/parallel/counted_loop.h"
#include "mesher/level_sets/openvdb_types.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

/// Presents triangles to OpenVDB with points in double precision. OpenVDB's own adapter takes floats.
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
  bool wasInterrupted(int = -1) { return progress && progress->stopped(); }
};

/// Maps a grid's index coordinates to the world, in doubles throughout.
class IndexToWorld {
 public:
  explicit IndexToWorld(const openvdb::FloatGrid& grid) : transform_(grid.transform()) {
    const openvdb::Vec3d middle = grid.evalActiveVoxelBoundingBox().getCenter();
    const Vec3 o = at(middle);
    mirrors_ =
        (at(middle + openvdb::Vec3d(1, 0, 0)) - o)
            .dot((at(middle + openvdb::Vec3d(0, 1, 0)) - o).cross(at(middle + openvdb::Vec3d(0, 0, 1)) - o)) <
        0;
  }
  bool mirrors() const { return mirrors_; }
  Vec3 at(const openvdb::Vec3d& index) const {
    const openvdb::Vec3d p = transform_.indexToWorld(index);
    return {p.x(), p.y(), p.z()};
  }

 private:
  const openvdb::math::Transform& transform_;
  bool mirrors_;
};

/// The triangles of the zero level, quads split along the shorter diagonal, wound as OpenVDB winds them.
std::vector<Triangle> split_quads(const std::vector<Vec3>& points,
                                  const std::vector<openvdb::Vec3I>& triangles,
                                  const std::vector<openvdb::Vec4I>& quads) {
  std::vector<Triangle> all;
  all.reserve(triangles.size() + 2 * quads.size());
  for (const openvdb::Vec3I& t : triangles) all.push_back({t[0], t[1], t[2]});
  for (const openvdb::Vec4I& q : quads) {
    const auto length = [&](int a, int b) { return (points[q[a]] - points[q[b]]).squaredNorm(); };
    const int first = length(0, 2) <= length(1, 3) ? 0 : 1;
    all.push_back({q[first], q[first + 1], q[first + 2]});
    all.push_back({q[first + 2], q[(first + 3) % 4], q[first]});
  }
  return all;
}

}  // namespace

DistanceGrid DistanceGrid::unsigned_distances(std::span<const Vec3> points,
                                              std::span<const Triangle> triangles, Progress* progress) {
  initialise_openvdb();
  Interrupter interrupter{progress};
  const CountedLoop counted(CountedLoop::divided_by_library);
  auto grid = openvdb::tools::meshToVolume<openvdb::FloatGrid>(
      interrupter, MeshAdapter{points, triangles}, *openvdb::math::Transform::createLinearTransform(1.0),
      static_cast<float>(level_set_band), static_cast<float>(level_set_band),
      openvdb::tools::UNSIGNED_DISTANCE_FIELD);
  // An interrupted conversion returns an incomplete grid.
  if (progress) progress->throw_if_stopped();
  return DistanceGrid(std::make_unique<Impl>(std::move(grid)));
}

void DistanceGrid::fill_outside_band() {
  constexpr auto band = static_cast<float>(level_set_band);
  const CountedLoop counted(CountedLoop::divided_by_library);
  openvdb::tools::signedFloodFillWithValues(impl_->grid->tree(), band, -band);
}

void DistanceGrid::fill_tiles_outside_band(double band) {
  constexpr openvdb::Index level_above_leaves = 1;
  const auto value = static_cast<float>(band);
  const CountedLoop counted(CountedLoop::divided_by_library);
  openvdb::tools::signedFloodFillWithValues(impl_->grid->tree(), value, -value, true, 1, level_above_leaves);
}

TriangleMesh DistanceGrid::zero_surface() const try {
  // Convert in index coordinates, because OpenVDB's points are floats. The copy shares the tree.
  const openvdb::FloatGrid::Ptr local = impl_->grid->copy();
  local->setGridClass(openvdb::GRID_LEVEL_SET);
  local->setTransform(openvdb::math::Transform::createLinearTransform(1.0));
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec3I> triangles;
  std::vector<openvdb::Vec4I> quads;
  {
    const CountedLoop counted(CountedLoop::divided_by_library);
    openvdb::tools::volumeToMesh(*local, points, triangles, quads, 0.0, 0.0);
  }

  TriangleMesh mesh;
  if (quads.empty() && triangles.empty()) return mesh;
  const IndexToWorld to_world(*impl_->grid);
  mesh.points.resize(points.size());
  parallel_for(0, points.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) mesh.points[i] = to_world.at(openvdb::Vec3d(points[i]));
  });
  mesh.triangles = split_quads(mesh.points, triangles, quads);
  // OpenVDB winds them with the outside on the back.
  if (!to_world.mirrors())
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
} catch (const openvdb::Exception& e) {
  throw std::domain_error(e.what());
}

}  // namespace tetwright
