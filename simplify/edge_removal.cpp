#include "simplify/edge_removal.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "common/portable_math.h"
#include "common/predicates.h"
#include "simplify/refill.h"

namespace tetwright {

namespace {

constexpr std::size_t most_polygon = 8;  ///< points; a chain of seven tets has eight

/// The best triangulation of the polygon p[0..n-1] between the edge's ends a (below) and b (above): the
/// poorest tet is as good as can be.
class RingTriangulation {
 public:
  /// False if none has only tets better than `limit`.
  bool find(const EditableMesh& mesh, const BlockRules& rules, Index a, Index b,
            const std::vector<Index>& polygon, float limit) {
    polygon_ = &polygon;
    const std::size_t n = polygon.size();
    for (std::size_t i = 0; i + 1 < n; ++i) best_[i][i + 1] = std::numeric_limits<float>::infinity();
    for (std::size_t length = 2; length < n; ++length)
      for (std::size_t i = 0; i + length < n; ++i) {
        const std::size_t j = i + length;
        best_[i][j] = 0;
        for (std::size_t k = i + 1; k < j; ++k) {
          const float known = std::min(best_[i][k], best_[k][j]);
          if (known <= limit || known <= best_[i][j]) continue;
          const float above = quality_of(mesh, rules, {polygon[i], polygon[k], polygon[j], b});
          if (above <= limit || above <= best_[i][j]) continue;
          const float below = quality_of(mesh, rules, {polygon[i], polygon[j], polygon[k], a});
          const float value = std::min({known, above, below});
          if (value <= limit || value <= best_[i][j]) continue;
          best_[i][j] = value;
          middle_[i][j] = k;
        }
      }
    return best_[0][n - 1] > limit;
  }

  /// Calls f(i, k, j) for each triangle, polygon places ascending.
  template <class F>
  void triangles(const F& f) const {
    triangles(0, polygon_->size() - 1, f);
  }

 private:
  template <class F>
  void triangles(std::size_t i, std::size_t j, const F& f) const {
    if (j < i + 2) return;
    const std::size_t k = middle_[i][j];
    f(i, k, j);
    triangles(i, k, f);
    triangles(k, j, f);
  }

