// SPDX-License-Identifier: Apache-2.0
#include "simplify/remesh/field_carrier.h"

#include <algorithm>
#include <cmath>

#include "common/geometry/point_triangle.h"
#include "common/geometry/predicates.h"
#include "simplify/tuning/tuning.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

using Grains = SimplifyTuning::Grains;
using Transfer = SimplifyTuning::Transfer;

Box3 box_of(const TetCorners& corners) {
  Box3 box;
  for (const Vec3& p : corners) box.add(p);
  return box;
}

/// Kahan's compensated sum, which does not lose many small summands.
class Sum {
 public:
  void add(double x) {
    const double y = x - lost_, t = sum_ + y;
    lost_ = (t - sum_) - y;
    sum_ = t;
  }
  double value() const { return sum_; }

 private:
  double sum_ = 0, lost_ = 0;
};

}  // namespace

FieldCarrier::FieldCarrier(const EditableMesh& mesh, const ChangeJournal& journal)
    : mesh_(mesh), journal_(journal) {
  add_sources();
  add_targets();
  place_points();
}

void FieldCarrier::add_sources() {
  std::vector<Source> sources;
  std::vector<Box3> boxes;
  for (const ChangeJournal::OldTet& t : journal_.tets()) {
    if (t.points == dead_tet) continue;
    TetCorners corners;
    for (int k = 0; k < 4; ++k) corners[k] = journal_.point(t.points[k]).position;
    Tet points = t.points;
    if (orient3d_value(corners[0], corners[1], corners[2], corners[3]) < 0) {
      std::swap(corners[0], corners[1]);
      std::swap(points[0], points[1]);
    }
    boxes.push_back(box_of(corners));
    sources.push_back({PlanedTet(corners), points, t.slot, t.region});
  }
  const std::vector<Index> order = morton_order(boxes);
  sources_.reserve(sources.size());
  boxes_.reserve(sources.size());
  for (Index i : order) {
    sources_.push_back(sources[i]);
    boxes_.push_back(boxes[i]);
  }
  tree_ = BoxTree(sources_.size(), Transfer::leaf_tets, [&](std::size_t i) { return boxes_[i]; });
}

template <class Visit>
void FieldCarrier::for_sources_near(const Box3& box, const Visit& visit) const {
  const auto nodes = tree_.nodes();
  for (std::size_t k = 0; k < nodes.size();) {
    if (!nodes[k].box.intersects(box)) {
      k = nodes[k].next;
      continue;
    }
    if (tree_.is_leaf(nodes[k]))
      for (std::uint32_t i = nodes[k].begin; i < nodes[k].end; ++i)
        if (boxes_[i].intersects(box)) visit(i);
    ++k;
  }
}

void FieldCarrier::add_targets() {
  for (const ChangeJournal::OldTet& t : journal_.tets())
    if (!mesh_.dead(t.slot)) targets_.push_back({t.slot, mesh_.region(t.slot), 0, {}});
  parallel_for(0, targets_.size(), Grains::transferred_tets, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Target& target = targets_[i];
      TetCorners corners;
      for (int k = 0; k < 4; ++k) corners[k] = mesh_.position(mesh_.points(target.slot)[k]);
      if (orient3d_value(corners[0], corners[1], corners[2], corners[3]) < 0)
        std::swap(corners[0], corners[1]);
      const PlanedTet tet(corners);
      target.volume = tet.volume();
      for_sources_near(box_of(corners), [&](std::uint32_t s) {
        if (sources_[s].region != target.region) return;
        if (const double common = overlap_volume(tet, sources_[s].tet); common > 0)
          target.shares.push_back({s, common});
      });
    }
  });
}

bool FieldCarrier::weigh(const Source& s, const Vec3& p, std::array<double, 4>& weights) {
  const TetCorners& c = s.tet.corners();
  weights = {orient3d_value(p, c[1], c[2], c[3]), orient3d_value(c[0], p, c[2], c[3]),
             orient3d_value(c[0], c[1], p, c[3]), orient3d_value(c[0], c[1], c[2], p)};
  const bool inside = std::all_of(weights.begin(), weights.end(), [](double w) { return w >= 0; });
  double sum = 0;
  for (double& w : weights) sum += w = std::max(w, 0.0);
  if (!(sum > 0)) return false;  // flat
  for (double& w : weights) w /= sum;
  return inside;
}

