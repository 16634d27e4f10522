#include "simplify/smoothing.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tetwright {

namespace {

constexpr int step_halvings = 3;     ///< whole, half and quarter step
constexpr double first_step = 0.5;   ///< of the compass search, in shortest edges
constexpr int search_halvings = 6;   ///< after which a step is a hundredth of the shortest edge
constexpr float least_gain = 1.01f;  ///< factor on the poorest quality

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

void surface_edit(Task& task, const Vec3& to) {
  const Star& star = task.star;
  task.edit.clear();
  for (const Star::Sheet& s : star.sheets) {
    const Triangle ids{star.centre, star.points[s.first], star.points[s.second]};
    const Vec3 &p = star.positions[s.first], &q = star.positions[s.second];
    task.edit.removed.push_back({ids, {star.centre_position, p, q}});
    task.edit.added.push_back({ids, {to, p, q}});
  }
}

/// Whether the centre may stand at `to`: fills `qualities` and answers done, or why not. `limit` is what the
/// poorest tet must exceed.
Outcome rate(Star& star, const BlockRules& rules, const Vec3& to, float limit, std::vector<float>& qualities,
             float& poorest) {
  if (!star.sheets.empty() &&
      star.surface_error(to - star.centre_position, rules.gamma) > rules.largest_error)
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
Outcome move_to(Task& task, const Vec3& to, const std::vector<float>& qualities) {
  const Star& star = task.star;
  if (!star.sheets.empty()) {
    surface_edit(task, to);
    const Outcome o = task.grid.prepare(task.edit, task.grid_task, task.cells);
    if (o != Outcome::done) {
      task.cells.release();
      return o;
    }
  }
  task.mesh.set_position(star.centre, to);
  for (std::size_t k = 0; k < star.tets.size(); ++k) task.mesh.set_quality(star.tets[k].tet, qualities[k]);
  if (!star.sheets.empty()) task.grid.commit(task.edit, task.grid_task);
  return Outcome::done;
}

/// Directions that a point of the given dimension may be moved in without leaving its surface or curve.
std::array<Vec3, 3> free_directions(const Star& star, int dimension, int& count) {
  if (dimension == 3) {
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

}  // namespace

Outcome smooth(Task& task, const BlockRules& rules) {
  Star& star = task.star;
  const int dimension = star.dimension();
  if (dimension == 0) return Outcome::material_rule;
  star.compute_gradients();
  Vec3 step = centroid(star, dimension) - star.centre_position;
  if (dimension == 2) step = keep_volumes(star, step);

  // The poorest tets first: most places are refused for their sake.
  std::sort(star.tets.begin(), star.tets.end(), [](const Star::StarTet& x, const Star::StarTet& y) {
    return x.quality != y.quality ? x.quality < y.quality : x.tet < y.tet;
  });
  thread_local std::vector<float> qualities;
  qualities.resize(star.tets.size());
  Outcome refusal = Outcome::quality;
  float poorest;
  for (int i = 0; i < step_halvings; ++i, step *= 0.5) {
    const Vec3 to = star.centre_position + step;
    refusal = rate(star, rules, to, star.poorest, qualities, poorest);
    if (refusal != Outcome::done) continue;
    refusal = move_to(task, to, qualities);
    if (refusal == Outcome::done || refusal == Outcome::lock_taken) return refusal;
  }
  return refusal;
}

Outcome optimise(Task& task, const BlockRules& rules) {
  Star& star = task.star;
  const int dimension = star.dimension();
  if (dimension == 0) return Outcome::material_rule;
  star.compute_gradients();
  std::sort(star.tets.begin(), star.tets.end(), [](const Star::StarTet& x, const Star::StarTet& y) {
    return x.quality != y.quality ? x.quality < y.quality : x.tet < y.tet;
  });
  int count;
  const std::array<Vec3, 3> directions = free_directions(star, dimension, count);
  double shortest = std::numeric_limits<double>::infinity();
  for (const Vec3& p : star.positions)
    shortest = std::min(shortest, (p - star.centre_position).squaredNorm());

  thread_local std::vector<float> qualities, best_qualities;
  qualities.resize(star.tets.size());
  Vec3 best = star.centre_position;
  float best_poorest = star.poorest;
  double length = first_step * std::sqrt(shortest);
  for (int halving = 0; halving < search_halvings;) {
    bool better = false;
    for (int d = 0; d < 2 * count; ++d) {
      const Vec3 to = best + (d % 2 ? -length : length) * directions[d / 2];
      float poorest;
      if (rate(star, rules, to, best_poorest, qualities, poorest) != Outcome::done) continue;
      best = to;
      best_poorest = poorest;
      best_qualities.swap(qualities);
      qualities.resize(star.tets.size());
      better = true;
      break;
    }
    if (better) continue;  // every success raises the poorest quality, which is bounded: the search ends
    length *= 0.5;
    ++halving;
  }
  // A gain too small to matter is not worth another round's work.
  if (!(best_poorest > least_gain * star.poorest)) return Outcome::quality;
  return move_to(task, best, best_qualities);
}

}  // namespace tetwright