  const std::vector<Index>* polygon_ = nullptr;
  std::array<std::array<float, most_polygon>, most_polygon> best_{};
  std::array<std::array<std::size_t, most_polygon>, most_polygon> middle_{};
};

Vec3 normal_of(const Vec3& a, const Vec3& b, const Vec3& c) { return (b - a).cross(c - a); }

/// The interface triangles of an edge (a, b) with sheets to s and t, turned to the edge (s, t).
Outcome prepare_surface(Task& task, const BlockRules& rules, Index s, Index t, Region inside, Region across) {
  const EditableMesh& mesh = task.mesh;
  const EdgeRing& ring = task.ring;
  const Vec3 &a = mesh.position(ring.a), &b = mesh.position(ring.b), &ps = mesh.position(s),
             &pt = mesh.position(t);
  const double swept = std::fabs(orient3d_value(a, b, ps, pt)) / 6;
  const int materials = across == beyond_mesh ? 1 : 2;
  if (rules.gamma * materials * portable_cbrt(swept) > rules.largest_error) return Outcome::surface_error;
  // No fold: every new triangle looks the way both old ones look.
  const std::array<Vec3, 2> before{normal_of(a, ps, b), normal_of(a, b, pt)};
  const std::array<Vec3, 2> after{normal_of(a, ps, pt), normal_of(b, pt, ps)};
  for (const Vec3& n : after)
    for (const Vec3& m : before)
      if (!(n.dot(m) > 0)) return Outcome::surface_error;
  task.edit.clear();
  task.edit.removed = {{{ring.a, ring.b, s}, {a, b, ps}}, {{ring.a, ring.b, t}, {a, b, pt}}};
  task.edit.added = {{{ring.a, s, t}, {a, ps, pt}}, {{ring.b, s, t}, {b, ps, pt}}};
  for (const MeshTriangle& n : task.edit.added)
    if (!near_reference(rules, n, inside, across)) return Outcome::surface_error;
  return task.grid.prepare(task.edit, task.grid_task, task.cells);
}

Outcome try_remove(Task& task, const BlockRules& rules, const FlipReach& reach, Operation& kind) {
  EditableMesh& mesh = task.mesh;
  EdgeRing& ring = task.ring;
  const int dimension = ring.dimension();
  const std::size_t n = ring.tets.size();
  // Chains of points, one for each region.
  thread_local std::array<std::vector<Index>, 2> chains;
  thread_local std::array<RingTriangulation, 2> filled;
  std::size_t chain_count = 1;
  if (dimension == 1) return Outcome::material_rule;
  chains[0].clear();
  chains[1].clear();
  std::array<Region, 2> regions{ring.regions[0], ring.regions[0]};
  if (dimension == 2 && ring.closed) {
    ring.begin_at_sheet();
    chain_count = 2;
    regions = {ring.regions.front(), ring.regions.back()};
    std::size_t k = 0;
    for (; k < n && ring.regions[k] == regions[0]; ++k) chains[0].push_back(ring.points[k]);
    chains[0].push_back(ring.points[k]);
    for (; k < n; ++k) chains[1].push_back(ring.points[k]);
    chains[1].push_back(ring.points[0]);
    kind = n == 4 && chains[0].size() == 3 ? Operation::flip44 : Operation::edge_removal;
  } else {
    chains[0] = ring.points;
    if (dimension == 3) {
      kind = n == 3 ? Operation::flip32 : Operation::edge_removal;
    } else {
      kind = n == 2 ? Operation::flip22 : Operation::edge_removal;
    }
  }
  if (reach.basic() && kind == Operation::edge_removal) return Outcome::no_candidate;
  for (std::size_t c = 0; c < chain_count; ++c) {
    if (chains[c].size() < 3) return Outcome::no_candidate;
    if (chains[c].size() > most_polygon || (dimension == 3 && n > reach.most_ring)) return Outcome::too_large;
  }
  if (mesh.any_pinned() &&
      (mesh.pinned(ring.a) || mesh.pinned(ring.b) ||
       std::any_of(ring.points.begin(), ring.points.end(), [&](Index p) { return mesh.pinned(p); })))
    return Outcome::material_rule;

  if (!ring.closed && !whole_ring(task)) return Outcome::material_rule;
  const float limit = acceptance_limit(task, rules, ring.poorest);
  for (std::size_t c = 0; c < chain_count; ++c)
    if (!filled[c].find(mesh, rules, ring.a, ring.b, chains[c], limit)) return Outcome::quality;

  Cavity& cavity = task.cavity;
  cavity.clear();
  cavity.removed = ring.tets;
  bool present = false;
  for (std::size_t c = 0; c < chain_count; ++c) {
    const std::vector<Index>& p = chains[c];
    filled[c].triangles([&](std::size_t i, std::size_t k, std::size_t j) {
      for (const Tet& t : {Tet{p[i], p[k], p[j], ring.b}, Tet{p[i], p[j], p[k], ring.a}})
        cavity.added.push_back({t, regions[c], quality_of(mesh, rules, t)});
      // Diagonals must be new; of a ring of three the triangle must be.
      if (dimension == 3 && n == 3) {
        present |=
            any_in_star(task, p[i], [&](const Tet& t) { return contains(t, p[k]) && contains(t, p[j]); });
      } else if (j - i > 1 && !(dimension == 3 && i == 0 && j + 1 == p.size())) {
        present |= joined(task, p[i], p[j]);
      }
    });
  }
  if (present) return Outcome::link_condition;
  if (cavity.added.size() > n && !task.slots.reserve(cavity.added.size() - n)) return Outcome::no_room;
  if (dimension == 2) {
    const Outcome o = prepare_surface(task, rules, chains[0].front(), chains[0].back(), regions[0],
                                      ring.closed ? regions[1] : beyond_mesh);
    if (o != Outcome::done) {
      task.cells.release();
      return o;
    }
  }
  std::array<VolumeLedger::Change, 2> volumes{{{regions[0], 0}, {beyond_mesh, 0}}};
  if (dimension == 2) {
    double gained = 0;
    for (const NewTet& t : cavity.added)
      if (t.region == regions[0])
        gained += orient3d_value(mesh.position(t.points[0]), mesh.position(t.points[1]),
                                 mesh.position(t.points[2]), mesh.position(t.points[3])) /
                  6;
    for (std::size_t i = 0; i < n; ++i)
      if (ring.regions[i] == regions[0]) gained -= mesh.signed_volume(ring.tets[i]);
    volumes[0].volume = gained;
    if (ring.closed) volumes[1] = {regions[1], -gained};
    if (!task.ledger.book(volumes)) {
      task.cells.release();
      return Outcome::volume;
    }
  }
  if (!mesh.change_count(static_cast<std::int64_t>(cavity.added.size()) - static_cast<std::int64_t>(n),
                         rules.fewest_tets, rules.most_tets)) {
    task.ledger.take_back(volumes);
    task.cells.release();
    return Outcome::count;
  }
  refill(task, cavity);
  if (dimension == 2) {
    task.grid.commit(task.edit, task.grid_task);
    task.cells.release();
  }
  return Outcome::done;
}

}  // namespace

Outcome remove_edge(Task& task, const BlockRules& rules, Index tet, int edge, const FlipReach& reach) {
  Operation kind = Operation::edge_removal;
  Outcome o = task.ring.gather(task.mesh, tet, edge, task.points);
  if (o == Outcome::done) o = try_remove(task, rules, reach, kind);
  if (reach.basic() && kind == Operation::edge_removal)
    return o;  // none of the three flips: nothing was tried
  task.counts.add(kind, o);
  return o;
}

}  // namespace tetwright
