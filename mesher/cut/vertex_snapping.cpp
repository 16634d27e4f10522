// SPDX-License-Identifier: Apache-2.0
#include "mesher/cut/vertex_snapping.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>
#include <span>

#include "common/geometry/morton.h"
#include "common/parallel/parallel_sort.h"
#include "common/random.h"
#include "common/tolerances.h"
#include "mesher/cut/cutting.h"
#include "mesher/cut/independent_rounds.h"
#include "mesher/cut/last_tries.h"
#include "mesher/cut/link_topology.h"
#include "mesher/cut/scattered_groups.h"
#include "mesher/tuning/cut_tuning.h"
#include "tetwright/mesh_quality.h"

namespace tetwright {

namespace {

using Snapping = CutTuning::Snapping;

/// A point too close to a cut, and its target.
struct Candidate {
  Index point;
  Index other;     ///< the other end of the edge with the nearest cut
  Vec3 projected;  ///< projection onto the set where all regions of the star meet
  /// Edge to `other` before any point was moved; a multiple of half a lattice unit, exact in a float.
  Eigen::Vector3f edge;
  std::uint8_t at_junction;  ///< 1 if the star has more than two regions
  std::uint8_t rank;         ///< distance from the interface or junction, in steps

  double room() const { return edge.cast<double>().norm(); }
  /// Points near junction curves move first: after a move onto an interface they could not reach the curve.
  int priority() const { return at_junction ? rank : rank + static_cast<int>(Snapping::distance_steps) + 1; }
};

class Mover {
 public:
  Mover(LabelledLattice& lattice, const MaterialField& field, Progress* progress)
      : lattice_(lattice), field_(field), rounds_(lattice), progress_(progress) {}

  SnapCounts run() {
    find_blocks();
    find_candidates();
    SnapCounts counts;
    counts.candidates = candidates_.size();
    std::vector<Index> order(candidates_.size());
    std::iota(order.begin(), order.end(), Index{0});
    std::vector<Index> left = attempt(
        std::move(order), [&](Index i) { return candidate(i).priority(); },
        [&](Index i, FieldSampler&) { return move(candidate(i)); });
    // Try again: moves of neighbours may have made the move valid.
    left = attempt(std::move(left), one_priority, [&](Index i, FieldSampler& sampler) {
      return move(candidate(i)) || project_nearer_to_middle(candidate(i), sampler);
    });
    counts.moved = candidates_.size() - left.size();
    counts.pushed = left.size() - attempt(left, one_priority, [&](Index i, FieldSampler& sampler) {
                                    return push_away(candidate(i), sampler);
                                  }).size();
    std::vector<Candidate>().swap(candidates_);
    std::vector<Index>().swap(by_rank_);
    improve_worst_stars();
    return counts;
  }

 private:
  StarMap::Tets star(Index p) const { return lattice_.stars.tets(p); }

  /// Sets the groups by block of a volume, before any point is moved.
  void find_blocks() {
    if (!field_.volume()) return;
    const std::vector<Index>& near = lattice_.stars.points();
    const double side = std::ldexp(Snapping::block_side, field_.refinement());  // lattice units
    std::vector<std::uint64_t>& blocks = blocks_.emplace().blocks;
    blocks.resize(near.size());
    parallel_for(0, near.size(), CutGrains::candidates, [&](std::size_t begin, std::size_t end) {
      for (std::size_t s = begin; s < end; ++s) {
        const Vec3& at = lattice_.positions[near[s]];
        blocks[s] = mixed_bits(morton_encode(static_cast<int>(at[0] / side), static_cast<int>(at[1] / side),
                                             static_cast<int>(at[2] / side)));
      }
    });
  }
  /// Groups `items`, whose points are `point(item)`; see tetwright::scatter_groups().
  template <class Priority, class PointOf>
  std::vector<std::size_t> scatter_groups(std::vector<Index>& items, Priority&& priority,
                                          PointOf&& point) const {
    const auto slot = [&](Index i) { return lattice_.stars.slot(point(i)); };
    return blocks_ ? tetwright::scatter_groups(items, priority, slot, *blocks_)
                   : tetwright::scatter_groups(items, priority, slot, GroupsOfNumbers());
  }

  /// The i-th candidate to be tried.
  const Candidate& candidate(Index i) const { return candidates_[by_rank_[i]]; }

  static constexpr auto one_priority = [](Index) { return 0; };

