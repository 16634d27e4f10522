// SPDX-License-Identifier: Apache-2.0
#include "simplify/operations/smoothing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>

#include "common/tolerances.h"
#include "simplify/operations/movement.h"
#include "simplify/tuning/tuning.h"

namespace tetwright {

namespace {

using Smoothing = SimplifyTuning::Smoothing;

/// Centroid of the neighbours that attract the centre.
Vec3 centroid(const Star& star, int dimension) {
  Vec3 sum = Vec3::Zero();
  double count = 0;
  for (std::size_t p = 0; p < star.points.size(); ++p) {
    const bool follows = dimension == 3   ? true
                         : dimension == 2 ? star.interface_count[p] != 0
                                          : star.edge_dimension(p) == 1;
    if (!follows) continue;
    sum += star.positions[p];
    ++count;
  }
  return sum / count;
}

/// Projects a step onto the plane that keeps volumes constant.
Vec3 keep_volumes(const Star& star, Vec3 step) {
  // The gradients are opposite at an interface between two materials, and the boundary has only one, so use
  // the first. Along a junction curve they differ: leave the step unchanged and rely on the error bound.
  const Vec3& g = star.surface_normal();
  const double g2 = g.squaredNorm();
  if (g2 > 0) step -= g * (g.dot(step) / g2);
  return step;
}

/// Two unit vectors across a unit normal.
std::array<Vec3, 3> directions_in_plane(const Vec3& normal) {
  int axis;
  normal.cwiseAbs().minCoeff(&axis);
  const Vec3 u = normal.cross(Vec3::Unit(axis)).normalized();
  return {u, normal.cross(u), Vec3::Zero()};
}

/// The flat faces of the boundary at a point.
struct BoundaryPlanes {
  struct Plane {
    Vec3 normal;  ///< unit vector
    std::size_t triangles;
  };
  static constexpr std::size_t max_count = 8;  ///< more are a curved surface, whatever they share
  std::array<Plane, max_count> planes;
  std::size_t count = 0;
};

/// Finds the flat faces of the boundary at the centre: one inside a flat face, two on a straight edge, three
/// in a corner. A curved surface has as many planes as triangles; where it meets a flat face, that one
/// counts, since several triangles share its plane. A single triangle of a flat face does not tell.
BoundaryPlanes planes_of_boundary(const Star& star) {
  BoundaryPlanes found;
  const auto end = [&] { return found.planes.begin() + static_cast<std::ptrdiff_t>(found.count); };
  for (const Star::InterfaceTriangle& s : star.interface_triangles) {
    if (s.inside != outside_id && s.across != outside_id) continue;
    const Vec3 p = star.positions[s.first] - star.centre_position,
               q = star.positions[s.second] - star.centre_position;
    const Vec3 normal = p.cross(q);
    if (!(normal.squaredNorm() > 0)) continue;
    const auto known = std::find_if(found.planes.begin(), end(), [&](const BoundaryPlanes::Plane& plane) {
      return std::max(std::fabs(plane.normal.dot(p)), std::fabs(plane.normal.dot(q))) <=
             tolerance::flat_patch;
    });
    if (known != end()) {
      ++known->triangles;
      continue;
    }
    if (found.count == BoundaryPlanes::max_count) return {};
    found.planes[found.count++] = {normal.normalized(), 1};
  }
  constexpr std::size_t planes_of_corner = 3;
  if (found.count > planes_of_corner)
    found.count = static_cast<std::size_t>(
        std::remove_if(found.planes.begin(), end(),
                       [](const BoundaryPlanes::Plane& plane) { return plane.triangles == 1; }) -
        found.planes.begin());
  return found;
}

/// Unit vectors along all planes.
/// \param count their number; 0 where more than two planes meet in a point
std::array<Vec3, 3> directions_in_planes(const BoundaryPlanes& found, int& count) {
  if (found.count == 1) {
    count = 2;
    return directions_in_plane(found.planes[0].normal);
  }
  const Vec3 along = found.planes[0].normal.cross(found.planes[1].normal).normalized();
  count = found.count == 2 ? 1 : 0;
  return {along, Vec3::Zero(), Vec3::Zero()};
}

/// Directions in which a point of the given dimension may move without leaving its surface or curve.
/// \param leave_surface it may leave them, but not flat faces of the boundary and straight edges between them
/// \param follows whether an edge, by link point, belongs to the curve
template <class Follows>
std::array<Vec3, 3> free_directions(const Star& star, int dimension, bool leave_surface,
                                    const Follows& follows, int& count) {
  if (leave_surface)
    if (const BoundaryPlanes planes = planes_of_boundary(star); planes.count > 0)
      return directions_in_planes(planes, count);
  if (dimension == 3 || leave_surface) {
    count = 3;
    return {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  }
  if (dimension == 2) {
    count = 2;
    return directions_in_plane(star.surface_normal().normalized());
  }
  count = 1;
  Vec3 along = Vec3::Zero();
  for (std::size_t p = 0; p < star.points.size(); ++p)
    if (follows(p)) along = star.positions[p] - along;
  return {along.normalized(), Vec3::Zero(), Vec3::Zero()};
}

/// The shortest vector in the gradients' convex hull, by Gilbert's iteration (1966): an ascent direction for
/// all of them, or nearly zero.
Vec3 shortest_of_hull(const std::array<Vec3, Smoothing::max_active>& gradients, std::size_t count) {
  Vec3 v = gradients[0];
  for (int i = 0; i < Smoothing::hull_steps; ++i) {
    std::size_t lowest = 0;
    for (std::size_t k = 1; k < count; ++k)
      if (gradients[k].dot(v) < gradients[lowest].dot(v)) lowest = k;
    const Vec3 across = gradients[lowest] - v;
    const double a2 = across.squaredNorm();
    if (!(a2 > 0)) break;
    const double t = -v.dot(across) / a2;
    if (!(t > tolerance::hull_step)) break;
    v += std::min(1.0, t) * across;
  }
  return v;
}

/// Sorts the worst tets first, since most positions are refused because of them.
void sort_by_quality(Star& star) {
  std::sort(star.tets.begin(), star.tets.end(), [](const Star::StarTet& x, const Star::StarTet& y) {
    return x.quality != y.quality ? x.quality < y.quality : x.tet < y.tet;
  });
}

/// Whether the centre may leave its surface or curve slightly. Points where patches meet, of flat patches and
/// of sheets may not.
/// \pre Gradients are computed.
bool may_leave(const Star& star, const BlockRules& rules) {
  return rules.surface.leave_surface && rules.surface.projection && !star.creases && !star.sheets &&
         !(rules.has_patches() && !star.interface_triangles.empty() &&
           (is_flat(star) || is_in_flat_patch(star, rules)));
}

/// The search for a better position of a star's centre.
class PlacementSearch {
 public:
  PlacementSearch(Workspace& ws, const BlockRules& rules, int dimension)
      : ws_(ws),
        star_(ws.star),
        rules_(rules),
        dimension_(dimension),
        on_crease_(dimension < 2 && ws.is_on_crease(rules)),
        leave_surface_(may_leave(ws.star, rules) && dimension < 3 && !on_crease_) {}

  bool run(float limit, Placement& found) {
    sort_by_quality(star_);
    const auto follows = [&](std::size_t p) {
      return on_crease_ ? ws_.kinds[p].on_crease() : star_.edge_dimension(p) == 1;
    };
    directions_ = free_directions(star_, dimension_, leave_surface_, follows, direction_count_);
    if (direction_count_ == 0) return false;
    shortest_ = shortest_edge(star_);
    if (!choose_bounds()) return false;
    start();
    const bool moved = ascend();
    if (!moved || !(worst_ > std::max(limit, 0.0f))) return false;
    found.position = at_;
    found.worst = worst_;
    found.qualities.assign(ws_.current.begin(), ws_.current.end());
    return true;
  }

 private:
  /// Nearest point on the surface, junction curve or corners that the centre belongs to, if within
  /// `max_distance`.
  std::optional<Vec3> nearest(const Vec3& to, double max_distance) {
    // The last result bounds the search, since steps are short.
    const double known = known_ ? (*known_ - to).norm() : std::numeric_limits<double>::infinity();
    std::optional<Vec3> found = find_nearest(to, std::min(max_distance, known));
    if (!found && known < max_distance) found = known_;
    if (found) known_ = found;
    return found;
  }

  std::optional<Vec3> find_nearest(const Vec3& to, double max_distance) const {
    if (on_crease_) return rules_.surface.projection->onto_crease(to, max_distance);
    const Star::InterfaceTriangle& s = star_.interface_triangles.front();
    return dimension_ == 2
               ? rules_.surface.projection->onto_surface(to, s.inside, s.across, s.patch, max_distance)
           : dimension_ == 1 ? rules_.surface.projection->onto_curve(to, max_distance)
                             : rules_.surface.projection->onto_corner(to, max_distance);
  }

  /// Sets the bounds on the centre's distance from its surface, curve or corner. False if it may not move.
  bool choose_bounds() {
    reach_ = Smoothing::projection_reach * shortest_;
    // A surface point keeps its offset from the reference, which fit_to_samples() determined. Beyond the
    // reach it stays in its plane.
    if (rules_.surface.projection && dimension_ == 2 && !leave_surface_)
      if (const auto on = nearest(star_.centre_position, reach_)) {
        const Vec3 normal = star_.surface_normal().normalized();
        offset_ = normal * normal.dot(star_.centre_position - *on);
        // Drop rounding errors, which would accumulate.
        if ((rules_.keeps_patches(star_) && offset_.norm() <= tolerance::flat_patch) ||
            is_in_flat_patch(star_, rules_))
          offset_.setZero();
      }
    max_distance_ = rules_.surface.max_distance.value_or(0);
    // A point of dimension 0 at which no curve ends or branches (two interfaces that touch) has no corner to
    // stay near, unless one happens to be within the distance.
    if (leave_surface_ && dimension_ == 0 && !nearest(star_.centre_position, max_distance_)) return false;
    // A point may already be farther from its curve than its moves may take it, since chords cut corners. Do
    // not let it get farther.
    if (leave_surface_ && dimension_ == 1)
      if (const auto on = nearest(star_.centre_position, std::numeric_limits<double>::infinity()))
        max_distance_ = std::max(max_distance_, (*on - star_.centre_position).norm());
    return true;
  }

  /// End position of a step to `to`: back on the surface or curve, or near it; std::nullopt if that is too
  /// far away.
  std::optional<Vec3> placed(Vec3 to) {
    if (rules_.surface.projection && dimension_ < 3) {
      const auto on = nearest(to, leave_surface_ ? max_distance_ : reach_);
      if (!on) return {};
      if (!leave_surface_) to = *on + offset_;
    }
    return ws_.mesh.snap(to);
  }

  float value(const Star::StarTet& t, const Vec3& to) const {
    return rules_.objective.signed_value(to, star_.positions[t.link[0]], star_.positions[t.link[1]],
                                         star_.positions[t.link[2]]);
  }

  /// Sets the tets' values at the start; flat and inverted ones get their signed value, below 0.
  void start() {
    at_ = star_.centre_position;
    worst_ = star_.worst;
    ws_.current.resize(star_.tets.size());
    ws_.trial.resize(star_.tets.size());
    for (std::size_t k = 0; k < star_.tets.size(); ++k) {
      ws_.current[k] = star_.tets[k].quality;
      if (ws_.current[k] > 0) continue;
      ws_.current[k] = value(star_.tets[k], at_);
      worst_ = std::min(worst_, ws_.current[k]);
    }
  }

  /// The worst value at `to`; writes all values to ws.trial. std::nullopt if a value is not above the current
  /// worst, or if E forbids the move.
  std::optional<float> worst_at(const Vec3& to) {
    if (!star_.interface_triangles.empty() &&
        star_.surface_error(to - star_.centre_position, rules_.error.gamma, rules_.error.losses_cancel) >
            rules_.error.limit())
      return {};
    float worst = 1;
    for (std::size_t k = 0; k < star_.tets.size(); ++k) {
      ws_.trial[k] = value(star_.tets[k], to);
      if (!(ws_.trial[k] > worst_)) return {};
      worst = std::min(worst, ws_.trial[k]);
    }
    return worst;
  }

  /// Computes gradients, by forward differences, of the tets that are nearly as bad as the worst one. Returns
  /// their number.
  std::size_t active_gradients(std::array<Vec3, Smoothing::max_active>& gradients) {
    std::vector<std::size_t>& order = ws_.order;
    const std::vector<float>& values = ws_.current;
    order.resize(star_.tets.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const std::size_t considered = std::min(Smoothing::max_active, order.size());
    std::partial_sort(
        order.begin(), order.begin() + static_cast<std::ptrdiff_t>(considered), order.end(),
        [&](std::size_t x, std::size_t y) { return values[x] != values[y] ? values[x] < values[y] : x < y; });
    std::size_t active = 0;
    const double h = Smoothing::difference_step * shortest_;
    for (std::size_t i = 0; i < considered; ++i) {
      const std::size_t k = order[i];
      if (values[k] > (worst_ > 0 ? Smoothing::active_within * worst_ : 0)) break;
      const Star::StarTet& t = star_.tets[k];
      // Double precision, since the differences are small.
      const auto precise = [&](const Vec3& p) {
        return rules_.objective.precise_signed_value(p, star_.positions[t.link[0]],
                                                     star_.positions[t.link[1]], star_.positions[t.link[2]]);
      };
      Vec3 g = Vec3::Zero();
      const double base = precise(at_);
      for (int d = 0; d < direction_count_; ++d)
        g += directions_[d] * ((precise(at_ + h * directions_[d]) - base) / h);
      gradients[active++] = g;
    }
    return active;
  }

  /// Ascends; returns whether the centre has moved.
  bool ascend() {
    bool moved = false;
    double length = Smoothing::first_step * shortest_;
    std::array<Vec3, Smoothing::max_active> gradients;
    for (int ascent = 0; ascent < Smoothing::max_ascents; ++ascent) {
      const std::size_t active = active_gradients(gradients);
      if (active == 0) break;
      const Vec3 uphill = shortest_of_hull(gradients, active);
      const double steep = uphill.norm();
      if (!(steep * shortest_ > tolerance::ascent_share * std::fabs(worst_) + tolerance::ascent_rounding))
        break;
      bool better = false;
      for (int back = 0; back < Smoothing::max_backsteps; ++back, length *= 0.5) {
        const auto to = placed(at_ + uphill * (length / steep));
        if (!to) continue;
        const auto worst_there = worst_at(*to);
        if (!worst_there) continue;
        better = *worst_there > worst_ + Smoothing::min_step_gain * std::fabs(worst_);
        at_ = *to;
        worst_ = *worst_there;
        ws_.current.swap(ws_.trial);
        moved = true;
        break;
      }
      if (!better) break;
      length = std::min(2 * length, Smoothing::first_step * shortest_);
    }
    return moved;
  }

  Workspace& ws_;
  Star& star_;
  const BlockRules& rules_;
  int dimension_;
  bool on_crease_;  ///< of a body among labels
  bool leave_surface_;
  std::array<Vec3, 3> directions_;
  int direction_count_ = 0;
  double shortest_ = 0;  ///< shortest edge at the centre
  double reach_ = 0;     ///< max distance from the surface from which a step is projected back
  double max_distance_ = 0;
  std::optional<Vec3> known_;   ///< last result of nearest()
  Vec3 offset_ = Vec3::Zero();  ///< from the surface
  Vec3 at_ = Vec3::Zero();
  float worst_ = 0;
};

}  // namespace

bool find_position(Workspace& ws, const BlockRules& rules, int dimension, float limit, Placement& found) {
  return PlacementSearch(ws, rules, dimension).run(limit, found);
}

Outcome smooth(Workspace& ws, const BlockRules& rules) {
  Star& star = ws.star;
  const int dimension = star.dimension();
  if (dimension == 0 || star.frozen) return Outcome::material_rule;
  star.compute_gradients();
  Vec3 step = centroid(star, dimension) - star.centre_position;
  if (dimension == 2) step = keep_volumes(star, step);

  sort_by_quality(star);
  std::vector<float>& qualities = ws.qualities;
  qualities.resize(star.tets.size());
  const float limit = ws.acceptance_limit(rules, star.worst);
  Outcome refusal = Outcome::quality;
  float worst;
  for (int i = 0; i < Smoothing::steps; ++i, step *= 0.5) {
    Vec3 to = star.centre_position + step;
    if (rules.keeps_patches(star) && dimension < 3) {
      const Star::InterfaceTriangle& s = star.interface_triangles.front();
      const double reach = Smoothing::projection_reach * shortest_edge(star);
      const auto on = dimension == 2
                          ? rules.surface.projection->onto_surface(to, s.inside, s.across, s.patch, reach)
                          : rules.surface.projection->onto_curve(to, reach);
      if (!on) continue;
      to = *on;
    }
    to = ws.mesh.snap(to);
    refusal = rate(star, rules, to, limit, qualities, worst);
    if (refusal != Outcome::done) continue;
    refusal = move_to(ws, rules, to, qualities);
    if (refusal == Outcome::done) return refusal;
  }
  return refusal;
}

Outcome optimise(Workspace& ws, const BlockRules& rules) {
  Star& star = ws.star;
  const int dimension = star.dimension();
  if (star.frozen) return Outcome::material_rule;
  star.compute_gradients();
  if (dimension == 0 && !may_leave(star, rules) && !(ws.is_crossing(rules) && ws.is_on_crease(rules)))
    return Outcome::material_rule;
  Placement& place = ws.placement;
  if (!find_position(ws, rules, dimension, Smoothing::min_gain * star.worst, place)) return Outcome::quality;
  return move_to(ws, rules, place.position, place.qualities);
}

}  // namespace tetwright
