#include "mesher/point_mover.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>
#include <span>

#include "common/parallel_sort.h"
#include "common/quality.h"
#include "mesher/arrangement.h"
#include "mesher/cutting.h"
#include "mesher/independent_rounds.h"

namespace tetwright {

namespace {

/// A cut nearer than this share of the edge is too near. Measured on scans: with the classic 0.25 / 0.41 flat
/// patches snap from both sides and tets turn over.
constexpr double near_long = 0.35;
constexpr double near_short = 0.49;

/// No lattice tet may get a smaller solid angle than 0.1 steradians by a move: the dial for the smallest
/// dihedral angle (0.06 gives 6 degrees, 0.1 gives 11, 0.14 gives 13, but then more points are refused). As
/// the tangent of its half, which is what is compared.
constexpr double smallest_tangent = 0.05004170837553879;

/// "Nearest first" goes by steps of this share of an edge: along a flat face all points have nearly the same
/// distance.
constexpr double distance_steps = 32;  // a byte holds it

/// Points that are worked on one after the other by one thread.
constexpr std::size_t block_size = 16;

/// Spreads neighbours over the order, so that blocks worked on at the same time rarely meet.
std::uint32_t scattered(Index i) {
  std::uint32_t h = i * 0x9e3779b9u;
  h ^= h >> 15;
  h *= 0x85ebca6bu;
  return h ^ h >> 13;
}

/// Cuts a list into blocks of neighbours and scatters those. `group(item)` does not fall along the list, and
/// stays the same in a block; within a group near items stand together. Returns where blocks start, and the
/// end.
template <class Group>
std::vector<std::size_t> scatter_blocks(std::vector<Index>& items, Group&& group) {
  struct Block {
    std::size_t first, last;
    std::uint32_t key;
  };
  std::vector<Block> blocks;
  for (std::size_t i = 0, j; i < items.size(); i = j) {
    for (j = i + 1; j < items.size() && j - i < block_size && group(items[j]) == group(items[i]);) ++j;
    blocks.push_back({i, j, scattered(items[i])});
  }
  for (std::size_t i = 0, j; i < blocks.size(); i = j) {
    const auto now = group(items[blocks[i].first]);
    for (j = i; j < blocks.size() && group(items[blocks[j].first]) == now;) ++j;
    std::sort(blocks.begin() + static_cast<std::ptrdiff_t>(i),
              blocks.begin() + static_cast<std::ptrdiff_t>(j),
              [](const Block& a, const Block& b) { return a.key < b.key; });
  }
  std::vector<Index> scattered_items;
  scattered_items.reserve(items.size());
  std::vector<std::size_t> starts{0};
  for (const Block& b : blocks) {
    scattered_items.insert(scattered_items.end(), items.begin() + static_cast<std::ptrdiff_t>(b.first),
                           items.begin() + static_cast<std::ptrdiff_t>(b.last));
    starts.push_back(scattered_items.size());
  }
  items.swap(scattered_items);
  return starts;
}

/// A point with a cut too near to it, and where it could go.
struct Candidate {
  Index point;
  Index other;     ///< the other end of the edge with the nearest cut
  Vec3 projected;  ///< where all regions of the star meet, or the interface along the gradient
  /// The edge with the nearest cut before any point was moved: of whole and half lattice units.
  Eigen::Vector3f edge;
  std::uint8_t at_junction;  ///< 1: more than two regions in its star
  std::uint8_t rank;         ///< distance from where it should go, in steps

  double room() const { return edge.cast<double>().norm(); }
  /// Points near junction curves go first: moved onto a sheet they could not reach the curve any more.
  int group() const { return at_junction ? rank : rank + static_cast<int>(distance_steps) + 1; }
};

class Mover {
 public:
  Mover(LabelledLattice& lattice, const MaterialField& field, Progress* progress)
      : lattice_(lattice), field_(field), rounds_(lattice), progress_(progress) {}

