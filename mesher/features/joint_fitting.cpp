// SPDX-License-Identifier: Apache-2.0
#include "mesher/features/joint_fitting.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "common/geometry/predicates.h"
#include "mesher/features/untangling.h"
#include "mesher/tuning/cut_tuning.h"
#include "tetwright/mesh_quality.h"

namespace tetwright {

namespace {

using Joint = CutTuning::JointFitting;
using Kind = FeatureLabel::Kind;

class JointMoves {
 public:
  JointMoves(TetMesh& mesh, const FeatureSurface& surface, const CreaseLabels& labels, double cell)
      : mesh_(mesh), surface_(surface), labels_(labels), cell_(cell) {}

  void run(const std::vector<PointMove>& waiting) {
    for (const PointMove& m : waiting) {
      // Faces beyond the borders of sheets are dropped.
      const FeatureLabel& label = labels_.of(m.point);
      if (label.kind == Kind::patch && surface_.is_continued(*label.patches.begin())) continue;
      targets_[m.point] = m.from + m.step;
    }
    gather();
    std::set<Index> done;
    for (const auto& [p, target] : targets_) {
      if (done.contains(p)) continue;
      const std::set<Index> group = group_of(p);
      done.insert(group.begin(), group.end());
      if (group.size() <= Joint::max_group) fit(group);
    }
  }

 private:
  /// Lists the tets at all points that are at most `rings` edges away from a waiting one.
  void gather() {
    std::vector<std::uint8_t> is_listed(mesh_.points.size(), 0);
    for (const auto& [p, target] : targets_) is_listed[p] = 1;
    const auto touches = [&](const Tet& t) {
      return std::any_of(t.begin(), t.end(), [&](Index p) { return is_listed[p] != 0; });
    };
    for (int ring = 0; ring < Joint::rings; ++ring) {
      std::vector<Index> next;
      for (const Tet& t : mesh_.tets)
        if (touches(t)) next.insert(next.end(), t.begin(), t.end());
      for (const Index p : next) is_listed[p] = 1;
    }
    for (Index t = 0; t < mesh_.tets.size(); ++t)
      for (const Index p : mesh_.tets[t])
        if (is_listed[p]) at_[p].push_back(t);
  }

  std::set<Index> with_neighbours(const std::set<Index>& points) const {
    std::set<Index> more = points;
    for (const Index p : points)
      for (const Index t : at_.at(p)) more.insert(mesh_.tets[t].begin(), mesh_.tets[t].end());
    return more;
  }

  /// The waiting points that a chain of tets with two of them joins to one.
  std::set<Index> group_of(Index p) const {
    std::set<Index> group{p};
    std::vector<Index> stack{p};
    while (!stack.empty()) {
      const Index q = stack.back();
      stack.pop_back();
      for (const Index t : at_.at(q))
        for (const Index r : mesh_.tets[t])
          if (targets_.contains(r) && group.insert(r).second) stack.push_back(r);
    }
    return group;
  }

  /// The directions in which a point may give way.
  PointFreedom freedom_of(Index p) const {
    if (!labels_.on_boundary(p) || labels_.is_loose(p)) return {};
    const FeatureLabel& label = labels_.of(p);
    const Vec3& at = mesh_.points[p];
    PointFreedom own{0};
    if (surface_.border_planes(at) != 0) return own;
    if (label.kind == Kind::patch) {
      const auto place =
          surface_.nearest_of_patch(at, *label.patches.begin(), CutTuning::Fitting::target_reach * cell_);
      if (!place || place->normal.isZero()) return own;
      own.dimensions = 2;
      own.directions[0] = place->normal.unitOrthogonal();
      own.directions[1] = place->normal.cross(own.directions[0]);
    } else if (label.kind == Kind::crease) {
      Vec3 along = Vec3::Zero();
      for (int axis = 0; axis < 3; ++axis) {
        const Vec3 step = Joint::tangent_step * cell_ * Vec3::Unit(axis);
        const auto from = feature_target(surface_, label, at - step, cell_),
                   to = feature_target(surface_, label, at + step, cell_);
        if (from && to && (*to - *from).squaredNorm() > along.squaredNorm()) along = *to - *from;
      }
      if (along.isZero()) return own;
      own = {1, {along.normalized()}};
    }
    return own;
  }

  /// The smallest solid angle of tets; 0 if one is not positive.
  double worst_angle(const std::set<Index>& tets) const {
    double worst = HUGE_VAL;
    for (const Index t : tets) {
      const Tet& ids = mesh_.tets[t];
      const Vec3 &a = mesh_.points[ids[0]], &b = mesh_.points[ids[1]], &c = mesh_.points[ids[2]],
                 &d = mesh_.points[ids[3]];
      worst = std::min(worst, orient3d(a, b, c, d) > 0 ? min_solid_angle(a, b, c, d) : 0.0);
    }
    return worst;
  }

