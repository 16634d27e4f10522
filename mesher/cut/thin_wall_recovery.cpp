// SPDX-License-Identifier: Apache-2.0
#include "mesher/cut/thin_wall_recovery.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "common/mesh/mesh_faces.h"
#include "common/parallel/parallel.h"
#include "common/parallel/parallel_sort.h"
#include "mesher/cut/backtracking_displacement.h"
#include "mesher/cut/undo_intersections.h"

namespace tetwright {

namespace {

constexpr std::size_t wall_point_grain = 1024;
/// A wall counts as recovered within this fraction of its thickness.
constexpr double restored_share = 0.1;
/// Remaining moves are tried again in another pass, since their neighbours have moved too.
constexpr int restoring_passes = 3;
/// Lattice units: half of the largest thickening, and as much again for a point that has moved on from there.
constexpr double max_step = 1.25;

/// The moves that return points displaced by thickened walls.
std::vector<PointMove> find_moves(const std::vector<Vec3>& points,
                                  const std::vector<std::uint8_t>& is_on_interface,
                                  const MaterialField& field, const MaterialField& as_is) {
  return parallel_collect<PointMove>(
      0, points.size(), wall_point_grain,
      [&](std::size_t begin, std::size_t end, std::vector<PointMove>& out) {
        const std::unique_ptr<FieldSampler> owned = as_is.sampler();
        for (std::size_t p = begin; p < end; ++p) {
          if (!is_on_interface[p] || !field.changes_walls(points[p])) continue;
          const std::optional<RegionSet> both = owned->two_nearest(points[p]);
          if (!both) continue;
          Vec3 gradient;
          const double off = owned->between((*both)[0], (*both)[1], points[p], gradient);
          const double slope = gradient.squaredNorm();
          // No wall was thickened by more; a longer step comes from distances without slope.
          if (!(std::abs(off) < max_step * std::sqrt(slope))) continue;
          out.push_back({static_cast<Index>(p), points[p], -gradient * (off / slope)});
        }
      });
}

ThickenedWalls what_is_left(const std::vector<PointMove>& moves, const MaterialField& field) {
  ThickenedWalls left;
  struct Off {
    double offset, thickness;
    Vec3 place;
  };
  const std::vector<Off> off = parallel_collect<Off>(
      0, moves.size(), wall_point_grain, [&](std::size_t begin, std::size_t end, std::vector<Off>& out) {
        for (std::size_t m = begin; m < end; ++m) {
          const double offset = moves[m].step.norm(), thickness = field.parallel_thickness(moves[m].from);
          if (2 * offset > restored_share * thickness) out.push_back({offset, thickness, moves[m].from});
        }
      });
  left.points = off.size();
  for (const Off& o : off)
    if (left.max_offset == 0 || o.offset * left.thickness > left.max_offset * o.thickness) {
      left.max_offset = o.offset;
      left.thickness = o.thickness;
      left.place = o.place;
    }
  return left;
}

std::vector<Triangle> interface_faces(const CutMesh& mesh) {
  std::vector<Triangle> result;
  for (const MeshFace& f : mesh_faces(mesh.tets, mesh.points.size(), &mesh.on_interface))
    if (f.count == 1 || mesh.regions[f.first] != mesh.regions[f.second]) result.push_back(f.ids);
  return result;
}

}  // namespace

ThickenedWalls recover_thin_walls(CutMesh& mesh, const MaterialField& field, const MaterialField& as_is) {
  std::vector<PointMove> moves = find_moves(mesh.points, mesh.on_interface, field, as_is);
  if (moves.empty()) return {};
  const std::vector<Vec3> before = mesh.points;
  for (int pass = 0; pass < restoring_passes && !moves.empty(); ++pass) {
    displace_with_backtracking(mesh.points, mesh.tets, moves, tangent_of_bad_tet);
    keep_remaining(mesh.points, moves);
  }
  undo_intersections(mesh.points, mesh.tets, interface_faces(mesh), before);
  return find_thickened_walls(mesh.points, mesh.on_interface, field, as_is);
}

ThickenedWalls find_thickened_walls(const std::vector<Vec3>& points,
                                    const std::vector<std::uint8_t>& is_on_interface,
                                    const MaterialField& field, const MaterialField& as_is) {
  return what_is_left(find_moves(points, is_on_interface, field, as_is), field);
}

}  // namespace tetwright