  MoveCounts run() {
    find_candidates();
    MoveCounts counts;
    counts.candidates = candidates_.size();
    std::vector<Index> order(candidates_.size());
    std::iota(order.begin(), order.end(), Index{0});
    std::vector<Index> left = attempt(
        std::move(order), [&](Index i) { return candidate(i).group(); },
        [&](Index i, FieldSampler&) { return move(candidate(i)); });
    // Neighbours that moved since may have made room.
    left = attempt(std::move(left), one_group, [&](Index i, FieldSampler& sampler) {
      return move(candidate(i)) || slide(candidate(i), sampler);
    });
    counts.moved = candidates_.size() - left.size();
    counts.pushed = left.size() - attempt(left, one_group, [&](Index i, FieldSampler& sampler) {
                                    return push_away(candidate(i), sampler);
                                  }).size();
    // The first sweep mends most; the others the few whose neighbours had to move first.
    std::vector<Candidate>().swap(candidates_);
    std::vector<Index>().swap(by_rank_);
    constexpr int sweeps = 4;
    std::vector<Index> tets = mend_poor_stars(lattice_.tets.size(), [](std::size_t i) { return i; });
    for (int sweep = 1; sweep < sweeps && !tets.empty(); ++sweep)
      tets = mend_poor_stars(tets.size(), [&](std::size_t i) { return tets[i]; });
    return counts;
  }

 private:
  StarMap::Tets star(Index p) const { return lattice_.stars.tets(p); }

  /// Number i in the order in which they are tried.
  const Candidate& candidate(Index i) const { return candidates_[by_rank_[i]]; }

  static constexpr auto one_group = [](Index) { return 0; };

  /// Runs `work(i, sampler)` for the candidates listed, group after group, and returns those for which it was
  /// false, in the order of their points.
  template <class Group, class Work>
  std::vector<Index> attempt(std::vector<Index> list, Group&& group, Work&& work) {
    const std::vector<std::size_t> starts = scatter_blocks(list, group);
    std::vector<Index> points(list.size());
    for (std::size_t k = 0; k < list.size(); ++k) points[k] = candidate(list[k]).point;
    std::vector<std::uint8_t> done(list.size(), 0);
    run_blocks(points, starts,
               [&](std::size_t k, FieldSampler& sampler) { done[k] = work(list[k], sampler); });
    std::vector<Index> left;
    for (std::size_t k = 0; k < list.size(); ++k)
      if (!done[k]) left.push_back(list[k]);
    parallel_sort(left, [&](Index a, Index b) { return by_rank_[a] < by_rank_[b]; });
    return left;
  }

  /// `work(k, sampler)` for each place k in `points`, block after block as far as they touch.
  template <class Work>
  void run_blocks(std::span<const Index> points, std::span<const std::size_t> starts, Work&& work) {
    rounds_.run(
        points, starts,
        [&](std::span<const Index> blocks) {
          const std::unique_ptr<FieldSampler> owned = field_.sampler();
          FieldSampler& sampler = *owned;
          for (Index b : blocks)
            for (std::size_t k = starts[b]; k < starts[b + 1]; ++k) work(k, sampler);
        },
        [&](std::size_t done) {
          if (!progress_) return;
          progress_->throw_if_cancelled();
          progress_->update(static_cast<double>(done) / static_cast<double>(starts.size()));
        });
  }

  /// What there is to know about a point with a cut too near to it; nothing for others.
  std::optional<Candidate> as_candidate(Index p, FieldSampler& sampler) const {
    const RegionIndex own = lattice_.first_region[p];
    if (field_.is_certain(lattice_.positions[p])) return std::nullopt;
    const std::optional<RegionSet> regions = pure_regions(lattice_, p);
    if (!regions) return std::nullopt;
    double nearest = 0;
    Index other = no_index;
    bool too_near = false;
    for (Index t : star(p))
      for (Index q : lattice_.tets[t]) {
        const RegionIndex r = lattice_.first_region[q];
        if (r == own) continue;
        const double share = lattice_.cut_share(p, own, q, r);
        too_near |= share <= (lattice_.is_centre[p] == lattice_.is_centre[q] ? near_long : near_short);
        const double length = share * (lattice_.positions[q] - lattice_.positions[p]).norm();
        if (other == no_index || length < nearest || (length == nearest && q < other)) {
          nearest = length;
          other = q;
        }
      }
    if (!too_near) return std::nullopt;
    const Vec3 &from = lattice_.positions[p], &to = lattice_.positions[other];
    Candidate c;
    c.point = p;
    c.other = other;
    c.at_junction = regions->size() > 2;
    c.edge = (to - from).cast<float>();
    c.projected = from;
    // Past a ridge of the distance the gradient leads anywhere.
    if (!sampler.project(*regions, c.projected) || (c.projected - from).norm() > c.room())
      c.projected = on_edge(c);
    const double distance = c.at_junction ? (c.projected - from).norm() : lattice_.margin(p);
    c.rank = static_cast<std::uint8_t>(std::clamp(distance / c.room(), 0.0, 1.0) * distance_steps);
    return c;
  }