  void fit(const std::set<Index>& group) {
    std::set<Index> moving = group;
    for (int ring = 0; ring < Joint::rings; ++ring) moving = with_neighbours(moving);
    std::set<Index> patch;
    for (const Index p : moving) patch.insert(at_.at(p).begin(), at_.at(p).end());
    const Vec3 origin = mesh_.points[*group.begin()];
    std::map<Index, Index> local;
    std::vector<Vec3> points;
    std::vector<PointFreedom> freedom;
    const auto number = [&](Index p) {
      const auto [known, is_new] = local.try_emplace(p, static_cast<Index>(points.size()));
      if (is_new) {
        const auto target = targets_.find(p);
        const bool is_waiting = group.contains(p);
        points.push_back(((is_waiting ? target->second : mesh_.points[p]) - origin) / cell_);
        // Others that wait elsewhere stay.
        const bool is_free = moving.contains(p) && (is_waiting || target == targets_.end());
        freedom.push_back(is_free ? freedom_of(p) : PointFreedom{0});
      }
      return known->second;
    };
    std::vector<Tet> tets;
    for (const Index t : patch) {
      Tet ids;
      std::transform(mesh_.tets[t].begin(), mesh_.tets[t].end(), ids.begin(), number);
      tets.push_back(ids);
    }
    if (!untangle(points, tets, freedom)) return;
    std::map<Index, Vec3> before;
    const auto planes_of = [&](Index p) { return surface_.border_planes(mesh_.points[p]); };
    const double min_angle = std::min(Joint::min_solid_angle, worst_angle(patch));
    bool valid = true;
    for (const auto& [p, k] : local) {
      if (freedom[k].dimensions == 0 && !group.contains(p)) continue;
      Vec3 position = origin + cell_ * points[k];
      if (labels_.on_boundary(p) && !labels_.is_loose(p)) {
        const auto target = feature_target(surface_, labels_.of(p), position, cell_, planes_of(p));
        valid &= target.has_value();
        position = target.value_or(position);
      }
      before[p] = mesh_.points[p];
      mesh_.points[p] = position;
    }
    const double worst = worst_angle(patch);
    valid &= worst > 0 && worst >= min_angle;
    if (!valid)
      for (const auto& [p, position] : before) mesh_.points[p] = position;
  }

  TetMesh& mesh_;
  const FeatureSurface& surface_;
  const CreaseLabels& labels_;
  double cell_;
  std::map<Index, Vec3> targets_;           ///< of waiting points
  std::map<Index, std::vector<Index>> at_;  ///< tets at points near them
};

/// feature_target() of a point that is in no plane.
std::optional<Vec3> free_target(const FeatureSurface& surface, const FeatureLabel& label, const Vec3& at,
                                double cell) {
  const double reach = CutTuning::Fitting::target_reach * cell;
  switch (label.kind) {
    case Kind::none:
      return {};
    case Kind::patch:
      if (const auto place = surface.nearest_of_patch(at, *label.patches.begin(), reach)) return place->point;
      return {};
    case Kind::crease:
      return surface.onto_crease_between(at, label.crease, reach);
    case Kind::corner:
      return surface.corners()[label.corner].point;
  }
  return {};
}

}  // namespace

std::optional<Vec3> feature_target(const FeatureSurface& surface, const FeatureLabel& label, const Vec3& at,
                                   double cell, unsigned planes) {
  if (planes == 0) return free_target(surface, label, at, cell);
  // In turn onto both, until nothing moves.
  using Fitting = CutTuning::Fitting;
  Vec3 place = surface.onto_border(at, planes);
  for (int step = 0; step < Fitting::border_steps; ++step) {
    const std::optional<Vec3> target = free_target(surface, label, place, cell);
    if (!target) return {};
    const Vec3 next = surface.onto_border(*target, planes);
    if ((next - place).norm() > Fitting::border_arrived * cell) {
      place = next;
      continue;
    }
    if ((*target - place).norm() > Fitting::border_slack * cell) return {};
    return place;
  }
  return {};
}

void move_jointly(TetMesh& mesh, const FeatureSurface& surface, const CreaseLabels& labels,
                  const std::vector<PointMove>& waiting, double cell) {
  if (!waiting.empty()) JointMoves(mesh, surface, labels, cell).run(waiting);
}

}  // namespace tetwright