  /// Calls `work(i, sampler)` for the listed candidates, in groups and one priority after another. Returns
  /// the candidates for which it returned false, in the order of their points.
  template <class Priority, class Work>
  std::vector<Index> attempt(std::vector<Index> list, Priority&& priority, Work&& work) {
    const std::vector<std::size_t> starts =
        scatter_groups(list, priority, [&](Index i) { return candidate(i).point; });
    std::vector<Index> points(list.size());
    for (std::size_t k = 0; k < list.size(); ++k) points[k] = candidate(list[k]).point;
    std::vector<std::uint8_t> done(list.size(), 0);
    run_groups(points, starts, [&](std::size_t k, FieldSampler& sampler) -> bool {
      done[k] = work(list[k], sampler);
      return done[k];
    });
    std::vector<Index> left;
    for (std::size_t k = 0; k < list.size(); ++k)
      if (!done[k]) left.push_back(list[k]);
    parallel_sort(left, [&](Index a, Index b) { return by_rank_[a] < by_rank_[b]; });
    return left;
  }

  /// Calls `work(k, sampler)` for each index k of `points`, which returns true if it has changed the point;
  /// groups that share a star point run in order.
  template <class Work>
  void run_groups(std::span<const Index> points, std::span<const std::size_t> starts, Work&& work) {
    ++pass_;
    rounds_.run(
        points, starts,
        [&](std::span<const Index> groups) {
          const std::unique_ptr<FieldSampler> owned = field_.sampler();
          FieldSampler& sampler = *owned;
          for (Index g : groups)
            for (std::size_t k = starts[g]; k < starts[g + 1]; ++k)
              if (work(k, sampler)) record(points[k]);
        },
        [&](std::size_t done) {
          if (!progress_) return;
          progress_->throw_if_stopped();
          progress_->update(static_cast<double>(done) / static_cast<double>(starts.size()));
        });
  }

  /// Adds the current state of a point to its history.
  void record(Index p) {
    if (lattice_.histories.empty()) return;
    std::uint64_t& history = lattice_.histories[lattice_.stars.slot(p)];
    history = mixed_bits(history ^ pass_);
    for (const double coordinate : lattice_.positions[p])
      history = mixed_bits(history ^ std::bit_cast<std::uint64_t>(coordinate));
  }

  /// True for points whose region the mesh must keep.
  bool is_certain(Index p) const {
    const VoxelVolume* volume = field_.volume();
    return volume && volume->is_certain(lattice_.positions[p]);
  }

  /// The candidate for a point; std::nullopt if no cut is too close to it or it must not be moved.
  std::optional<Candidate> as_candidate(Index p, FieldSampler& sampler) const {
    const RegionIndex own = lattice_.first_region[p];
    if (lattice_.is_on[p] || is_certain(p)) return std::nullopt;
    const std::optional<RegionSet> regions = pure_regions(lattice_, p);
    if (!regions) return std::nullopt;
    const unsigned planes = lattice_.held_planes(p);
    double nearest = 0;
    Index other = no_index, beyond = no_index;
    bool too_near = false;
    for (Index t : star(p))
      for (Index q : lattice_.tets[t]) {
        const RegionIndex r = lattice_.first_region[q];
        if (r == own || lattice_.is_on[q]) continue;
        const double share = lattice_.cut_share(p, own, q, r);
        too_near |= share <= (lattice_.is_centre[p] == lattice_.is_centre[q] ? Snapping::near_long
                                                                             : Snapping::near_short);
        if ((lattice_.held_planes(q) & planes) != planes) {
          // Out of reach, unless the interface is in the border of a volume, where the point already is.
          if (planes >> 6 && share <= Snapping::is_there) beyond = std::min(beyond, q);
          continue;
        }
        const double length = share * (lattice_.positions[q] - lattice_.positions[p]).norm();
        if (other == no_index || length < nearest || (length == nearest && q < other)) {
          nearest = length;
          other = q;
        }
      }
    const bool is_there = other == no_index;
    if (is_there) other = beyond;
    if (!too_near || other == no_index) return std::nullopt;
    const Vec3 &from = lattice_.positions[p], &to = is_there ? from : lattice_.positions[other];
    Candidate c;
    c.point = p;
    c.other = other;
    c.at_junction = regions->size() > 2;
    c.edge = (to - from).cast<float>();
    c.projected = from;
    // Beyond a ridge of the distance the gradient does not lead to the interface.
    if (!sampler.project(*regions, c.projected, held_axes(p)) || (c.projected - from).norm() > c.room())
      c.projected = on_edge(c);
    const double distance = c.at_junction ? (c.projected - from).norm() : lattice_.margin(p);
    const double share = is_there ? 0 : std::clamp(distance / c.room(), 0.0, 1.0);
    c.rank = static_cast<std::uint8_t>(share * Snapping::distance_steps);
    return c;
  }