  /// The nearest cut, as long as the point has not been moved.
  Vec3 on_edge(const Candidate& c) const {
    const double share = lattice_.cut_share(c.point, lattice_.first_region[c.point], c.other, beyond_edge(c));
    return lattice_.positions[c.point] + c.edge.cast<double>() * share;
  }
  /// The region on the other side of that cut.
  RegionIndex beyond_edge(const Candidate& c) const { return lattice_.first_region[c.other]; }

  void find_candidates() {
    const std::vector<Index>& near = lattice_.stars.points();
    candidates_ = parallel_collect<Candidate>(
        0, near.size(), 1 << 13, [&](std::size_t begin, std::size_t end, std::vector<Candidate>& out) {
          const std::unique_ptr<FieldSampler> owned = field_.sampler();
          FieldSampler& sampler = *owned;
          for (std::size_t i = begin; i < end; ++i)
            if (const std::optional<Candidate> c = as_candidate(near[i], sampler)) out.push_back(*c);
        });
    by_rank_.resize(candidates_.size());
    std::iota(by_rank_.begin(), by_rank_.end(), Index{0});
    parallel_sort(by_rank_, [&](Index a, Index b) {
      return std::pair(candidates_[a].group(), a) < std::pair(candidates_[b].group(), b);
    });
  }

  /// True if all tets around the point keep good angles with the point at `place`.
  bool star_holds(Index p, const Vec3& place) const {
    for (Index t : star(p)) {
      std::array<const Vec3*, 4> x;
      for (std::size_t k = 0; k < 4; ++k) {
        const Index v = lattice_.tets[t][k];
        x[k] = v == p ? &place : &lattice_.positions[v];
      }
      if (!(min_solid_angle_tangent(*x[0], *x[1], *x[2], *x[3]) >= smallest_tangent)) return false;
    }
    return true;
  }

  bool move(const Candidate& c) {
    const Vec3 cut = on_edge(c);
    const bool projected = star_holds(c.point, c.projected);
    if (!projected && !star_holds(c.point, cut)) return false;
    const std::optional<RegionSet> regions = regions_if_moved(lattice_, c.point);
    if (!regions) return false;
    // The cut of an edge is on one sheet, not on a curve.
    const bool sheet = regions->size() == 2 && regions->contains(beyond_edge(c));
    if (projected && (c.projected != cut || sheet)) return put(c.point, c.projected);
    return sheet && star_holds(c.point, cut) && put(c.point, cut);
  }

  bool put(Index p, const Vec3& place) {
    lattice_.positions[p] = place;
    lattice_.is_on[p] = 1;
    return true;
  }

  /// The mean of the corners of a star's tets, the point itself left out.
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

  /// Tries places of the interface nearer to the middle of the star, where its tets are less thin.
  bool slide(const Candidate& c, FieldSampler& sampler) {
    const Index p = c.point;
    const std::optional<RegionSet> regions = regions_if_moved(lattice_, p);
    if (!regions) return false;
    const Vec3 middle = middle_of_star(p);
    for (double share : {0.0, 0.5, 1.0}) {
      Vec3 place = lattice_.positions[p] + share * (middle - lattice_.positions[p]);
      if (sampler.project(*regions, place) && (place - lattice_.positions[p]).norm() <= c.room() &&
          star_holds(p, place))
        return put(p, place);
    }
    return false;
  }

  double worst_piece(Index p) const {
    double worst = 1;
    for (Index t : star(p)) worst = std::min(worst, worst_piece_tangent(lattice_, lattice_.tets[t]));
    return worst;
  }

