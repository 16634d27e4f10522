// SPDX-License-Identifier: Apache-2.0
#include "simplify/operations/fitting.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>

#include "common/tolerances.h"
#include "simplify/constraints/surface_samples.h"
#include "simplify/operations/movement.h"
#include "simplify/tuning/tuning.h"

namespace tetwright {

namespace {

using Fitting = SimplifyTuning::Fitting;

/// Moves the centre if the worst tet stays above `floor` or hardly gets worse.
/// \pre Gradients are computed.
Outcome move_fitted(Workspace& ws, const BlockRules& rules, const Vec3& place, float floor) {
  Star& star = ws.star;
  const Vec3 to = ws.mesh.snap(place);
  std::vector<float>& qualities = ws.qualities;
  qualities.resize(star.tets.size());
  float worst;
  const Outcome o =
      rate(star, rules, to, std::min(floor, Fitting::kept_quality * star.worst), qualities, worst);
  return o == Outcome::done ? move_to(ws, rules, to, qualities) : o;
}

/// Moves the centre into the plane of its patch.
/// \pre Gradients are computed.
Outcome fit_to_patch(Workspace& ws, const BlockRules& rules, float floor) {
  const Star& star = ws.star;
  const Vec3& c = star.centre_position;
  const Star::InterfaceTriangle& s = star.interface_triangles.front();
  const auto on = rules.surface.projection->onto_surface(c, s.inside, s.across, s.patch,
                                                         Fitting::reach * shortest_edge(star));
  if (!on || (*on - c).norm() <= tolerance::flat_patch) return Outcome::no_candidate;
  return move_fitted(ws, rules, *on, floor);
}

}  // namespace

Outcome fit_to_crease(Workspace& ws, const BlockRules& rules, float floor) {
  Star& star = ws.star;
  if (!star.creases || star.frozen) return Outcome::no_candidate;
  const int dimension = star.dimension();
  const double reach = Fitting::reach * shortest_edge(star);
  const Vec3& c = star.centre_position;
  if (rules.surface.projection->lacks_creases(c)) return Outcome::no_candidate;
  const auto on = dimension < 2 && ws.is_on_crease(rules) ? rules.surface.projection->onto_crease(c, reach)
                  : dimension == 1                        ? rules.surface.projection->onto_curve(c, reach)
                  : dimension == 0 && ws.may_be_corner(rules)
                      ? rules.surface.projection->onto_corner(c, reach, rules.first_body_patch() != 0)
                      : std::nullopt;
  if (!on) return Outcome::no_candidate;
  const Vec3 to = ws.mesh.snap(*on);
  if ((to - c).norm() <= tolerance::flat_patch) return Outcome::no_candidate;
  star.compute_gradients();
  return move_fitted(ws, rules, to, floor);
}

Outcome fit_to_samples(Workspace& ws, const BlockRules& rules, float floor, SampleWeights weights) {
  Star& star = ws.star;
  const SurfaceSamples* samples = ws.grid.samples();
  if (!samples || star.frozen || star.dimension() != 2) return Outcome::no_candidate;
  star.compute_gradients();
  if (is_in_flat_patch(star, rules)) return fit_to_patch(ws, rules, floor);
  if (rules.keeps_patches(star) && is_flat(star)) return Outcome::no_candidate;
  SurfaceGrid::Edit& edit = ws.proposal.edit;
  edit.clear();
  const Vec3& c = star.centre_position;
  for (const Star::InterfaceTriangle& s : star.interface_triangles)
    edit.removed.push_back({{star.centre, star.points[s.first], star.points[s.second]},
                            {c, star.positions[s.first], star.positions[s.second]}});
  ws.grid.find_records(edit);
  // Normal equations of the distances along the triangles' normals.
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  Vec3 b = Vec3::Zero();
  for (std::size_t i = 0; i < star.interface_triangles.size(); ++i) {
    const Star::InterfaceTriangle& s = star.interface_triangles[i];
    const Vec3 &p = star.positions[s.first], &q = star.positions[s.second];
    const Vec3 across = (p - c).cross(q - c), base = q - p;
    const double area2 = across.squaredNorm();
    if (!(area2 > 0)) continue;
    const Vec3 normal = across / std::sqrt(area2);
    const Vec3 height = normal.cross(base);  // towards or away from the centre
    const double full = height.dot(c - p);
    double squares = 0, sum = 0;
    samples->for_each(edit.removed_records[i], [&](const Vec3& at, float distance) {
      const double share = std::clamp(height.dot(at - p) / full, 0.0, 1.0);
      // These weights approach the least sum of fourth powers of the distances.
      const double weight = weights == SampleWeights::squared_distance
                                ? static_cast<double>(distance) * static_cast<double>(distance)
                                : 1;
      squares += weight * share * share;
      sum += weight * share * normal.dot(at - c);
    });
    a += squares * normal * normal.transpose();
    b += sum * normal;
  }
  const double trace = a.trace();
  if (!(trace > 0)) return Outcome::no_candidate;
  // Suppress motion along flat parts and straight ridges, which the normals do not determine.
  a += (Fitting::flat_share * trace) * Eigen::Matrix3d::Identity();
  Vec3 step = a.ldlt().solve(b);
  if (step.norm() < Fitting::min_step * rules.objective.quality.ideal_edge) return Outcome::no_candidate;
  const double reach = Fitting::reach * shortest_edge(star);
  if (step.norm() > reach) step *= reach / step.norm();
  Outcome o = Outcome::quality;
  for (int i = 0; i < Fitting::steps && o != Outcome::done; ++i, step *= 0.5)
    o = move_fitted(ws, rules, c + step, floor);
  return o;
}

}  // namespace tetwright