FieldCarrier::Weights FieldCarrier::weights_at(const Vec3& p) const {
  Weights best{};
  const auto holds = [&](std::size_t i) {
    best.points = sources_[i].points;
    return weigh(sources_[i], p, best.weights);
  };
  if (tree_.any_containing(p, tree_.all(), holds)) return best;
  // The point is outside all old tets: use the nearest point on their faces.
  best = {};
  double nearest = std::numeric_limits<double>::infinity();
  tree_.nearest(p, nearest, tree_.all(), [&](std::size_t i, double limit) {
    const Source& s = sources_[i];
    const TetCorners& c = s.tet.corners();
    for (const auto& f : tet_faces) {
      const Vec3 q = closest_point(p, c[f[0]], c[f[1]], c[f[2]]);
      const double distance = (q - p).squaredNorm();
      std::array<double, 4> weights;
      if (distance >= nearest) continue;
      weigh(s, q, weights);
      if (!(weights[0] + weights[1] + weights[2] + weights[3] > 0)) continue;  // flat
      nearest = distance;
      best = {s.points, weights};
    }
    return std::min(limit, nearest);
  });
  return best;
}

void FieldCarrier::place_points() {
  if (sources_.empty()) return;
  for (const ChangeJournal::OldPoint& old : journal_.points()) {
    if (mesh_.incident_tet(old.point) == no_index) continue;
    const Vec3& now = mesh_.position(old.point);
    if (!old.existed || now != old.position) placed_.push_back({old.point, weights_at(now)});
  }
}

void FieldCarrier::carry_point_field(std::vector<double>& values, std::size_t components) const {
  std::vector<double> carried(placed_.size() * components, 0);
  for (std::size_t i = 0; i < placed_.size(); ++i)
    for (int k = 0; k < 4; ++k)
      // Skip corners without weight, whatever their value.
      if (const double w = placed_[i].from.weights[k]; w > 0)
        for (std::size_t c = 0; c < components; ++c)
          carried[i * components + c] += w * values[placed_[i].from.points[k] * components + c];
  for (const ChangeJournal::OldPoint& old : journal_.points())
    if (mesh_.incident_tet(old.point) == no_index)
      std::fill_n(values.begin() + static_cast<std::ptrdiff_t>(old.point * components), components, 0.0);
  for (std::size_t i = 0; i < placed_.size(); ++i)
    std::copy_n(carried.begin() + static_cast<std::ptrdiff_t>(i * components), components,
                values.begin() + static_cast<std::ptrdiff_t>(placed_[i].point * components));
}

void FieldCarrier::carry_tet_field(std::vector<double>& values, std::size_t components) const {
  std::vector<RegionId> regions;
  for (const Source& s : sources_) regions.push_back(s.region);
  std::sort(regions.begin(), regions.end());
  regions.erase(std::unique(regions.begin(), regions.end()), regions.end());
  std::vector<double> carried(targets_.size() * components, 0);
  for (std::size_t c = 0; c < components; ++c) {
    const auto old_value = [&](const Source& s) { return values[s.slot * components + c]; };
    const auto new_value = [&](std::size_t i) -> double& { return carried[i * components + c]; };
    for (RegionId region : regions) {
      Sum before, volume;
      for (const Source& s : sources_)
        if (s.region == region) before.add(old_value(s) * s.tet.volume());
      for (const Target& t : targets_)
        if (t.region == region) volume.add(t.volume);
      if (!(volume.value() > 0)) continue;
      Sum old_volume;
      for (const Source& s : sources_)
        if (s.region == region) old_volume.add(s.tet.volume());
      const double mean = old_volume.value() > 0 ? before.value() / old_volume.value() : 0;
      for (std::size_t i = 0; i < targets_.size(); ++i) {
        const Target& t = targets_[i];
        if (t.region != region) continue;
        double covered = 0, sum = 0;
        for (const auto& [s, common] : t.shares) {
          covered += common;
          sum += common * old_value(sources_[s]);
        }
        new_value(i) = covered > 0 ? sum / covered : mean;
      }
      for (int pass = 0; pass < Transfer::correction_passes; ++pass) {
        Sum missing;
        missing.add(before.value());
        for (std::size_t i = 0; i < targets_.size(); ++i)
          if (targets_[i].region == region) missing.add(-new_value(i) * targets_[i].volume);
        const double summand = missing.value() / volume.value();
        for (std::size_t i = 0; i < targets_.size(); ++i)
          if (targets_[i].region == region) new_value(i) += summand;
      }
    }
  }
  for (const ChangeJournal::OldTet& t : journal_.tets())
    if (mesh_.dead(t.slot))
      std::fill_n(values.begin() + static_cast<std::ptrdiff_t>(t.slot * components), components, 0.0);
  for (std::size_t i = 0; i < targets_.size(); ++i)
    std::copy_n(carried.begin() + static_cast<std::ptrdiff_t>(i * components), components,
                values.begin() + static_cast<std::ptrdiff_t>(targets_[i].slot * components));
}

}  // namespace tetwright
