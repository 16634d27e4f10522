// SPDX-License-Identifier: Apache-2.0
#include "mesher/cut/thin_wall_recovery.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "common/parallel/parallel_sort.h"
#include "mesher/cut/backtracking_displacement.h"
#include "mesher/cut/undo_intersections.h"
#include "mesher/tuning/cut_tuning.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

/// The moves that return vertices displaced by thickened walls.
std::vector<PointMove> find_moves(const std::vector<Vec3>& points,
                                  const std::vector<std::uint8_t>& is_on_interface, const WallChanges& walls,
                                  const MaterialField& as_is) {
  return parallel_collect<PointMove>(
      0, points.size(), CutGrains::moves,
      [&](std::size_t begin, std::size_t end, std::vector<PointMove>& out) {
        const std::unique_ptr<FieldSampler> owned = as_is.sampler();
        for (std::size_t p = begin; p < end; ++p) {
          if (!is_on_interface[p] || !walls.contains(points[p])) continue;
          const std::optional<RegionSet> both = owned->two_nearest(points[p]);
          if (!both) continue;
          Vec3 gradient;
          const double off = owned->between((*both)[0], (*both)[1], points[p], gradient);
          const double slope = gradient.squaredNorm();
          // No wall was thickened by more. A longer step means that the distances have hardly any slope here.
          if (!(std::abs(off) < CutTuning::WallRecovery::max_step * std::sqrt(slope))) continue;
          out.push_back({static_cast<Index>(p), points[p], -gradient * (off / slope)});
        }
      });
}

ThickenedWalls what_is_left(const std::vector<PointMove>& moves, const WallChanges& walls) {
  ThickenedWalls left;
  struct Off {
    double offset, thickness;
    Vec3 place;
  };
  const std::vector<Off> off = parallel_collect<Off>(
      0, moves.size(), CutGrains::moves, [&](std::size_t begin, std::size_t end, std::vector<Off>& out) {
        for (std::size_t m = begin; m < end; ++m) {
          const double offset = moves[m].step.norm(), thickness = walls.parallel_thickness(moves[m].from);
          if (2 * offset > CutTuning::WallRecovery::recovered_share * thickness)
            out.push_back({offset, thickness, moves[m].from});
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

ThickenedWalls recover_thin_walls(CutMesh& mesh, const WallChanges& walls, const MaterialField& as_is) {
  std::vector<PointMove> moves = find_moves(mesh.points, mesh.on_interface, walls, as_is);
  if (moves.empty()) return {};
  const std::vector<Vec3> before = mesh.points;
  for (int pass = 0; pass < CutTuning::WallRecovery::passes && !moves.empty(); ++pass) {
    displace_with_backtracking(mesh.points, mesh.tets, moves, CutTuning::Shapes::tangent_of_bad_tet);
    keep_remaining(mesh.points, moves);
  }
  undo_intersections(mesh.points, mesh.tets, interface_faces(mesh), before);
  return find_thickened_walls(mesh.points, mesh.on_interface, walls, as_is);
}

ThickenedWalls find_thickened_walls(const std::vector<Vec3>& points,
                                    const std::vector<std::uint8_t>& is_on_interface,
                                    const WallChanges& walls, const MaterialField& as_is) {
  return what_is_left(find_moves(points, is_on_interface, walls, as_is), walls);
}

}  // namespace tetwright
