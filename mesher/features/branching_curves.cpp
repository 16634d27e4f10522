// SPDX-License-Identifier: Apache-2.0
#include "mesher/features/branching_curves.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <utility>

namespace tetwright {

BranchingCurves::BranchingCurves(const LabelledComplex& complex, std::span<const std::array<Index, 2>> edges,
                                 const std::vector<std::uint8_t>& ends)
    : points_(complex.points), regions_(complex.points.size()), vertex_of_(complex.points.size(), no_index) {
  std::vector<std::uint8_t> is_on(points_.size(), 0);
  for (const auto& [a, b] : edges) is_on[a] = is_on[b] = 1;
  for (const LabelledComplex::Face& f : complex.faces)
    for (const Index p : f.ids)
      if (is_on[p]) regions_[p].insert(regions_[p].end(), {f.behind, f.front});
  for (const LabelledComplex::SheetFace& f : complex.sheets)
    for (const Index p : f.ids)
      if (is_on[p]) regions_[p].push_back(f.region);
  for (std::vector<RegionIndex>& r : regions_) {
    std::sort(r.begin(), r.end());
    r.erase(std::unique(r.begin(), r.end()), r.end());
  }
  trace(edges, ends);
  std::vector<ProjectionTree::Item> items;
  for (Index c = 0; c < curves_.size(); ++c)
    for (std::uint32_t k = 0; k + 1 < curves_[c].points.size(); ++k) {
      const Index a = curves_[c].points[k], b = curves_[c].points[k + 1];
      items.push_back({{a, b, b}, {c, k, 0}});
    }
  tree_ = ProjectionTree(points_, std::move(items));
}

void BranchingCurves::trace(std::span<const std::array<Index, 2>> edges,
                            const std::vector<std::uint8_t>& ends) {
  std::map<Index, std::vector<Index>> beside;
  for (const auto& [a, b] : edges) {
    beside[a].push_back(b);
    beside[b].push_back(a);
  }
  branches_.assign(points_.size(), 0);
  for (const auto& [p, all] : beside) branches_[p] = all.size() > 2;
  std::set<std::array<Index, 2>> done;
  const auto follow = [&](Index from, Index to) {
    if (!done.insert(ascending_edge(from, to)).second) return;
    Curve curve;
    curve.points = {from, to};
    const auto is_end = [&](Index p) { return ends[p] || beside.at(p).size() != 2 || p == from; };
    while (!is_end(curve.points.back())) {
      const std::vector<Index>& both = beside.at(curve.points.back());
      const Index next = both[0] == curve.points[curve.points.size() - 2] ? both[1] : both[0];
      done.insert(ascending_edge(curve.points.back(), next));
      curve.points.push_back(next);
    }
    curve.along.push_back(0);
    for (std::size_t k = 0; k + 1 < curve.points.size(); ++k)
      curve.along.push_back(curve.along.back() +
                            (points_[curve.points[k + 1]] - points_[curve.points[k]]).norm());
    curves_.push_back(std::move(curve));
  };
  for (const auto& [p, all] : beside)
    if (ends[p] || all.size() != 2)
      for (const Index q : all) follow(p, q);
  // Closed curves are left.
  for (const auto& [a, b] : edges) follow(a, b);
}

std::optional<BranchingCurves::Location> BranchingCurves::locate(const Vec3& p, double reach) const {
  const auto hit = tree_.nearest_of(p, reach, [](const ProjectionTree::Item&) { return true; });
  if (!hit) return {};
  const ProjectionTree::Item& item = tree_.items()[hit->item];
  return Location{item.kind[0],
                  curves_[item.kind[0]].along[item.kind[1]] + (hit->point - tree_.corner(item, 0)).norm(),
                  (hit->point - p).norm()};
}

std::array<bool, 2> BranchingCurves::branches(Index curve) const {
  return {branches_[curves_[curve].points.front()] != 0, branches_[curves_[curve].points.back()] != 0};
}

Vec3 BranchingCurves::position(const Curve& curve, double along) const {
  const auto after = std::upper_bound(curve.along.begin() + 1, curve.along.end() - 1, along);
  const auto k = static_cast<std::size_t>(after - curve.along.begin()) - 1;
  const Vec3 &a = points_[curve.points[k]], &b = points_[curve.points[k + 1]];
  const double length = curve.along[k + 1] - curve.along[k];
  return length > 0 ? Vec3(a + (along - curve.along[k]) / length * (b - a)) : a;
}

Index BranchingCurves::vertex_at(Index point) {
  Index& vertex = vertex_of_[point];
  if (vertex == no_index) {
    vertex = static_cast<Index>(vertices_.size());
    vertices_.push_back({points_[point], regions_[point], {}});
  }
  return vertex;
}

void BranchingCurves::divide(const std::function<double(Index curve, double along)>& spacing, double step) {
  vertices_.clear();
  std::fill(vertex_of_.begin(), vertex_of_.end(), no_index);
  std::set<std::pair<Index, Index>> pairs;  // of ends
  for (Index c = 0; c < curves_.size(); ++c) {
    Curve& curve = curves_[c];
    const double length = curve.along.back();
    const auto steps = std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(length / step)));
    // The number of vertices up to each step.
    std::vector<double> count{0};
    for (std::size_t i = 0; i < steps; ++i) {
      const double width = length / static_cast<double>(steps);
      count.push_back(count.back() + width / spacing(c, (static_cast<double>(i) + 0.5) * width));
    }
    const bool is_closed = curve.points.front() == curve.points.back();
    // No two vertices may have two edges in common: closed chains need three, and of chains with the same
    // ends all but one two.
    const bool has_twin = !pairs.insert(std::minmax(curve.points.front(), curve.points.back())).second;
    const std::size_t edges = std::max<std::size_t>(is_closed  ? 3
                                                    : has_twin ? 2
                                                               : 1,
                                                    static_cast<std::size_t>(std::floor(count.back())));
    curve.vertices = {vertex_at(curve.points.front())};
    curve.at = {0};
    const std::size_t middle_point = curve.points.size() / 2;
    for (std::size_t k = 1; k < edges; ++k) {
      const double wanted = count.back() * static_cast<double>(k) / static_cast<double>(edges);
      const auto i =
          static_cast<std::size_t>(std::upper_bound(count.begin(), count.end() - 1, wanted) - count.begin()) -
          1;
      const double width = count[i + 1] - count[i], share = width > 0 ? (wanted - count[i]) / width : 0;
      const double along = length * (static_cast<double>(i) + share) / static_cast<double>(steps);
      curve.vertices.push_back(static_cast<Index>(vertices_.size()));
      curve.at.push_back(along);
      // All inner points of a curve have the same regions; a curve of one segment has those that its ends
      // share.
      std::vector<RegionIndex> regions = regions_[curve.points[middle_point]];
      if (curve.points.size() == 2) {
        regions.clear();
        const std::vector<RegionIndex>&a = regions_[curve.points[0]], &b = regions_[curve.points[1]];
        std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(regions));
      }
      vertices_.push_back({position(curve, along), std::move(regions), {}});
    }
    curve.vertices.push_back(vertex_at(curve.points.back()));
    curve.at.push_back(length);
    for (std::size_t k = 0; k + 1 < curve.vertices.size(); ++k) {
      const Index a = curve.vertices[k], b = curve.vertices[k + 1];
      vertices_[a].next.push_back(b);
      vertices_[b].next.push_back(a);
    }
  }
  for (Vertex& v : vertices_) {
    std::sort(v.next.begin(), v.next.end());
    v.next.erase(std::unique(v.next.begin(), v.next.end()), v.next.end());
  }
}

Index BranchingCurves::nearest_vertex(const Location& location) const {
  const Curve& curve = curves_[location.curve];
  const auto after = std::lower_bound(curve.at.begin(), curve.at.end(), location.along);
  if (after == curve.at.begin()) return curve.vertices.front();
  if (after == curve.at.end()) return curve.vertices.back();
  const auto k = static_cast<std::size_t>(after - curve.at.begin());
  return location.along - curve.at[k - 1] < curve.at[k] - location.along ? curve.vertices[k - 1]
                                                                         : curve.vertices[k];
}

}  // namespace tetwright
