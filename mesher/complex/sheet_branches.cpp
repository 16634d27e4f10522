// SPDX-License-Identifier: Apache-2.0
#include "mesher/complex/sheet_branches.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "common/features/edge_uses.h"
#include "mesher/tuning/complex_tuning.h"

namespace tetwright {

namespace {

/// A number from 0 to 4 that ascends with the angle of a vector, without trigonometric functions.
double turn_of(double x, double y) {
  const double size = std::abs(x) + std::abs(y);
  if (!(size > 0)) return 0;
  return y >= 0 ? 1 - x / size : 3 + x / size;
}

/// Distance between two such numbers.
double turn_between(double a, double b) {
  const double d = std::abs(a - b);
  return std::min(d, 4 - d);
}

Vec3 closest_on(const std::array<Vec3, 2>& ends, const Vec3& p) {
  const Vec3 along = ends[1] - ends[0];
  return ends[0] + std::clamp((p - ends[0]).dot(along) / along.squaredNorm(), 0.0, 1.0) * along;
}

}  // namespace

SheetBranches::SheetBranches(const LabelledComplex& complex, const GridFrame& voxels) {
  std::vector<Triangle> triangles;
  for (const LabelledComplex::SheetFace& f : complex.sheets) triangles.push_back(f.ids);
  const std::vector<EdgeUse> uses = edge_uses(triangles, {});
  std::map<std::vector<std::uint32_t>, std::uint32_t> curves;  // by the components that meet
  std::vector<Edge> edges;
  std::vector<std::array<Index, 2>> points;  // of the edges
  for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
    std::vector<std::uint32_t> components;
    for (; j < uses.size() && uses[j].key == uses[i].key; ++j)
      components.push_back(complex.sheets[uses[j].triangle].component);
    std::sort(components.begin(), components.end());
    if (components.front() == components.back()) continue;
    const std::array<Index, 2> ends = ends_of(uses[i].key);
    Edge edge{{voxels.to_grid(complex.points[ends[0]]), voxels.to_grid(complex.points[ends[1]])},
              {},
              {},
              {},
              0,
              {}};
    const Vec3 along = (edge.ends[1] - edge.ends[0]).normalized();
    bool has_angles = along.squaredNorm() > 0;
    for (std::size_t k = i; k < j; ++k) {
      const Triangle& ids = triangles[uses[k].triangle];
      const Index apex =
          *std::find_if(ids.begin(), ids.end(), [&](Index p) { return p != ends[0] && p != ends[1]; });
      Vec3 inwards = voxels.to_grid(complex.points[apex]) - edge.ends[0];
      inwards -= inwards.dot(along) * along;
      has_angles &= inwards.squaredNorm() > 0;
      if (k == i) {
        edge.u = inwards.normalized();
        edge.v = along.cross(edge.u);
      }
      // A triangle that traverses the edge upwards has its normal along x inwards, where angles are larger.
      edge.halves.push_back({complex.sheets[uses[k].triangle].component,
                             turn_of(inwards.dot(edge.u), inwards.dot(edge.v)), uses[k].ascending});
    }
    if (!has_angles) continue;
    std::stable_sort(edge.halves.begin(), edge.halves.end(),
                     [](const Half& a, const Half& b) { return a.angle < b.angle; });
    edge.curve =
        curves.try_emplace(std::move(components), static_cast<std::uint32_t>(curves.size())).first->second;
    edges.push_back(std::move(edge));
    points.push_back(ends);
  }
  std::map<std::pair<std::uint32_t, Index>, int> at_points;
  for (std::size_t e = 0; e < edges.size(); ++e)
    for (const Index p : points[e]) ++at_points[{edges[e].curve, p}];
  for (std::size_t e = 0; e < edges.size(); ++e)
    for (std::size_t k = 0; k < 2; ++k) edges[e].is_last[k] = at_points[{edges[e].curve, points[e][k]}] == 1;
  std::vector<Box3> boxes;
  std::vector<Vec3> middles;
  for (const Edge& e : edges) {
    boxes.emplace_back();
    for (const Vec3& p : e.ends) boxes.back().add(p);
    middles.push_back(e.ends[0] + e.ends[1]);
  }
  const std::vector<Index> order = median_order(boxes, middles, ComplexTuning::Zone::leaf_size);
  tree_ =
      BoxTree(order.size(), ComplexTuning::Zone::leaf_size, [&](std::size_t i) { return boxes[order[i]]; });
  for (const Index i : order) edges_.push_back(std::move(edges[i]));
}