  /// Puts a point where the worst piece of its star is best, of where it is and some places. The point keeps
  /// its region, and the lattice its angles.
  bool take_best(Index p, std::span<const Vec3> places, FieldSampler& sampler) {
    const bool on = lattice_.is_on[p];
    const Vec3 from = lattice_.positions[p];
    Vec3 best_place = from;
    const std::span<float> values = lattice_.star_values(p);
    std::vector<float> best_values(values.begin(), values.end());
    double best = worst_piece(p);
    for (const Vec3& place : places) {
      if (!on) {
        const NearestRegion there = sampler.nearest(place);
        if (there.region != lattice_.first_region[p] || there.margin >= field_.band()) continue;
      }
      if (!star_holds(p, place)) continue;
      lattice_.positions[p] = place;
      if (!on) sampler.values(place, lattice_.star_regions(p), values.data());
      if (const double worst = worst_piece(p); worst > best) {
        best = worst;
        best_place = place;
        best_values.assign(values.begin(), values.end());
      }
    }
    lattice_.positions[p] = best_place;
    std::copy(best_values.begin(), best_values.end(), values.begin());
    return best_place != from;
  }

  /// A refused point makes thin pieces where it is; farther from the interface they are thicker.
  bool push_away(const Candidate& c, FieldSampler& sampler) {
    const Index p = c.point;
    Vec3 gradient;
    const double value =
        sampler.between(lattice_.first_region[p], beyond_edge(c), lattice_.positions[p], gradient);
    const double slope = gradient.norm();
    if (!(slope > 0)) return false;
    std::vector<Vec3> places;
    for (double share : {0.15, 0.25, 0.35, 0.5})
      if (const double step = share * c.room() - std::abs(value); step > 0)
        places.push_back(lattice_.positions[p] - gradient * (step / slope));
    return take_best(p, places, sampler);
  }

  /// Moves the points near interfaces of those tets that have a piece that is still poor, of `count` tets
  /// `tet(i)`: points on an interface slide along it, the others step about. Returns the tets that may be
  /// poor after that.
  template <class TetOf>
  std::vector<Index> mend_poor_stars(std::size_t count, TetOf&& tet) {
    std::vector<Index> points = parallel_collect<Index>(
        0, count, 1 << 12, [&](std::size_t begin, std::size_t end, std::vector<Index>& out) {
          const auto near = [&](Index v) { return lattice_.stars.lists(v); };
          for (std::size_t i = begin; i < end; ++i) {
            const Tet& t = lattice_.tets[tet(i)];
            if (std::none_of(t.begin(), t.end(), near) ||
                worst_piece_tangent(lattice_, t) >= smallest_tangent)
              continue;
            std::copy_if(t.begin(), t.end(), std::back_inserter(out), near);
          }
        });
    parallel_sort_unique(points);
    const std::vector<std::size_t> starts = scatter_blocks(points, one_group);
    run_blocks(points, starts, [&](std::size_t k, FieldSampler& sampler) { mend(points[k], sampler); });
    std::vector<Index> touched;
    for (Index p : points)
      for (Index t : star(p)) touched.push_back(t);
    parallel_sort_unique(touched);
    return touched;
  }

  void mend(Index p, FieldSampler& sampler) {
    if (!lattice_.is_on[p] && field_.is_certain(lattice_.positions[p])) return;
    std::vector<Vec3> places;
    const Vec3 from = lattice_.positions[p], to_middle = middle_of_star(p) - from;
    if (lattice_.is_on[p]) {
      const std::optional<RegionSet> regions = pure_regions(lattice_, p);
      if (!regions) return;
      for (double share : {0.25, 0.5, 1.0}) {
        Vec3 place = from + share * to_middle;
        if (sampler.project(*regions, place)) places.push_back(place);
      }
    } else if (const RegionIndex other = nearest_other(p); other != on_interface) {
      Vec3 gradient;
      const double value = sampler.between(lattice_.first_region[p], other, from, gradient);
      // Shares of the distance itself keep to the side without knowing how large the cells are.
      for (double share : {-0.4, -0.2, 0.3, 0.6})
        places.push_back(from + gradient * (share * value / std::max(1e-3, gradient.squaredNorm())));
      places.push_back(from + 0.5 * to_middle);
    }
    take_best(p, places, sampler);
  }

  /// The region of the star that is nearest after the point's own; on_interface if there is none.
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
  std::vector<Candidate> candidates_;  ///< in the order of their points
  std::vector<Index> by_rank_;         ///< places in candidates_, by group, then point
};

}  // namespace

MoveCounts move_points(LabelledLattice& lattice, const MaterialField& field, Progress* progress) {
  return Mover(lattice, field, progress).run();
}

}  // namespace tetwright