  /// The axes along which a point must not move, one bit each: points stay on the faces, edges and corners of
  /// the box, and on the planes of the border of a volume.
  unsigned held_axes(Index p) const {
    const unsigned planes = lattice_.held_planes(p);
    unsigned axes = 0;
    for (int a = 0; a < 3; ++a)
      if ((planes | planes >> 6) >> 2 * a & 3) axes |= 1u << a;
    return axes;
  }
  Vec3 without_held(Index p, Vec3 step) const {
    const unsigned held = held_axes(p);
    for (int a = 0; a < 3; ++a)
      if (held >> a & 1) step[a] = 0;
    return step;
  }

  /// The closest cut; valid until the point is moved.
  Vec3 on_edge(const Candidate& c) const {
    const double share =
        lattice_.cut_share(c.point, lattice_.first_region[c.point], c.other, other_region(c));
    return lattice_.positions[c.point] + c.edge.cast<double>() * share;
  }
  /// The region at the other end of the edge with the closest cut.
  RegionIndex other_region(const Candidate& c) const { return lattice_.first_region[c.other]; }

  void find_candidates() {
    const std::vector<Index>& near = lattice_.stars.points();
    candidates_ =
        parallel_collect<Candidate>(0, near.size(), CutGrains::candidates,
                                    [&](std::size_t begin, std::size_t end, std::vector<Candidate>& out) {
                                      const std::unique_ptr<FieldSampler> owned = field_.sampler();
                                      FieldSampler& sampler = *owned;
                                      for (std::size_t i = begin; i < end; ++i)
                                        if (const std::optional<Candidate> c = as_candidate(near[i], sampler))
                                          out.push_back(*c);
                                    });
    // The order of moves depends on priorities.
    if (!lattice_.histories.empty())
      for (const Candidate& c : candidates_) {
        std::uint64_t& history = lattice_.histories[lattice_.stars.slot(c.point)];
        history = mixed_bits(history ^ static_cast<std::uint64_t>(c.priority()));
      }
    by_rank_.resize(candidates_.size());
    std::iota(by_rank_.begin(), by_rank_.end(), Index{0});
    parallel_sort(by_rank_, [&](Index a, Index b) {
      return std::pair(candidates_[a].priority(), a) < std::pair(candidates_[b].priority(), b);
    });
  }

  /// True if all incident lattice tets have solid angles of at least 0.1 sr with the point at `place`.
  bool star_is_good(Index p, const Vec3& place) const {
    for (Index t : star(p)) {
      std::array<const Vec3*, 4> x;
      for (std::size_t k = 0; k < 4; ++k) {
        const Index v = lattice_.tets[t][k];
        x[k] = v == p ? &place : &lattice_.positions[v];
      }
      if (!(min_solid_angle_tangent(*x[0], *x[1], *x[2], *x[3]) >= CutTuning::Shapes::tangent_of_bad_tet))
        return false;
    }
    return true;
  }

  bool move(const Candidate& c) {
    const Vec3 cut = on_edge(c);
    const bool projected = star_is_good(c.point, c.projected);
    if (!projected && !star_is_good(c.point, cut)) return false;
    const std::optional<RegionSet> regions = regions_if_moved(lattice_, c.point);
    if (!regions) return false;
    // The cut of an edge lies on the interface of two regions, not on a junction curve.
    const bool on_interface_of_two = regions->size() == 2 && regions->contains(other_region(c));
    if (projected && (c.projected != cut || on_interface_of_two)) return put(c.point, c.projected);
    return on_interface_of_two && star_is_good(c.point, cut) && put(c.point, cut);
  }

  bool put(Index p, const Vec3& place) {
    lattice_.positions[p] = place;
    lattice_.is_on[p] = 1;
    return true;
  }

  /// The mean of the other vertices of all incident tets, with multiplicity.
  Vec3 middle_of_star(Index p) const {
    Vec3 sum = Vec3::Zero();
    double count = 0;
    for (Index t : star(p))
      for (Index q : lattice_.tets[t])
        if (q != p) {
          sum += lattice_.positions[q];
          ++count;
        }
    return sum / count;
  }

