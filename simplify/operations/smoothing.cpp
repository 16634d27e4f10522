#include "simplify/operations/smoothing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>

#include "common/tolerances.h"

namespace tetwright {

namespace {

constexpr int step_halvings = 3;  ///< of smooth(): whole, half and quarter step

// The ascent of find_place().
constexpr int max_ascents = 8;            ///< steps uphill
constexpr int max_backsteps = 4;          ///< halvings of a step that leads nowhere
constexpr double first_step = 0.3;        ///< in shortest edges
constexpr double difference_step = 1e-5;  ///< for gradients, in shortest edges
constexpr float active_within = 1.15f;    ///< times the worst quality: tets whose gradients count
constexpr std::size_t max_active = 8;
constexpr int hull_steps = 12;  ///< for the shortest vector of the gradients' hull
constexpr float min_smoothing_gain =
    1.01f;  ///< factor on the worst quality that is worth another round's work
/// How far from its surface a point may be to be brought back onto it, in shortest edges.
constexpr double projection_reach = 0.5;
constexpr double fit_reach = 1;  ///< the same for fit_to_surface()

/// The centroid of the neighbours that the centre may follow.
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
  // On an interface between two materials the gradients are opposite, on the boundary there is one: the first
  // serves. Along a junction curve they differ; there the step is left whole and the error bound decides.
  const Vec3& g = star.gradients.front().change;
  const double g2 = g.squaredNorm();
  if (g2 > 0) step -= g * (g.dot(step) / g2);
  return step;
}

/// Fills the proposal's edit with the interface triangles before and after; false if one is too far from the
/// reference. At junctions that points may leave, find_place() has tested the point itself: where three
/// regions meet in a loop smaller than a tet, the triangles' centres may have no interface of their two
/// regions nearby.
bool surface_edit(Workspace& ws, const BlockRules& rules, const Vec3& to) {
  const Star& star = ws.star;
  const bool by_point = rules.leave_surface && star.dimension() < 2;
  SurfaceGrid::Edit& edit = ws.proposal.edit;
  for (const Star::InterfaceTriangle& s : star.interface_triangles) {
    const Triangle ids{star.centre, star.points[s.first], star.points[s.second]};
    const Vec3 &p = star.positions[s.first], &q = star.positions[s.second];
    edit.removed.push_back({ids, {star.centre_position, p, q}});
    edit.added.push_back({{ids, {to, p, q}}, s.patch});
    if (!by_point && !near_reference(rules, edit.added.back(), s.inside, s.across)) return false;
  }
  return true;
}

/// Whether the centre may stand at `to`: fills `qualities` and answers done, or why not. `limit` is what the
/// worst tet must exceed.
Outcome rate(Star& star, const BlockRules& rules, const Vec3& to, float limit, std::vector<float>& qualities,
             float& worst) {
  if (!star.interface_triangles.empty() &&
      star.surface_error(to - star.centre_position, rules.gamma, rules.losses_cancel) > rules.max_error)
    return Outcome::surface_error;
  worst = 1;
  for (std::size_t k = 0; k < star.tets.size(); ++k) {
    const Star::StarTet& t = star.tets[k];
    qualities[k] =
        rules.objective(to, star.positions[t.link[0]], star.positions[t.link[1]], star.positions[t.link[2]]);
    if (!(qualities[k] > limit)) return Outcome::quality;
    worst = std::min(worst, qualities[k]);
  }
  return Outcome::done;
}

/// Whether a point where patches meet stays near its crease at `to`.
bool stays_near_crease(const Star& star, const BlockRules& rules, const Vec3& to) {
  if (!(rules.max_crease_distance > 0) || !star.creases) return true;
  std::optional<std::size_t> first;
  for (std::size_t p = 0; p < star.points.size(); ++p) {
    if (star.edge_dimension(p) != 1) continue;
    if (first) return near_crease(rules, star, *first, to, p);
    first = p;
  }
  return true;
}

/// Proposes the move where the surface allows it; `qualities` are those at `to`.
Outcome move_to(Workspace& ws, const BlockRules& rules, const Vec3& to, const std::vector<float>& qualities) {
  Star& star = ws.star;
  Proposal& proposal = ws.proposal;
  proposal.edit.clear();
  if (!star.interface_triangles.empty()) {
    if (!surface_edit(ws, rules, to) || !stays_near_crease(star, rules, to)) return Outcome::surface_error;
    if (!ws.grid.test(proposal.edit)) return Outcome::self_intersection;
  }
  proposal.volumes = star.volume_changes(to - star.centre_position);
  proposal.change = Proposal::Change::move;
  proposal.centre = star.centre;
  proposal.position = to;
  proposal.mark_star(star);
  proposal.rated.clear();
  for (std::size_t k = 0; k < star.tets.size(); ++k)
    proposal.rated.push_back({star.tets[k].tet, star.tets[k].slot, qualities[k]});
  return ws.within_bounds(rules, 0);
}

/// Directions that a point of the given dimension may be moved in without leaving its surface or curve.
std::array<Vec3, 3> free_directions(const Star& star, int dimension, bool leave_surface, int& count) {
  if (dimension == 3 || leave_surface) {
    count = 3;
    return {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  }
  if (dimension == 2) {
    count = 2;
    const Vec3 normal = star.gradients.front().change.normalized();
    int axis;
    normal.cwiseAbs().minCoeff(&axis);
    const Vec3 u = normal.cross(Vec3::Unit(axis)).normalized();
    return {u, normal.cross(u), Vec3::Zero()};
  }
  count = 1;
  Vec3 along = Vec3::Zero();
  for (std::size_t p = 0; p < star.points.size(); ++p)
    if (star.edge_dimension(p) == 1) along = star.positions[p] - along;
  return {along.normalized(), Vec3::Zero(), Vec3::Zero()};
}

/// The shortest vector of the convex hull of some gradients, by Gilbert's iteration (1966): uphill for all of
/// them, or next to nothing.
Vec3 shortest_of_hull(const std::array<Vec3, max_active>& gradients, std::size_t count) {
  Vec3 v = gradients[0];
  for (int i = 0; i < hull_steps; ++i) {
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

double shortest_edge(const Star& star) {
  double shortest2 = std::numeric_limits<double>::infinity();
  for (const Vec3& p : star.positions)
    shortest2 = std::min(shortest2, (p - star.centre_position).squaredNorm());
  return std::sqrt(shortest2);
}

/// Puts the worst tets first: most places are refused for their sake.
void sort_by_quality(Star& star) {
  std::sort(star.tets.begin(), star.tets.end(), [](const Star::StarTet& x, const Star::StarTet& y) {
    return x.quality != y.quality ? x.quality < y.quality : x.tet < y.tet;
  });
}

/// Whether all interface triangles at the centre are in one plane.
bool is_flat(const Star& star) {
  const Vec3 normal = star.gradients.front().change.normalized();
  return std::all_of(star.interface_triangles.begin(), star.interface_triangles.end(),
                     [&](const Star::InterfaceTriangle& s) {
                       const auto off = [&](std::size_t p) {
                         return std::fabs(normal.dot(star.positions[p] - star.centre_position));
                       };
                       return std::max(off(s.first), off(s.second)) <= tolerance::flat_patch;
                     });
}

/// Whether the centre may leave its surface or curve a little; points where patches meet never do, nor those
/// of a flat patch. Gradients must be computed.
bool may_leave(const Star& star, const BlockRules& rules) {
  return rules.leave_surface && rules.projection && !star.creases &&
         !(rules.max_crease_distance > 0 && !star.interface_triangles.empty() && is_flat(star));
}

/// The search for a better position of a star's centre.
class PlacementSearch {
 public:
  PlacementSearch(Workspace& ws, const BlockRules& rules, int dimension)
      : ws_(ws),
        star_(ws.star),
        rules_(rules),
        dimension_(dimension),
        leave_surface_(may_leave(ws.star, rules) && dimension < 3) {}

  bool run(float limit, Placement& found) {
    sort_by_quality(star_);
    directions_ = free_directions(star_, dimension_, leave_surface_, direction_count_);
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
  /// The nearest place of the surface, the junction curve or the corners that the centre belongs to, if it is
  /// nearer than `max_distance`.
  std::optional<Vec3> nearest(const Vec3& to, double max_distance) {
    // The last one found bounds the search: steps are short.
    const double known = known_ ? (*known_ - to).norm() : std::numeric_limits<double>::infinity();
    std::optional<Vec3> found = find_nearest(to, std::min(max_distance, known));
    if (!found && known < max_distance) found = known_;
    if (found) known_ = found;
    return found;
  }

  std::optional<Vec3> find_nearest(const Vec3& to, double max_distance) const {
    const Star::InterfaceTriangle& s = star_.interface_triangles.front();
    return dimension_ == 2   ? rules_.projection->onto_surface(to, s.inside, s.across, s.patch, max_distance)
           : dimension_ == 1 ? rules_.projection->onto_curve(to, max_distance)
                             : rules_.projection->onto_corner(to, max_distance);
  }

  /// How far the centre may be from where it belongs. False if it may not move.
  bool choose_bounds() {
    reach_ = projection_reach * shortest_;
    // A surface point keeps its distance from the reference (fit_to_surface() chose it); farther away than
    // the reach it stays in its plane.
    if (rules_.projection && dimension_ == 2 && !leave_surface_)
      if (const auto on = nearest(star_.centre_position, reach_)) {
        const Vec3 normal = star_.gradients.front().change.normalized();
        offset_ = normal * normal.dot(star_.centre_position - *on);
        // Rounding, which would add up.
        if (rules_.max_crease_distance > 0 && offset_.norm() <= tolerance::flat_patch) offset_.setZero();
      }
    max_distance_ = rules_.max_distance;
    // A point of dimension 0 that is no end or branching of a curve (two interfaces that touch there) has no
    // place to stay near, unless a corner is that near.
    if (leave_surface_ && dimension_ == 0 && !nearest(star_.centre_position, max_distance_)) return false;
    // Chords of a curve may have left a point farther away than it could get by itself: it gets no farther.
    if (leave_surface_ && dimension_ == 1)
      if (const auto on = nearest(star_.centre_position, std::numeric_limits<double>::infinity()))
        max_distance_ = std::max(max_distance_, (*on - star_.centre_position).norm());
    return true;
  }

  /// Where a step to `to` ends: back on the surface or curve, or near it; nothing where that is too far away.
  std::optional<Vec3> placed(Vec3 to) {
    if (rules_.projection && dimension_ < 3) {
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

  /// The values of all tets at the start; flat and inverted tets get their signed value, which is below 0.
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

  /// The worst value at `to`, all values in ws.trial; nothing where one is not above the present worst or E
  /// forbids the move.
  std::optional<float> worst_at(const Vec3& to) {
    if (!star_.interface_triangles.empty() && star_.surface_error(to - star_.centre_position, rules_.gamma,
                                                                  rules_.losses_cancel) > rules_.max_error)
      return {};
    float worst = 1;
    for (std::size_t k = 0; k < star_.tets.size(); ++k) {
      ws_.trial[k] = value(star_.tets[k], to);
      if (!(ws_.trial[k] > worst_)) return {};
      worst = std::min(worst, ws_.trial[k]);
    }
    return worst;
  }

  /// The gradients of the tets that are about as bad as the worst one, by forward differences.
  std::size_t active_gradients(std::array<Vec3, max_active>& gradients) {
    std::vector<std::size_t>& order = ws_.order;
    const std::vector<float>& values = ws_.current;
    order.resize(star_.tets.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const std::size_t considered = std::min(max_active, order.size());
    std::partial_sort(
        order.begin(), order.begin() + static_cast<std::ptrdiff_t>(considered), order.end(),
        [&](std::size_t x, std::size_t y) { return values[x] != values[y] ? values[x] < values[y] : x < y; });
    std::size_t active = 0;
    const double h = difference_step * shortest_;
    for (std::size_t i = 0; i < considered; ++i) {
      const std::size_t k = order[i];
      if (values[k] > (worst_ > 0 ? active_within * worst_ : 0)) break;
      const Star::StarTet& t = star_.tets[k];
      // In double precision: the differences are small.
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

  /// Whether the centre has moved.
  bool ascend() {
    bool moved = false;
    double length = first_step * shortest_;
    std::array<Vec3, max_active> gradients;
    for (int ascent = 0; ascent < max_ascents; ++ascent) {
      const std::size_t active = active_gradients(gradients);
      if (active == 0) break;
      const Vec3 uphill = shortest_of_hull(gradients, active);
      const double steep = uphill.norm();
      if (!(steep * shortest_ > tolerance::ascent_share * std::fabs(worst_) + tolerance::ascent_rounding))
        break;
      bool better = false;
      for (int back = 0; back < max_backsteps; ++back, length *= 0.5) {
        const auto to = placed(at_ + uphill * (length / steep));
        if (!to) continue;
        const auto worst_there = worst_at(*to);
        if (!worst_there) continue;
        better = *worst_there > worst_ + 1e-3f * std::fabs(worst_);
        at_ = *to;
        worst_ = *worst_there;
        ws_.current.swap(ws_.trial);
        moved = true;
        break;
      }
      if (!better) break;
      length = std::min(2 * length, first_step * shortest_);
    }
    return moved;
  }

  Workspace& ws_;
  Star& star_;
  const BlockRules& rules_;
  int dimension_;
  bool leave_surface_;
  std::array<Vec3, 3> directions_;
  int direction_count_ = 0;
  double shortest_ = 0;  ///< edge at the centre
  double reach_ = 0;     ///< how far a step may leave the surface before it is projected back
  double max_distance_ = 0;
  std::optional<Vec3> known_;   ///< what nearest() has found last
  Vec3 offset_ = Vec3::Zero();  ///< from the surface
  Vec3 at_ = Vec3::Zero();
  float worst_ = 0;
};

}  // namespace

bool find_place(Workspace& ws, const BlockRules& rules, int dimension, float limit, Placement& found) {
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
  for (int i = 0; i < step_halvings; ++i, step *= 0.5) {
    Vec3 to = star.centre_position + step;
    if (rules.max_crease_distance > 0 && dimension < 3) {
      const Star::InterfaceTriangle& s = star.interface_triangles.front();
      const double reach = projection_reach * shortest_edge(star);
      const auto on = dimension == 2 ? rules.projection->onto_surface(to, s.inside, s.across, s.patch, reach)
                                     : rules.projection->onto_curve(to, reach);
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
  if (dimension == 0 && !may_leave(star, rules)) return Outcome::material_rule;
  Placement& place = ws.placement;
  if (!find_place(ws, rules, dimension, min_smoothing_gain * star.worst, place)) return Outcome::quality;
  return move_to(ws, rules, place.position, place.qualities);
}

Outcome fit_to_crease(Workspace& ws, const BlockRules& rules, float floor) {
  Star& star = ws.star;
  if (!star.creases || star.frozen) return Outcome::no_candidate;
  const int dimension = star.dimension();
  const double reach = fit_reach * shortest_edge(star);
  const Vec3& c = star.centre_position;
  const auto on = dimension == 1   ? rules.projection->onto_curve(c, reach)
                  : dimension == 0 ? rules.projection->onto_corner(c, reach)
                                   : std::nullopt;
  if (!on) return Outcome::no_candidate;
  const Vec3 to = ws.mesh.snap(*on);
  if ((to - c).norm() <= tolerance::flat_patch) return Outcome::no_candidate;
  star.compute_gradients();
  std::vector<float>& qualities = ws.qualities;
  qualities.resize(star.tets.size());
  float worst;
  const Outcome o = rate(star, rules, to, std::min(floor, star.worst * 0.999f), qualities, worst);
  return o == Outcome::done ? move_to(ws, rules, to, qualities) : o;
}

Outcome fit_to_surface(Workspace& ws, const BlockRules& rules, float floor) {
  Star& star = ws.star;
  if (!rules.projection || star.frozen || star.dimension() != 2) return Outcome::no_candidate;
  star.compute_gradients();
  if (rules.max_crease_distance > 0 && is_flat(star)) return Outcome::no_candidate;
  const Vec3 normal = star.gradients.front().change.normalized();
  double weights = 0, pull = 0;
  const double reach = fit_reach * shortest_edge(star);
  /// A place on the triangles that moves by `weight` of what the centre moves; what it is nearest to.
  /// `known`: a place of the same surface, which bounds the search.
  const auto sample = [&](const Vec3& at, double weight, const Star::InterfaceTriangle& s,
                          const std::optional<Vec3>& known) -> std::optional<Vec3> {
    auto on = known;
    const double limit = known ? std::min(reach, (*known - at).norm()) : reach;
    if (const auto nearer = rules.projection->onto_surface(at, s.inside, s.across, s.patch, limit))
      on = nearer;
    if (!on || (*on - at).norm() > reach) return {};
    pull += weight * normal.dot(*on - at);
    weights += weight * weight;
    return on;
  };
  const Vec3& c = star.centre_position;
  const Star::InterfaceTriangle& first = star.interface_triangles.front();
  const auto on = sample(c, 1, first, {});
  for (const Star::InterfaceTriangle& s : star.interface_triangles)
    sample((c + star.positions[s.first] + star.positions[s.second]) / 3, 1.0 / 3, s, on);
  if (!(weights > 0)) return Outcome::no_candidate;
  const Vec3 to = ws.mesh.snap(c + normal * (pull / weights));
  std::vector<float>& qualities = ws.qualities;
  qualities.resize(star.tets.size());
  float worst;
  const float limit = std::min(floor, star.worst * 0.999f);
  const Outcome o = rate(star, rules, to, limit, qualities, worst);
  return o == Outcome::done ? move_to(ws, rules, to, qualities) : o;
}

}  // namespace tetwright
