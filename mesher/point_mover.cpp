#include "mesher/point_mover.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "common/parallel_sort.h"
#include "common/quality.h"
#include "mesher/arrangement.h"
#include "mesher/cutting.h"

namespace tetwright {

namespace {

/// A cut nearer than this share of the edge is too near. Measured on scans: with the classic 0.25 / 0.41 flat
/// patches snap from both sides and tets turn over.
constexpr double near_long = 0.35;
constexpr double near_short = 0.49;

/// No lattice tet may get a smaller solid angle (steradians) by a move: the dial for the smallest dihedral
/// angle (0.06 gives 6 degrees, 0.1 gives 11, 0.14 gives 13, but then more points are refused).
constexpr double smallest_angle = 0.1;

struct Candidate {
  float distance;  ///< from the interface, finest cells
  Index point;
  bool operator<(const Candidate& o) const {
    return distance != o.distance ? distance < o.distance : point < o.point;
  }
};

/// Where a candidate could go.
struct Target {
  Vec3 projected;   ///< the interface along the gradient
  Vec3 on_edge;     ///< the nearest cut
  double room = 0;  ///< length of the edge with the nearest cut
};

class Mover {
 public:
  Mover(LabelledLattice& lattice, const MaterialField& field)
      : lattice_(lattice), field_(field), stars_(lattice) {}

  MoveCounts run(Progress* progress) {
    find_candidates();
    MoveCounts counts;
    counts.candidates = candidates_.size();
    std::vector<std::size_t> refused;
    constexpr std::size_t report_every = 1 << 14;
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      if (progress && i % report_every == 0) {
        progress->throw_if_cancelled();
        progress->update(static_cast<double>(i) / static_cast<double>(candidates_.size()));
      }
      if (move(i))
        ++counts.moved;
      else
        refused.push_back(i);
    }
    // Neighbours that moved since may have made room.
    FieldSampler sampler(field_);
    std::vector<std::size_t> left;
    for (std::size_t i : refused) {
      if (move(i) || slide(i, sampler))
        ++counts.moved;
      else
        left.push_back(i);
    }
    for (std::size_t i : left) counts.pushed += push_away(i, sampler);
    // A second sweep still finds something, a third hardly.
    for (int sweep = 0; sweep < 2; ++sweep) {
      if (progress) progress->throw_if_cancelled();
      mend_poor_stars(sampler);
    }
    return counts;
  }

 private:
  /// The nearest cut among the edges of a point; false where none is too near.
  bool find_target(Index p, FieldSampler& sampler, Target& target) const {
    const double phi = lattice_.distances[p];
    double nearest = 0;
    Index other = no_index;
    bool too_near = false;
    for (const Index* t = stars_.begin(p); t != stars_.end(p); ++t)
      for (Index q : lattice_.tets[*t]) {
        if (lattice_.sides[q] == lattice_.sides[p]) continue;
        const double share = phi / (phi - lattice_.distances[q]);
        too_near |= share <= (lattice_.is_centre[p] == lattice_.is_centre[q] ? near_long : near_short);
        const double length = share * (lattice_.positions[q] - lattice_.positions[p]).norm();
        if (other == no_index || length < nearest || (length == nearest && q < other)) {
          nearest = length;
          other = q;
        }
      }
    if (!too_near) return false;
    const Vec3 &from = lattice_.positions[p], &to = lattice_.positions[other];
    target.room = (to - from).norm();
    target.on_edge = from + (to - from) * (phi / (phi - lattice_.distances[other]));
    target.projected = from;
    // Past a ridge of the distance the gradient leads anywhere.
    if (!sampler.project(target.projected) || (target.projected - from).norm() > target.room)
      target.projected = target.on_edge;
    return true;
  }

  void find_candidates() {
    const std::vector<Index>& near = lattice_.near_points;
    struct Found {
      Candidate candidate;
      Target target;
      bool operator<(const Found& o) const { return candidate < o.candidate; }
    };
    std::vector<Found> found = parallel_collect<Found>(
        0, near.size(), 1024, [&](std::size_t begin, std::size_t end, std::vector<Found>& out) {
          FieldSampler sampler(field_);
          Found f;
          for (std::size_t i = begin; i < end; ++i)
            if (find_target(near[i], sampler, f.target)) {
              f.candidate = {std::abs(lattice_.distances[near[i]]), near[i]};
              out.push_back(f);
            }
        });
    parallel_sort(found);
    candidates_.reserve(found.size());
    targets_.reserve(found.size());
    for (const Found& f : found) candidates_.push_back(f.candidate), targets_.push_back(f.target);
  }

  /// True if all tets around the point keep good angles with the point at `place`.
  bool star_holds(Index p, const Vec3& place) const {
    for (const Index* t = stars_.begin(p); t != stars_.end(p); ++t) {
      std::array<const Vec3*, 4> x;
      for (std::size_t k = 0; k < 4; ++k) {
        const Index v = lattice_.tets[*t][k];
        x[k] = v == p ? &place : &lattice_.positions[v];
      }
      if (!(min_solid_angle(*x[0], *x[1], *x[2], *x[3]) >= smallest_angle)) return false;
    }
    return true;
  }

  bool move(std::size_t i) {
    const Index p = candidates_[i].point;
    const Target& target = targets_[i];
    const Vec3* place = star_holds(p, target.projected) ? &target.projected
                        : star_holds(p, target.on_edge) ? &target.on_edge
                                                        : nullptr;
    return place && put(p, *place);
  }

