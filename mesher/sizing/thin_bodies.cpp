// SPDX-License-Identifier: Apache-2.0
#include "mesher/sizing/thin_bodies.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/features/edge_uses.h"
#include "mesher/sizing/triangle_points.h"
#include "mesher/tuning/cell_tuning.h"

namespace tetwright {

namespace {

/// Adds points of a surface, each within about `spacing` of others.
void add_surface(const RepairedSurface& surface, double spacing, int halvings,
                 std::vector<RefinementRegion>& regions) {
  for (const Triangle& t : surface.triangles)
    for_each_point({surface.points[t[0]], surface.points[t[1]], surface.points[t[2]]}, spacing,
                   [&](const Vec3& point) {
                     regions.push_back({point, halvings});
                   });
}

/// Whether hardly any of a surface's curvature (length of edges times their turns) is at sharp edges.
bool is_smooth(const RepairedSurface& surface) {
  const auto normal_of = [&](Index i) -> Vec3 {
    const Triangle& t = surface.triangles[i];
    const Vec3& a = surface.points[t[0]];
    return (surface.points[t[1]] - a).cross(surface.points[t[2]] - a).normalized();
  };
  double all = 0, sharp = 0;
  const std::vector<EdgeUse> uses = edge_uses(surface.triangles, {});
  for (std::size_t i = 1; i < uses.size(); ++i) {
    if (!uses[i].same_edge(uses[i - 1])) continue;
    const Vec3 u = normal_of(uses[i - 1].triangle), v = normal_of(uses[i].triangle);
    const auto [from, to] = ends_of(uses[i].key);
    const double turn = std::atan2(u.cross(v).norm(), u.dot(v));
    const double curvature = turn * (surface.points[from] - surface.points[to]).norm();
    all += curvature;
    if (turn > CellTuning::Patches::sharp_turn) sharp += curvature;
  }
  return sharp < CellTuning::Patches::max_sharp_share * all;
}

}  // namespace

double mean_thickness(const RepairedSurface& surface) { return 2 * std::abs(surface.volume) / surface.area; }

BodySizes cells_of_thin_bodies(const MesherInput& bodies, const GridFrame& voxels,
                               std::vector<RefinementRegion> asked, int max_depth, double max_tets) {
  std::vector<int> depths;
  for (const MesherInput::Body& body : bodies.bodies) {
    const double thickness = mean_thickness(body.surface) / voxels.cell_size;
    const double wanted = is_smooth(body.surface) ? CellTuning::Patches::cells_of_smooth_body
                                                  : CellTuning::Patches::cells_of_body;
    const double halvings = std::round(std::log2(wanted / thickness));
    depths.push_back(static_cast<int>(std::clamp(halvings, 0.0, static_cast<double>(max_depth))));
    // Cells around a point are halved up to a distance of one of them.
    if (depths.back() > 0)
      add_surface(body.surface, std::ldexp(voxels.cell_size, 1 - depths.back()), depths.back(), asked);
  }
  BodySizes result{cells_around(asked, voxels, max_depth, max_tets), {}};
  for (const int depth : depths)
    result.sizes.push_back(std::ldexp(voxels.cell_size, -std::min(depth, result.cells.finer.refinement)));
  return result;
}

}  // namespace tetwright
