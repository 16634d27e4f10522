// SPDX-License-Identifier: Apache-2.0
#include "mesher/cut/cut_off_surface.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace tetwright {

namespace {

using EdgeKey = std::uint64_t;

/// The edges at which the boundary faces on a side of the box change their material or end, ascending: edges
/// with exactly one triangle of a given pair of materials on that side.
std::vector<EdgeKey> find_crease_edges(const TetMesh& mesh) {
  using Sheet = std::pair<std::pair<MaterialTag, MaterialOrOutside>, std::uint16_t>;
  std::vector<std::pair<EdgeKey, Sheet>> sides;
  for (const InterfaceTriangle& t : mesh.interfaces) {
    if (t.patch == 0) continue;
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(t.ids[k], t.ids[(k + 1) % 3]);
      sides.push_back({EdgeKey{low} << 32 | high, {t.pair(), t.patch}});
    }
  }
  std::sort(sides.begin(), sides.end());
  std::vector<EdgeKey> edges;
  for (std::size_t i = 0, j; i < sides.size(); i = j) {
    for (j = i + 1; j < sides.size() && sides[j] == sides[i];) ++j;
    if (j - i == 1 && (edges.empty() || edges.back() != sides[i].first)) edges.push_back(sides[i].first);
  }
  return edges;
}

}  // namespace

CutOffSurface::CutOffSurface(const TetMesh& mesh, std::shared_ptr<const MaterialField> field)
    : field_(std::move(field)) {
  const Eigen::Matrix3d& axes = field_->frame().axes;
  for (int a = 0; a < 3; ++a) normals_[a] = axes.col((a + 1) % 3).cross(axes.col((a + 2) % 3)).normalized();
  const std::vector<EdgeKey> edges = find_crease_edges(mesh);
  std::vector<Index> ids;
  for (const EdgeKey e : edges) {
    ids.push_back(static_cast<Index>(e >> 32));
    ids.push_back(static_cast<Index>(e));
  }
  std::sort(ids.begin(), ids.end());
  std::vector<Vec3> points, corner_points;
  std::vector<ProjectionTree::Item> segments, corners;
  std::vector<Index> used;
  for (std::size_t i = 0, j; i < ids.size(); i = j) {
    for (j = i + 1; j < ids.size() && ids[j] == ids[i];) ++j;
    used.push_back(ids[i]);
    points.push_back(mesh.points[ids[i]]);
    if (j - i == 2) continue;
    const auto c = static_cast<Index>(corner_points.size());
    corner_points.push_back(mesh.points[ids[i]]);
    corners.push_back({{c, c, c}, {}});
  }
  const auto number = [&](EdgeKey id) {
    return static_cast<Index>(std::lower_bound(used.begin(), used.end(), static_cast<Index>(id)) -
                              used.begin());
  };
  for (const EdgeKey e : edges) {
    const Index a = number(e >> 32), b = number(e);
    segments.push_back({{a, b, b}, {}});
  }
  creases_ = ProjectionTree(std::move(points), std::move(segments));
  corners_ = ProjectionTree(std::move(corner_points), std::move(corners));
}

double CutOffSurface::signed_distance(const Vec3& point, MaterialTag material) const {
  const GridFrame& frame = field_->frame();
  const CellBox volume = frame.volume();
  double distance = field_->signed_distance(point, material);
  if (field_->volume()->crosses_border(material)) return distance;
  for (int a = 0; a < 3; ++a) {
    const double along = normals_[a].dot(point - frame.origin);
    const double cell = frame.cell_size * normals_[a].dot(frame.axes.col(a));
    distance = std::max({distance, cell * volume.low[a] - along, along - cell * volume.high[a]});
  }
  return distance;
}

std::optional<Vec3> CutOffSurface::project(const Vec3& point, MaterialOrOutside first,
                                           MaterialOrOutside second, double max_distance) const {
  return onto_patch(point, first, second, 0, max_distance);
}

std::optional<Vec3> CutOffSurface::onto_patch(const Vec3& point, MaterialOrOutside first,
                                              MaterialOrOutside second, std::uint16_t patch,
                                              double max_distance) const {
  if (patch == 0) return field_->project(point, first, second, max_distance);
  const GridFrame& frame = field_->frame();
  const int axis = (patch - 1) / 2;
  const CellBox volume = frame.volume();
  const int side = (patch % 2 == 1 ? volume.low : volume.high)[axis];
  const Vec3& normal = normals_[axis];
  const double off = normal.dot(point - frame.origin - frame.cell_size * side * frame.axes.col(axis));
  if (std::abs(off) > max_distance) return {};
  // Removes the rounding error: the vertices of the mesh lie exactly on the box.
  Vec3 place = frame.to_grid(point - off * normal);
  place[axis] = side;
  return frame.to_input(place);
}

std::optional<Vec3> CutOffSurface::onto_crease(const Vec3& point, double max_distance) const {
  return creases_.nearest(point, {}, max_distance);
}

std::optional<Vec3> CutOffSurface::onto_corner(const Vec3& point, double max_distance) const {
  return corners_.nearest(point, {}, max_distance);
}

}  // namespace tetwright