std::vector<std::size_t> SheetBranches::sectors(const Edge& edge, const SideOf& side) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < edge.halves.size(); ++i) {
    const Half &low = edge.halves[i], &high = edge.halves[(i + 1) % edge.halves.size()];
    const std::optional<bool> at_low = side(low.component), at_high = side(high.component);
    if ((!at_low || *at_low == low.front_follows) && (!at_high || *at_high != high.front_follows))
      found.push_back(i);
  }
  return found;
}

bool SheetBranches::face_across(const Vec3& point, double reach, const SideOf& a, const SideOf& b) const {
  std::optional<std::size_t> nearest;
  tree_.nearest(point, reach * reach, tree_.all(), [&](std::size_t i, double limit) {
    const double squared = (point - closest_on(edges_[i].ends, point)).squaredNorm();
    if (squared > limit || (squared == limit && nearest && *nearest < i)) return limit;
    nearest = i;
    return squared;
  });
  if (!nearest) return false;
  const Edge& edge = edges_[*nearest];
  const Vec3 along = (edge.ends[1] - edge.ends[0]).normalized();
  for (std::size_t k = 0; k < 2; ++k)
    if (edge.is_last[k] &&
        (point - edge.ends[k]).dot(k == 0 ? Vec3(-along) : along) > ComplexTuning::Sheets::beyond_curve)
      return false;
  // Sectors are certain if the sides of both their sheets are known.
  const auto known = [&](const SideOf& side) {
    std::vector<std::size_t> all = sectors(edge, side);
    std::erase_if(all, [&](std::size_t i) {
      return !side(edge.halves[i].component) || !side(edge.halves[(i + 1) % edge.halves.size()].component);
    });
    return all;
  };
  const std::vector<std::size_t> of_a = known(a), of_b = known(b);
  if (of_a.empty() || of_b.empty()) return false;
  const std::size_t count = edge.halves.size();
  for (const std::size_t i : of_a)
    for (const std::size_t j : of_b)
      if (const std::size_t steps = (i + count - j) % count; steps <= 1 || steps == count - 1) return false;
  return true;
}

void SheetBranches::hide(const Vec3& point, double reach, std::vector<NearSheet>& near) const {
  if (near.size() < 2 || edges_.empty()) return;
  struct Found {
    std::size_t edge;
    double squared;
  };
  std::map<std::uint32_t, Found> nearest;  // by curve
  tree_.nearest(point, reach * reach, tree_.all(), [&](std::size_t i, double limit) {
    const double squared = (point - closest_on(edges_[i].ends, point)).squaredNorm();
    if (squared > limit) return limit;
    const auto [known, added] = nearest.try_emplace(edges_[i].curve, Found{i, squared});
    if (!added &&
        (squared < known->second.squared || (squared == known->second.squared && i < known->second.edge)))
      known->second = {i, squared};
    return limit;
  });
  const auto find = [&](std::uint32_t component) -> NearSheet* {
    const auto at = std::lower_bound(near.begin(), near.end(), component,
                                     [](const NearSheet& n, std::uint32_t c) { return n.component < c; });
    return at != near.end() && at->component == component ? &*at : nullptr;
  };
  for (const auto& [curve, found] : nearest) {
    const Edge& edge = edges_[found.edge];
    const Vec3 from = point - edge.ends[0];
    const double own = turn_of(from.dot(edge.u), from.dot(edge.v));
    // The sector whose sheets have the point on the sides on which it is; if sheets bend, that need not be
    // the one at the point's own angle.
    std::optional<std::size_t> sector;
    double best = HUGE_VAL;
    const auto side = [&](std::uint32_t component) -> std::optional<bool> {
      const NearSheet* at = find(component);
      return at ? std::optional(at->in_front()) : std::nullopt;
    };
    for (const std::size_t i : sectors(edge, side)) {
      const Half &low = edge.halves[i], &high = edge.halves[(i + 1) % edge.halves.size()];
      const bool wraps = i + 1 == edge.halves.size();
      const double end = wraps ? high.angle + 4 : high.angle;
      const bool inside = (own >= low.angle && own <= end) || (own + 4 >= low.angle && own + 4 <= end);
      const double off = inside ? 0 : std::min(turn_between(own, low.angle), turn_between(own, high.angle));
      if (off < best) best = off, sector = i;
    }
    if (!sector) continue;
    const std::uint32_t low = edge.halves[*sector].component,
                        high = edge.halves[(*sector + 1) % edge.halves.size()].component;
    for (const Half& half : edge.halves)
      if (half.component != low && half.component != high)
        if (NearSheet* hidden = find(half.component)) hidden->visible = false;
  }
}

}  // namespace tetwright