  /// Moves the point to a position on the interface closer to the middle of its star, where the incident tets
  /// are better shaped. Returns false if no such position is valid.
  bool project_nearer_to_middle(const Candidate& c, FieldSampler& sampler) {
    const Index p = c.point;
    const std::optional<RegionSet> regions = regions_if_moved(lattice_, p);
    if (!regions) return false;
    const Vec3 to_middle = without_held(p, middle_of_star(p) - lattice_.positions[p]);
    for (double share : {0.0, 0.5, 1.0}) {
      Vec3 place = lattice_.positions[p] + share * to_middle;
      if (sampler.project(*regions, place, held_axes(p)) &&
          (place - lattice_.positions[p]).norm() <= c.room() && star_is_good(p, place))
        return put(p, place);
    }
    return false;
  }

  struct WorstPiece {
    double tangent;
    Index tet;
  };
  /// The worst piece of the star of a point; nothing if it is not better than `best`.
  std::optional<WorstPiece> worst_piece(Index p, double best) const {
    WorstPiece worst{1, *star(p).begin()};
    for (Index t : star(p)) {
      const double tangent = worst_piece_tangent(lattice_, lattice_.tets[t], best);
      if (!(tangent > best)) return std::nullopt;
      if (tangent < worst.tangent) worst = {tangent, t};
    }
    return worst;
  }

  /// Moves a point to the position in `places` that gives the best worst piece of its star, if that improves
  /// it. The point keeps its region, and lattice tets keep solid angles of 0.1 sr. Returns true if the point
  /// was moved.
  bool move_to_best(Index p, std::span<const Vec3> places, FieldSampler& sampler) {
    const bool on = lattice_.is_on[p];
    const Vec3 from = lattice_.positions[p];
    Vec3 best_place = from;
    const std::span<float> values = lattice_.star_values(p);
    std::vector<float> best_values(values.begin(), values.end());
    constexpr double any = -1;
    WorstPiece best = *worst_piece(p, any);
    for (const Vec3& place : places) {
      if (!on) {
        const NearestRegion there = sampler.nearest(place);
        if (there.region != lattice_.first_region[p] || there.margin >= field_.band()) continue;
      }
      lattice_.positions[p] = place;
      if (!on) sampler.values(place, lattice_.star_regions(p), values.data());
      // Most positions are refused because of the tet that was the worst.
      if (!(worst_piece_tangent(lattice_, lattice_.tets[best.tet], best.tangent) > best.tangent) ||
          !star_is_good(p, place))
        continue;
      const std::optional<WorstPiece> worst = worst_piece(p, best.tangent);
      if (!worst) continue;
      best = *worst;
      best_place = place;
      best_values.assign(values.begin(), values.end());
    }
    lattice_.positions[p] = best_place;
    std::copy(best_values.begin(), best_values.end(), values.begin());
    return best_place != from;
  }

  /// Moves a point away from an interface that it could not be moved onto, so that the pieces around it
  /// become thicker.
  bool push_away(const Candidate& c, FieldSampler& sampler) {
    const Index p = c.point;
    Vec3 gradient;
    const double value =
        sampler.between(lattice_.first_region[p], other_region(c), lattice_.positions[p], gradient);
    gradient = without_held(p, gradient);
    const double slope = gradient.norm();
    if (!(slope > 0)) return false;
    std::vector<Vec3> places;
    for (double share : {0.15, 0.25, 0.35, 0.5})
      if (const double step = share * c.room() - std::abs(value); step > 0)
        places.push_back(lattice_.positions[p] - gradient * (step / slope));
    return move_to_best(p, places, sampler);
  }

  bool is_bad(const Tet& t) const {
    return std::any_of(t.begin(), t.end(), [&](Index v) { return lattice_.stars.lists(v); }) &&
           worst_piece_tangent(lattice_, t) < CutTuning::Shapes::tangent_of_bad_tet;
  }

  /// The numbers `tet(i)`, i < count, of tets with a piece below the limit, in this order.
  template <class TetOf>
  std::vector<Index> bad_tets(std::size_t count, TetOf&& tet) const {
    return parallel_collect<Index>(
        0, count, CutGrains::stars, [&](std::size_t begin, std::size_t end, std::vector<Index>& out) {
          for (std::size_t i = begin; i < end; ++i)
            if (const auto t = static_cast<Index>(tet(i)); is_bad(lattice_.tets[t])) out.push_back(t);
        });
  }