  /// Onto the interface at `place`, if that keeps the arrangement.
  bool put(Index p, const Vec3& place) {
    if (!may_move_onto_interface(lattice_, stars_, p)) return false;
    lattice_.positions[p] = place;
    lattice_.sides[p] = Side::on;
    return true;
  }

  /// The mean of the corners of a star's tets, the point itself left out.
  Vec3 middle_of_star(Index p) const {
    Vec3 sum = Vec3::Zero();
    double count = 0;
    for (const Index* t = stars_.begin(p); t != stars_.end(p); ++t)
      for (Index q : lattice_.tets[*t])
        if (q != p) {
          sum += lattice_.positions[q];
          ++count;
        }
    return sum / count;
  }

  /// Tries places of the interface nearer to the middle of the star, where its tets are less thin.
  bool slide(std::size_t i, FieldSampler& sampler) {
    const Index p = candidates_[i].point;
    const Vec3 middle = middle_of_star(p);
    for (double share : {0.5, 1.0}) {
      Vec3 place = lattice_.positions[p] + share * (middle - lattice_.positions[p]);
      if (sampler.project(place) && (place - lattice_.positions[p]).norm() <= targets_[i].room &&
          star_holds(p, place))
        return put(p, place);
    }
    return false;
  }

  double worst_piece(Index p) const {
    double worst = 4;
    for (const Index* t = stars_.begin(p); t != stars_.end(p); ++t)
      worst = std::min(worst, worst_inside_angle(lattice_, lattice_.tets[*t]));
    return worst;
  }

  /// Puts a point where the worst piece of its star is best, of where it is and some places. The point keeps
  /// its side, and the lattice its angles.
  bool take_best(Index p, std::span<const Vec3> places, FieldSampler& sampler) {
    const bool on = lattice_.sides[p] == Side::on;
    Vec3 best_place = lattice_.positions[p];
    const Vec3 from = best_place;
    float best_distance = lattice_.distances[p];
    double best = worst_piece(p);
    for (const Vec3& place : places) {
      const double reached = on ? best_distance : sampler.at(place);
      if ((reached < 0) != (best_distance < 0) || beyond_band(reached) || !star_holds(p, place)) continue;
      lattice_.positions[p] = place;
      lattice_.distances[p] = static_cast<float>(reached);
      if (const double worst = worst_piece(p); worst > best) {
        best = worst;
        best_place = place;
        best_distance = lattice_.distances[p];
      }
    }
    lattice_.positions[p] = best_place;
    lattice_.distances[p] = best_distance;
    return best_place != from;
  }

  /// A refused point makes thin pieces where it is; farther from the interface they are thicker.
  bool push_away(std::size_t i, FieldSampler& sampler) {
    const Index p = candidates_[i].point;
    Vec3 gradient;
    const double value = sampler.at(lattice_.positions[p], gradient);
    const double slope = gradient.norm();
    if (!(slope > 0)) return false;
    std::vector<Vec3> places;
    for (double share : {0.15, 0.25, 0.35, 0.5})
      if (const double step = share * targets_[i].room - std::abs(value); step > 0)
        places.push_back(lattice_.positions[p] + gradient * ((value < 0 ? -step : step) / slope));
    return take_best(p, places, sampler);
  }

  /// Points of stars with a piece that is still poor: those on the interface slide along it, the others step
  /// about.
  void mend_poor_stars(FieldSampler& sampler) {
    const std::vector<Index> poor = parallel_collect<Index>(
        0, lattice_.tets.size(), 1 << 12, [&](std::size_t begin, std::size_t end, std::vector<Index>& out) {
          for (std::size_t i = begin; i < end; ++i)
            if (is_near(lattice_.tets[i]) && worst_inside_angle(lattice_, lattice_.tets[i]) < smallest_angle)
              out.push_back(static_cast<Index>(i));
        });
    std::vector<Index> points;
    for (Index t : poor)
      for (Index v : lattice_.tets[t])
        if (stars_.lists(v)) points.push_back(v);
    parallel_sort_unique(points);
    std::vector<Vec3> places;
    for (Index p : points) {
      const Vec3 from = lattice_.positions[p], to_middle = middle_of_star(p) - from;
      places.clear();
      if (lattice_.sides[p] == Side::on) {
        for (double share : {0.25, 0.5, 1.0}) {
          Vec3 place = from + share * to_middle;
          if (sampler.project(place)) places.push_back(place);
        }
      } else {
        Vec3 gradient;
        const double value = sampler.at(from, gradient);
        // Shares of the distance itself keep to the side without knowing how large the cells are.
        for (double share : {-0.4, -0.2, 0.3, 0.6})
          places.push_back(from + gradient * (share * value / std::max(1e-3, gradient.squaredNorm())));
        places.push_back(from + 0.5 * to_middle);
      }
      take_best(p, places, sampler);
    }
  }

  /// True for tets with a point at the interface: only these can be poor.
  bool is_near(const Tet& t) const {
    return stars_.lists(t[0]) || stars_.lists(t[1]) || stars_.lists(t[2]) || stars_.lists(t[3]);
  }

  LabelledLattice& lattice_;
  const MaterialField& field_;
  const StarMap stars_;
  std::vector<Candidate> candidates_;
  std::vector<Target> targets_;
};

}  // namespace

MoveCounts move_points(LabelledLattice& lattice, const MaterialField& field, Progress* progress) {
  return Mover(lattice, field).run(progress);
}

}  // namespace tetwright
