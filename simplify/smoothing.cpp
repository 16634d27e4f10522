#include "simplify/smoothing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>

#include "simplify/refill.h"

namespace tetwright {

namespace {

constexpr int step_halvings = 3;  ///< of smooth(): whole, half and quarter step

// The ascent of find_place().
constexpr int most_ascents = 8;           ///< steps uphill
constexpr int most_backsteps = 4;         ///< halvings of a step that leads nowhere
constexpr double first_step = 0.3;        ///< in shortest edges
constexpr double difference_step = 1e-5;  ///< for gradients, in shortest edges
constexpr float active_within = 1.15f;    ///< times the poorest quality: tets whose gradients count
constexpr std::size_t most_active = 8;
constexpr int hull_steps = 12;  ///< for the shortest vector of the gradients' hull
constexpr float least_smoothing_gain =
    1.01f;  ///< factor on the poorest quality that is worth another round's work
/// How far from its surface a point may be to be brought back onto it, in shortest edges.
constexpr double slide_reach = 0.5;
constexpr double fit_reach = 1;  ///< the same for fit_to_surface()

/// The centroid of the neighbours that the centre may follow.
Vec3 centroid(const Star& star, int dimension) {
  Vec3 sum = Vec3::Zero();
  double count = 0;
  for (std::size_t p = 0; p < star.points.size(); ++p) {
    const bool follows = dimension == 3   ? true
                         : dimension == 2 ? star.sheet_count[p] != 0
                                          : star.edge_dimension(p) == 1;
    if (!follows) continue;
    sum += star.positions[p];
    ++count;
  }
  return sum / count;
}

/// Takes out of a step what changes a volume.
Vec3 keep_volumes(const Star& star, Vec3 step) {
  // On an interface between two materials the gradients are opposite, on the boundary there is one: the first
  // serves. Along a junction curve they differ; there the step is left whole and the error bound decides.
  const Vec3& g = star.gradients.front().change;
  const double g2 = g.squaredNorm();
  if (g2 > 0) step -= g * (g.dot(step) / g2);
  return step;
}

/// Fills task.edit with the interface triangles before and after; false if one is too far from the reference.
/// At junctions that may be left find_place() saw to it, by the point itself: where three regions meet in a
/// loop smaller than a tet, the reference has no interface between two of them a little beside it.
bool surface_edit(Task& task, const BlockRules& rules, const Vec3& to) {
  const Star& star = task.star;
  const bool by_point = rules.leave_surface && star.dimension() < 2;
  task.edit.clear();
  for (const Star::Sheet& s : star.sheets) {
    const Triangle ids{star.centre, star.points[s.first], star.points[s.second]};
    const Vec3 &p = star.positions[s.first], &q = star.positions[s.second];
    task.edit.removed.push_back({ids, {star.centre_position, p, q}});
    task.edit.added.push_back({ids, {to, p, q}});
    if (!by_point && !near_reference(rules, task.edit.added.back(), s.inside, s.across)) return false;
  }
  return true;
}

/// Whether the centre may stand at `to`: fills `qualities` and answers done, or why not. `limit` is what the
/// poorest tet must exceed.
Outcome rate(Star& star, const BlockRules& rules, const Vec3& to, float limit, std::vector<float>& qualities,
             float& poorest) {
  if (!star.sheets.empty() &&
      star.surface_error(to - star.centre_position, rules.gamma, rules.losses_cancel) > rules.largest_error)
    return Outcome::surface_error;
  poorest = 1;
  for (std::size_t k = 0; k < star.tets.size(); ++k) {
    const Star::StarTet& t = star.tets[k];
    qualities[k] =
        rules.objective(to, star.positions[t.link[0]], star.positions[t.link[1]], star.positions[t.link[2]]);
    if (!(qualities[k] > limit)) return Outcome::quality;
    poorest = std::min(poorest, qualities[k]);
  }
  return Outcome::done;
}

/// Carries the move out where the surface allows it; `qualities` are those at `to`.
Outcome move_to(Task& task, const BlockRules& rules, const Vec3& to, const std::vector<float>& qualities) {
  const Star& star = task.star;
  if (!star.sheets.empty()) {
    if (!surface_edit(task, rules, to)) return Outcome::surface_error;
    const Outcome o = task.grid.prepare(task.edit, task.grid_task, task.cells);
    if (o != Outcome::done) {
      task.cells.release();
      return o;
    }
  }
  if (!task.ledger.book(task.star.volume_changes(to - star.centre_position))) {
    task.cells.release();
    return Outcome::volume;
  }
  task.mesh.set_position(star.centre, to);
  task.mesh.touch(star.centre);
  for (Index p : star.points) task.mesh.touch(p);
  for (std::size_t k = 0; k < star.tets.size(); ++k) task.mesh.set_quality(star.tets[k].tet, qualities[k]);
  if (!star.sheets.empty()) {
    task.grid.commit(task.edit, task.grid_task);
    task.cells.release();
  }
  return Outcome::done;
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
Vec3 shortest_of_hull(const std::array<Vec3, most_active>& gradients, std::size_t count) {
  Vec3 v = gradients[0];
  for (int i = 0; i < hull_steps; ++i) {
    std::size_t least = 0;
    for (std::size_t k = 1; k < count; ++k)
      if (gradients[k].dot(v) < gradients[least].dot(v)) least = k;
    const Vec3 across = gradients[least] - v;
    const double a2 = across.squaredNorm();
    if (!(a2 > 0)) break;
    const double t = -v.dot(across) / a2;
    if (!(t > 1e-6)) break;
    v += std::min(1.0, t) * across;
  }
  return v;
}

/// Puts the poorest tets first: most places are refused for their sake.
void sort_by_quality(Star& star) {
  std::sort(star.tets.begin(), star.tets.end(), [](const Star::StarTet& x, const Star::StarTet& y) {
    return x.quality != y.quality ? x.quality < y.quality : x.tet < y.tet;
  });
}

}  // namespace

bool find_place(Star& star, const EditableMesh& mesh, const BlockRules& rules, int dimension, float limit,
                Placement& found) {
  sort_by_quality(star);
  const bool leave_surface = rules.leave_surface && rules.slide && dimension < 3;
  int directions_count;
  const std::array<Vec3, 3> directions = free_directions(star, dimension, leave_surface, directions_count);
  double shortest2 = std::numeric_limits<double>::infinity();
  for (const Vec3& p : star.positions)
    shortest2 = std::min(shortest2, (p - star.centre_position).squaredNorm());
  const double shortest = std::sqrt(shortest2);

  // A surface point keeps its distance from the reference (fit_to_surface() chose it); farther away than the
  // reach it stays in its plane.
  const double reach = slide_reach * shortest;
  Vec3 offset = Vec3::Zero();
  if (rules.slide && dimension == 2 && !leave_surface) {
    const Star::Sheet& s = star.sheets.front();
    if (const auto on = rules.slide->onto_surface(star.centre_position, s.inside, s.across, reach)) {
      const Vec3 normal = star.gradients.front().change.normalized();
      offset = normal * normal.dot(star.centre_position - *on);
    }
  }
  /// What belongs to a place: the nearest of the surface, the curve or the corners.
  const auto nearest = [&](const Vec3& to, double most) {
    const Star::Sheet& s = star.sheets.front();
    return dimension == 2   ? rules.slide->onto_surface(to, s.inside, s.across, most)
           : dimension == 1 ? rules.slide->onto_curve(to, most)
                            : rules.slide->onto_corner(to, most);
  };
  // Chords of a curve may have left a point farther away than it could go by itself: it goes no farther. A
  // point of dimension 0 that is no end or branch of a curve (two sheets that touch there) has no place to
  // stay near, unless a corner is that near.
  double farthest = rules.largest_distance;
  if (leave_surface && dimension == 0 && !nearest(star.centre_position, farthest)) return false;
  if (leave_surface && dimension == 1)
    if (const auto on = nearest(star.centre_position, std::numeric_limits<double>::infinity()))
      farthest = std::max(farthest, (*on - star.centre_position).norm());
  /// Where a step leads: back onto the surface or curve, or near it.
  const auto placed = [&](Vec3 to) -> std::optional<Vec3> {
    if (rules.slide && dimension < 3) {
      const auto on = nearest(to, leave_surface ? farthest : reach);
      if (!on) return {};
      if (!leave_surface) to = *on + offset;
    }
    return mesh.snap(to);
  };

  const auto value = [&](const Star::StarTet& t, const Vec3& to) {
    return rules.objective.signed_value(to, star.positions[t.link[0]], star.positions[t.link[1]],
                                        star.positions[t.link[2]]);
  };
  /// The poorest value at `to`, all values in `values`; nothing where one is not above `above` or E forbids
  /// it.
  const auto poorest_at = [&](const Vec3& to, float above,
                              std::vector<float>& values) -> std::optional<float> {
    if (!star.sheets.empty() &&
        star.surface_error(to - star.centre_position, rules.gamma, rules.losses_cancel) > rules.largest_error)
      return {};
    float least = 1;
    for (std::size_t k = 0; k < star.tets.size(); ++k) {
      values[k] = value(star.tets[k], to);
      if (!(values[k] > above)) return {};
      least = std::min(least, values[k]);
    }
    return least;
  };

  thread_local std::vector<float> here, there;
  thread_local std::vector<std::size_t> order;
  here.resize(star.tets.size());
  there.resize(star.tets.size());
  Vec3 at = star.centre_position;
  float poorest = star.poorest;
  for (std::size_t k = 0; k < star.tets.size(); ++k) {
    here[k] = star.tets[k].quality;
    if (here[k] > 0) continue;
    here[k] = value(star.tets[k], at);
    poorest = std::min(poorest, here[k]);
  }
  bool moved = false;
  double length = first_step * shortest;
  std::array<Vec3, most_active> gradients;
  for (int ascent = 0; ascent < most_ascents; ++ascent) {
    // The poorest ones first, as they are now.
    order.resize(star.tets.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const std::size_t considered = std::min(most_active, order.size());
    std::partial_sort(
        order.begin(), order.begin() + static_cast<std::ptrdiff_t>(considered), order.end(),
        [&](std::size_t x, std::size_t y) { return here[x] != here[y] ? here[x] < here[y] : x < y; });
    std::size_t active = 0;
    const double h = difference_step * shortest;
    for (std::size_t i = 0; i < considered; ++i) {
      const std::size_t k = order[i];
      if (here[k] > (poorest > 0 ? active_within * poorest : 0)) break;
      Vec3 g = Vec3::Zero();
      // In double precision: the differences are small.
      const auto exact = [&](const Vec3& p) {
        const Star::StarTet& t = star.tets[k];
        return rules.objective.precise_signed(p, star.positions[t.link[0]], star.positions[t.link[1]],
                                              star.positions[t.link[2]]);
      };
      const double base = exact(at);
      for (int d = 0; d < directions_count; ++d)
        g += directions[d] * ((exact(at + h * directions[d]) - base) / h);
      gradients[active++] = g;
    }
    if (active == 0) break;
    const Vec3 uphill = shortest_of_hull(gradients, active);
    const double steep = uphill.norm();
    // Less than a thousandth of the regular tet's quality over a whole edge: at the top.
    if (!(steep * shortest > 1e-3 * std::fabs(poorest) + 1e-9)) break;
    bool better = false;
    for (int back = 0; back < most_backsteps; ++back, length *= 0.5) {
      const auto to = placed(at + uphill * (length / steep));
      if (!to) continue;
      const auto lowest = poorest_at(*to, poorest, there);
      if (!lowest) continue;
      better = *lowest > poorest + 1e-3f * std::fabs(poorest);
      at = *to;
      poorest = *lowest;
      here.swap(there);
      moved = true;
      break;
    }
    if (!better) break;
    length = std::min(2 * length, first_step * shortest);
  }
  if (!moved || !(poorest > std::max(limit, 0.0f))) return false;
  found.position = at;
  found.poorest = poorest;
  found.qualities.assign(here.begin(), here.end());
  return true;
}

Outcome smooth(Task& task, const BlockRules& rules) {
  Star& star = task.star;
  const int dimension = star.dimension();
  if (dimension == 0) return Outcome::material_rule;
  star.compute_gradients();
  Vec3 step = centroid(star, dimension) - star.centre_position;
  if (dimension == 2) step = keep_volumes(star, step);

  sort_by_quality(star);
  thread_local std::vector<float> qualities;
  qualities.resize(star.tets.size());
  const float limit = acceptance_limit(task, rules, star.poorest);
  Outcome refusal = Outcome::quality;
  float poorest;
  for (int i = 0; i < step_halvings; ++i, step *= 0.5) {
    const Vec3 to = task.mesh.snap(star.centre_position + step);
    refusal = rate(star, rules, to, limit, qualities, poorest);
    if (refusal != Outcome::done) continue;
    refusal = move_to(task, rules, to, qualities);
    if (refusal == Outcome::done || refusal == Outcome::lock_taken) return refusal;
  }
  return refusal;
}

Outcome optimise(Task& task, const BlockRules& rules) {
  Star& star = task.star;
  const int dimension = star.dimension();
  if (star.pinned || (dimension == 0 && !(rules.leave_surface && rules.slide))) return Outcome::material_rule;
  star.compute_gradients();
  thread_local Placement place;
  if (!find_place(star, task.mesh, rules, dimension, least_smoothing_gain * star.poorest, place))
    return Outcome::quality;
  return move_to(task, rules, place.position, place.qualities);
}

Outcome fit_to_surface(Task& task, const BlockRules& rules, float floor) {
  Star& star = task.star;
  if (!rules.slide || star.dimension() != 2) return Outcome::no_candidate;
  star.compute_gradients();
  const Vec3 normal = star.gradients.front().change.normalized();
  double weights = 0, pull = 0, shortest2 = std::numeric_limits<double>::infinity();
  for (const Vec3& p : star.positions)
    shortest2 = std::min(shortest2, (p - star.centre_position).squaredNorm());
  const double reach = fit_reach * std::sqrt(shortest2);
  /// A place on the triangles that moves by `weight` of what the centre moves.
  const auto sample = [&](const Vec3& at, double weight, const Star::Sheet& s) {
    const auto on = rules.slide->onto_surface(at, s.inside, s.across, reach);
    if (!on) return;
    pull += weight * normal.dot(*on - at);
    weights += weight * weight;
  };
  const Vec3& c = star.centre_position;
  sample(c, 1, star.sheets.front());
  for (const Star::Sheet& s : star.sheets)
    sample((c + star.positions[s.first] + star.positions[s.second]) / 3, 1.0 / 3, s);
  if (!(weights > 0)) return Outcome::no_candidate;
  const Vec3 to = task.mesh.snap(c + normal * (pull / weights));
  thread_local std::vector<float> qualities;
  qualities.resize(star.tets.size());
  float poorest;
  const float limit = std::min(floor, star.poorest * 0.999f);
  const Outcome o = rate(star, rules, to, limit, qualities, poorest);
  return o == Outcome::done ? move_to(task, rules, to, qualities) : o;
}

}  // namespace tetwright