  /// Moves the points near interfaces of tets with a piece below the limit: points on an interface stay on
  /// it, the others keep their region.
  void improve_worst_stars() {
    std::vector<Index> bad = bad_tets(lattice_.tets.size(), [](std::size_t i) { return i; });
    LastTries tries(lattice_.stars.points().size());
    for (int sweep = 0; sweep < Snapping::sweeps && !bad.empty(); ++sweep) {
      std::vector<Index> points;
      for (Index t : bad)
        for (Index v : lattice_.tets[t])
          if (lattice_.stars.lists(v)) points.push_back(v);
      parallel_sort_unique(points);
      const std::vector<std::size_t> starts = scatter_groups(points, one_priority, [](Index p) { return p; });
      std::vector<std::uint8_t> moved(points.size(), 0);
      run_groups(points, starts, [&](std::size_t k, FieldSampler& sampler) -> bool {
        const Index p = points[k];
        if (nothing_new(p, tries)) return false;
        moved[k] = improve_star(p, sampler);
        tries.record(lattice_.stars.slot(p), k, moved[k]);
        return moved[k];
      });
      tries.end_sweep(points.size());
      // Pieces of all other tets are what they were.
      std::vector<Index> changed;
      for (std::size_t k = 0; k < points.size(); ++k)
        if (moved[k]) changed.insert(changed.end(), star(points[k]).begin(), star(points[k]).end());
      parallel_sort_unique(changed);
      std::vector<Index> unchanged, left;
      std::set_difference(bad.begin(), bad.end(), changed.begin(), changed.end(),
                          std::back_inserter(unchanged));
      changed = bad_tets(changed.size(), [&](std::size_t i) { return changed[i]; });
      std::merge(unchanged.begin(), unchanged.end(), changed.begin(), changed.end(),
                 std::back_inserter(left));
      bad.swap(left);
    }
  }

  /// Whether another try would only repeat the last one: it reads the closed star, where no point has moved.
  bool nothing_new(Index p, const LastTries& tries) const {
    const Index slot = lattice_.stars.slot(p);
    if (!tries.tried(slot)) return false;
    for (Index t : star(p))
      for (Index q : lattice_.tets[t])
        if (const Index s = lattice_.stars.slot(q); s != no_index && tries.moved_since(s, slot)) return false;
    return true;
  }

  /// Returns true if the point was moved.
  bool improve_star(Index p, FieldSampler& sampler) {
    if (!lattice_.is_on[p] && is_certain(p)) return false;
    std::vector<Vec3> places;
    const Vec3 from = lattice_.positions[p], to_middle = without_held(p, middle_of_star(p) - from);
    if (lattice_.is_on[p]) {
      const std::optional<RegionSet> regions = pure_regions(lattice_, p);
      if (!regions) return false;
      for (double share : Snapping::steps_on_interface) {
        Vec3 place = from + share * to_middle;
        if (sampler.project(*regions, place, held_axes(p))) places.push_back(place);
      }
    } else if (const RegionIndex other = nearest_other(p); other != on_interface) {
      Vec3 gradient;
      const double value = sampler.between(lattice_.first_region[p], other, from, gradient);
      gradient = without_held(p, gradient);
      for (double share : Snapping::steps_off_interface)
        places.push_back(from + gradient * (share * value /
                                            std::max(tolerance::min_squared_slope, gradient.squaredNorm())));
      places.push_back(from + Snapping::step_to_middle * to_middle);
    }
    return move_to_best(p, places, sampler);
  }

  /// The region of the smallest distance among the other regions of the star; on_interface if there is none.
  RegionIndex nearest_other(Index p) const {
    RegionIndex best = on_interface;
    float smallest = HUGE_VALF;
    const auto regions = lattice_.star_regions(p);
    const auto values = lattice_.star_values(p);
    for (std::size_t i = 0; i < regions.size(); ++i)
      if (regions[i] != lattice_.first_region[p] && values[i] < smallest)
        smallest = values[i], best = regions[i];
    return best;
  }

  LabelledLattice& lattice_;
  const MaterialField& field_;
  IndependentRounds rounds_;
  Progress* progress_;
  std::optional<GroupsByBlock> blocks_;  ///< of a volume
  std::uint64_t pass_ = 0;               ///< number of calls of run_groups()
  std::vector<Candidate> candidates_;    ///< in the order of their points
  std::vector<Index> by_rank_;           ///< indices into candidates_, by priority, then point
};

}  // namespace

SnapCounts snap_vertices(LabelledLattice& lattice, const MaterialField& field, Progress* progress) {
  return Mover(lattice, field, progress).run();
}

}  // namespace tetwright
