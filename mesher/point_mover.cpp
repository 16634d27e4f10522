#include "mesher/point_mover.h"

#include <algorithm>
#include <cmath>

#include "common/quality.h"
#include "mesher/arrangement.h"
#include "mesher/parallel_sort.h"

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
    std::vector<std::size_t> left;
    for (std::size_t i : refused) {
      if (move(i))
        ++counts.moved;
      else
        left.push_back(i);
    }
    FieldSampler sampler(field_);
    for (std::size_t i : left) counts.pushed += push_away(i, sampler);
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
    if (!place || !may_move_onto_interface(lattice_, stars_, p)) return false;
    lattice_.positions[p] = *place;
    lattice_.sides[p] = Side::on;
    return true;
  }

  /// A refused point makes thin tets where it is; farther from the interface they are thicker.
  bool push_away(std::size_t i, FieldSampler& sampler) {
    const Index p = candidates_[i].point;
    const Vec3 from = lattice_.positions[p];
    Vec3 gradient;
    const double value = sampler.at(from, gradient);
    const double slope = gradient.norm();
    if (!(slope > 0)) return false;
    // As far as a cut must be, or half as far.
    for (double share : {near_long, near_long / 2}) {
      const double wanted = share * targets_[i].room;
      if (wanted <= std::abs(value)) continue;
      const Vec3 place = from + gradient * ((value < 0 ? value + wanted : wanted - value) *
                                            (value < 0 ? -1 : 1) / (slope * slope) * slope);
      const double reached = sampler.at(place);
      if ((reached < 0) != (lattice_.distances[p] < 0) || std::abs(reached) <= std::abs(value) ||
          beyond_band(reached))
        continue;
      if (!star_holds(p, place)) continue;
      lattice_.positions[p] = place;
      lattice_.distances[p] = static_cast<float>(reached);
      return true;
    }
    return false;
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
