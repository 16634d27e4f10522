// SPDX-License-Identifier: Apache-2.0
#include "mesher/complex/contact_zone.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <set>
#include <utility>
#include <vector>

#include "common/features/edge_uses.h"
#include "common/geometry/morton.h"
#include "common/geometry/point_triangle.h"
#include "common/geometry/triangle_distance.h"
#include "common/parallel/parallel_sort.h"
#include "common/tolerances.h"
#include "mesher/tuning/complex_tuning.h"

namespace tetwright {

namespace {

using Zone = ComplexTuning::Zone;

/// Number of a voxel within its leaf of 8 x 8 x 8.
std::size_t in_leaf(const std::array<int, 3>& v) {
  return static_cast<std::size_t>((v[0] & 7) << 6 | (v[1] & 7) << 3 | (v[2] & 7));
}

std::uint64_t leaf_of(const std::array<int, 3>& v) {
  return morton_encode({v[0] >> 3, v[1] >> 3, v[2] >> 3});
}

/// Calls `visit(key)` with the Morton key of each voxel that contains a point within `reach` of the triangle,
/// and of some next to these.
template <class Visit>
void for_voxels_near(const std::array<Vec3, 3>& triangle, const std::array<int, 3>& cells, double reach,
                     const Visit& visit) {
  Box3 box;
  for (const Vec3& p : triangle) box.add(p);
  std::array<int, 3> low, high;
  for (int a = 0; a < 3; ++a) {
    const auto k = static_cast<std::size_t>(a);
    low[k] = std::max(0, static_cast<int>(std::floor(box.low[a] - reach)));
    high[k] = std::min(cells[k], static_cast<int>(std::floor(box.high[a] + reach)));
  }
  const TriangleDistance distance(triangle[0], triangle[1], triangle[2]);
  const double limit = (reach + half_cube_diagonal) * (reach + half_cube_diagonal);
  for (int z = low[2]; z <= high[2]; ++z)
    for (int y = low[1]; y <= high[1]; ++y)
      for (int x = low[0]; x <= high[0]; ++x)
        if (distance.squared(Vec3(x + 0.5, y + 0.5, z + 0.5), limit) < limit) visit(morton_encode({x, y, z}));
}

/// The unit direction away from a surface at its nearest point.
ContactZone::Distance away_from(const Vec3& away, double length, const Vec3& normal) {
  if (length > tolerance::smallest_distance) return {length, away / length};
  return {tolerance::smallest_distance, normal};
}

/// The thickness below which the outside gives way at a distance from a line in which bodies touch.
double touching_thickness(double distance) {
  return Zone::touching_thickness * (1 - distance * distance / (Zone::reach * Zone::reach));
}

/// True for points of a complex at which a line in which bodies touch ends, and no contact goes on: none but
/// between bodies that have a common face at the line.
std::vector<std::uint8_t> ends_of_lines(const LabelledComplex& complex,
                                        const std::vector<TouchingEdge>& edges,
                                        const std::vector<std::vector<Index>>& edges_at) {
  std::vector<std::uint8_t> is_end(complex.points.size(), 0);
  for (Index p = 0; p < is_end.size(); ++p) is_end[p] = edges_at[p].size() == 1;
  for (Index f = 0; f < complex.faces.size(); ++f) {
    if (!complex.is_contact(f)) continue;
    const std::pair<RegionIndex, RegionIndex> pair =
        std::minmax(complex.faces[f].behind, complex.faces[f].front);
    for (const Index p : complex.faces[f].ids)
      if (is_end[p] &&
          !std::binary_search(edges[edges_at[p][0]].joined.begin(), edges[edges_at[p][0]].joined.end(), pair))
        is_end[p] = 0;
  }
  return is_end;
}

/// Sorts a list and removes what is repeated.
template <class Item>
void make_unique(std::vector<Item>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

/// Calls `visit(edge, point, distance)` with the edges that begin within `reach` of a point along lines, and
/// the nearer point of each with its distance.
template <class Visit>
void walk_along_lines(Index from, double reach, const std::vector<TouchingEdge>& edges,
                      const std::vector<std::vector<Index>>& edges_at, const std::vector<Vec3>& points,
                      const Visit& visit) {
  using Reached = std::pair<double, Index>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> waiting;
  std::set<Index> visited;
  waiting.emplace(0, from);
  while (!waiting.empty()) {
    const auto [distance, p] = waiting.top();
    waiting.pop();
    for (const Index e : edges_at[p]) {
      if (!visited.insert(e).second) continue;
      visit(e, p, distance);
      const auto& [a, b] = edges[e].ends;
      const double beyond = distance + (points[b] - points[a]).norm();
      if (beyond < reach) waiting.emplace(beyond, p == a ? b : a);
    }
  }
}

}  // namespace

std::vector<TouchingEdge> touching_edges(const LabelledComplex& complex) {
  std::vector<Triangle> triangles;
  for (const LabelledComplex::Face& f : complex.faces) triangles.push_back(f.ids);
  const std::vector<EdgeUse> uses = edge_uses(triangles, {});
  std::vector<TouchingEdge> edges;
  for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
    TouchingEdge edge{ends_of(uses[i].key), {}};
    std::size_t at_outside = 0;  // two faces for each sector
    for (; j < uses.size() && uses[j].key == uses[i].key; ++j) {
      const LabelledComplex::Face& f = complex.faces[uses[j].triangle];
      const auto& [low, high] = std::minmax(f.behind, f.front);
      edge.regions.push_back(high);
      if (low == outside_region)
        ++at_outside;
      else
        edge.joined.emplace_back(low, high), edge.regions.push_back(low);
    }
    if (at_outside <= 2) continue;
    make_unique(edge.regions);
    make_unique(edge.joined);
    if (edge.regions.size() > 1) edges.push_back(std::move(edge));
  }
  return edges;
}

ContactZone::ContactZone(const LabelledComplex& complex, const GridFrame& voxels) {
  std::vector<Vec3> points;
  points.reserve(complex.points.size());
  for (const Vec3& p : complex.points) points.push_back(voxels.to_grid(p));
  std::vector<Face> faces;
  std::vector<Box3> boxes;
  std::vector<Vec3> middles;
  for (const LabelledComplex::Face& f : complex.faces) {
    const Vec3 &a = points[f.ids[0]], &b = points[f.ids[1]], &c = points[f.ids[2]];
    const Vec3 normal = (b - a).cross(c - a);
    if (!(normal.norm() > 0)) continue;
    faces.push_back({{a, b, c}, normal.normalized(), f.behind, f.front});
    boxes.emplace_back();
    for (const Vec3& p : {a, b, c}) boxes.back().add(p);
    middles.push_back(a + b + c);
  }
  const std::vector<Index> order = median_order(boxes, middles, Zone::leaf_size);
  tree_ = BoxTree(order.size(), Zone::leaf_size, [&](std::size_t i) { return boxes[order[i]]; });
  faces_.reserve(order.size());
  for (const Index i : order) faces_.push_back(faces[i]);

  add_touching_edges(complex, points);
  add_junctions(complex, points, voxels.cells);
  add_narrow_parts(voxels.cells);
}

void ContactZone::add_touching_edges(const LabelledComplex& complex, const std::vector<Vec3>& points) {
  std::vector<TouchingEdge> edges = touching_edges(complex);
  if (edges.empty()) return;
  std::vector<std::vector<Index>> edges_at(points.size());
  for (Index e = 0; e < edges.size(); ++e)
    for (const Index p : edges[e].ends) edges_at[p].push_back(e);
  const std::vector<std::uint8_t> is_end = ends_of_lines(complex, edges, edges_at);
  near_ends_.resize(edges.size());
  for (Index p = 0; p < points.size(); ++p) {
    if (!is_end[p]) continue;
    const auto& [a, b] = edges[edges_at[p][0]].ends;
    walk_along_lines(p, Zone::reach, edges, edges_at, points, [&](Index e, Index from, double along) {
      near_ends_[e].push_back({static_cast<Index>(ends_.size()), points[from], along});
    });
    ends_.push_back({points[p], (points[p == a ? b : a] - points[p]).normalized()});
  }
  std::vector<ProjectionTree::Item> items;
  for (Index e = 0; e < edges.size(); ++e) {
    const auto& [a, b] = edges[e].ends;
    if (touching_regions_.empty() || touching_regions_.back() != edges[e].regions)
      touching_regions_.push_back(std::move(edges[e].regions));
    items.push_back({{a, b, b}, {static_cast<std::uint32_t>(touching_regions_.size() - 1), e, 0}});
  }
  touching_ = ProjectionTree(points, std::move(items));
}

std::optional<ContactZone::NearLine> ContactZone::near_line(const Vec3& point, RegionIndex first,
                                                            RegionIndex second) const {
  if (touching_.empty()) return {};
  const auto hit = touching_.nearest_of(point, Zone::reach, [&](const ProjectionTree::Item& item) {
    const std::vector<RegionIndex>& regions = touching_regions_[item.kind[0]];
    const auto touches = [&](RegionIndex region) {
      return region == outside_region || std::binary_search(regions.begin(), regions.end(), region);
    };
    return touches(first) && touches(second);
  });
  if (!hit) return {};
  NearLine line{point - hit->point, HUGE_VAL, Vec3::Zero()};
  for (const NearEnd& near : near_ends_[touching_.items()[hit->item].kind[1]]) {
    // Where the line turns, the plane across its end says nothing.
    const Vec3 from = hit->point - near.from;
    const double along = near.along + from.norm();
    if (along > Zone::reach) continue;
    const EndOfLine& end = ends_[near.end];
    const double across = (point - end.point).dot(end.inwards), beside = along - line.away.norm();
    const double from_end = std::max(across, beside);
    if (!(from_end < line.from_end)) continue;
    line.from_end = from_end;
    line.inwards = across >= beside ? end.inwards : Vec3(from.normalized() - line.away.normalized());
  }
  return line;
}

/// Makes the outside give way between two bodies that touch in a line, if it does not do so by more already.
/// It counts as thick as the chord of the wedge between them is long at the point's distance from the line,
/// and the line's ends bound it. In a wedge of up to a right angle between planes the rim is therefore a
/// circle around the line and meets the planes at right angles; in others it does so about. At sharp angles
/// the rim would be so thin that edges of the lattice pass through it.
void ContactZone::give_way(const NearLine& line, Narrow& narrow) {
  const double distance = line.away.norm();
  const double opening = std::sqrt(2 * std::max(0.0, 1 + narrow.cosine));
  const double lack = touching_thickness(distance) - opening * distance;
  const double deficit = Zone::slope * std::min(lack, line.from_end);
  if (!(deficit > narrow.deficit)) return;
  narrow.deficit = deficit;
  if (line.from_end < lack) {
    narrow.slope = Zone::slope * line.inwards;
    return;
  }
  constexpr double narrowing = 2 * Zone::touching_thickness / (Zone::reach * Zone::reach);
  narrow.slope = Vec3::Zero();
  if (distance > tolerance::smallest_distance)
    narrow.slope = -Zone::slope * (narrowing + opening / distance) * line.away;
}

void ContactZone::add_junctions(const LabelledComplex& complex, const std::vector<Vec3>& points,
                                const std::array<int, 3>& cells) {
  std::vector<std::array<Vec3, 3>> sources;
  for (Index f = 0; f < complex.faces.size(); ++f)
    if (const Triangle& t = complex.faces[f].ids; complex.is_contact(f))
      sources.push_back({points[t[0]], points[t[1]], points[t[2]]});
  for (const auto& [a, b] : complex.junctions()) sources.push_back({points[a], points[b], points[b]});
  std::vector<std::uint64_t> keys = parallel_collect<std::uint64_t>(
      0, sources.size(), ComplexGrains::divided,
      [&](std::size_t begin, std::size_t end, std::vector<std::uint64_t>& out) {
        for (std::size_t i = begin; i < end; ++i)
          for_voxels_near(sources[i], cells, Zone::reach, [&](std::uint64_t key) { out.push_back(key); });
      });
  parallel_sort_unique(keys);
  add(keys);
}

/// Adds voxels in which faces of two pairs of regions are so close to each other that the region between them
/// may have to give way.
void ContactZone::add_narrow_parts(const std::array<int, 3>& cells) {
  struct Mark {
    std::uint64_t key;
    std::pair<RegionIndex, RegionIndex> pair;
    auto operator<=>(const Mark&) const = default;
  };
  std::vector<Mark> marks = parallel_collect<Mark>(
      0, faces_.size(), ComplexGrains::divided,
      [&](std::size_t begin, std::size_t end, std::vector<Mark>& out) {
        for (std::size_t i = begin; i < end; ++i)
          if (const Face& f = faces_[i]; faces_another_pair(f))
            for_voxels_near(f.corners, cells, Zone::min_thickness, [&](std::uint64_t key) {
              out.push_back({key, f.pair()});
            });
      });
  parallel_sort_unique(marks);
  std::vector<std::uint64_t> keys;
  for (std::size_t i = 1; i < marks.size(); ++i)
    if (marks[i].key == marks[i - 1].key) keys.push_back(marks[i].key);
  add(keys);
}

/// Whether a face of another pair of regions is near, which has a region in common with this one.
bool ContactZone::faces_another_pair(const Face& face) const {
  Box3 box;
  for (const Vec3& p : face.corners) box.add(p);
  box.low -= Vec3::Constant(Zone::min_thickness);
  box.high += Vec3::Constant(Zone::min_thickness);
  bool found = false;
  tree_.for_each_in([&](const Box3& other) { return !found && other.intersects(box); },
                    [&](std::size_t i) {
                      const Face& o = faces_[i];
                      found |= o.pair() != face.pair() && (o.bounds(face.behind) || o.bounds(face.front));
                    });
  return found;
}

void ContactZone::add(const std::vector<std::uint64_t>& keys) {
  for (const std::uint64_t key : keys) {
    const std::array<int, 3> v = morton_decode(key);
    leaves_[leaf_of(v)].set(in_leaf(v));
  }
}

bool ContactZone::contains(const Vec3& point) const {
  std::array<int, 3> v;
  for (int a = 0; a < 3; ++a)
    v[static_cast<std::size_t>(a)] = std::max(0, static_cast<int>(std::floor(point[a])));
  const auto leaf = leaves_.find(leaf_of(v));
  return leaf != leaves_.end() && leaf->second.test(in_leaf(v));
}

ContactZone::Nearest ContactZone::nearest(const Vec3& point) const {
  std::size_t nearest = faces_.size();
  double squared_distance = HUGE_VAL, alignment = 0, side = 0;
  Vec3 from_nearest = Vec3::Zero();
  tree_.nearest(point, squared_distance, tree_.all(), [&](std::size_t i, double best) {
    const Face& f = faces_[i];
    const Vec3 away = point - closest_point(point, f.corners[0], f.corners[1], f.corners[2]);
    const double squared = away.squaredNorm();
    if (squared > squared_distance * (1 + Zone::tie)) return best;
    const double along = f.normal.dot(away);
    // Among equally near triangles the one that faces the point most directly knows its side.
    if (nearest < faces_.size() && squared >= squared_distance * (1 - Zone::tie)) {
      const double aligned = std::abs(along);
      if (aligned < alignment || (aligned == alignment && i > nearest)) return best;
    }
    nearest = i;
    squared_distance = std::min(squared_distance, squared);
    alignment = std::abs(along);
    side = along;
    from_nearest = away;
    return squared_distance * (1 + Zone::tie);
  });
  const Face& f = faces_[nearest];
  // On a contact rounding must not decide, or its points would be on either side by turns.
  const bool is_on_contact =
      std::abs(side) <= Zone::on_sheet && f.front != outside_region && f.behind != outside_region;
  const bool in_front = is_on_contact ? f.front < f.behind : side > 0;
  return {in_front ? f.front : f.behind, in_front ? f.behind : f.front,
          away_from(from_nearest, std::sqrt(squared_distance), in_front ? f.normal : Vec3(-f.normal))};
}

template <class Accepts>
std::pair<const ContactZone::Face*, Vec3> ContactZone::nearest_face(const Vec3& point, double limit,
                                                                    const Accepts& accepts) const {
  const Face* nearest = nullptr;
  Vec3 away = Vec3::Zero();
  tree_.nearest(point, limit * limit, tree_.all(), [&](std::size_t i, double best) {
    const Face& f = faces_[i];
    if (!accepts(f)) return best;
    const Vec3 d = point - closest_point(point, f.corners[0], f.corners[1], f.corners[2]);
    const double squared = d.squaredNorm();
    if (squared >= best) return best;
    nearest = &f;
    away = d;
    return squared;
  });
  return {nearest, away};
}

std::optional<ContactZone::Narrow> ContactZone::narrow(const Vec3& point, const Nearest& at) const {
  std::optional<NearLine> line;
  if (at.region == outside_region) line = near_line(point, at.across, outside_region);
  const double limit =
      std::max(Zone::widest_narrow, line ? touching_thickness(line->away.norm()) : 0) - at.distance.value;
  if (!(limit > 0)) return {};
  const auto [farther, away] = nearest_face(
      point, limit, [&](const Face& f) { return f.bounds(at.region) && f.across(at.region) != at.across; });
  if (!farther) return {};
  if (line) line = near_line(point, at.across, farther->across(at.region));
  const Distance distance =
      away_from(away, away.norm(), farther->front == at.region ? farther->normal : Vec3(-farther->normal));
  const double cosine = distance.gradient.dot(at.distance.gradient);
  if (cosine > Zone::facing && !line) return {};
  Narrow narrow{
      farther->across(at.region), distance, at.distance.value + distance.value, cosine, 0, Vec3::Zero()};
  const double share = std::clamp((Zone::facing - cosine) / (Zone::facing - Zone::facing_entirely), 0.0, 1.0);
  const double smallest =
      share * (at.region == outside_region ? Zone::min_thickness : Zone::min_refined_thickness);
  if (const double lack = smallest - narrow.thickness; lack > 0) {
    narrow.deficit = Zone::slope * lack;
    narrow.slope = -Zone::slope * (at.distance.gradient + distance.gradient);
  }
  if (line) give_way(*line, narrow);
  return narrow;
}

std::optional<ContactZone::Distance> ContactZone::distance(const Vec3& point, RegionIndex region) const {
  const auto [nearest, away] =
      nearest_face(point, Zone::reach, [&](const Face& f) { return f.bounds(region); });
  if (!nearest) return {};
  return away_from(away, away.norm(), nearest->front == region ? Vec3(-nearest->normal) : nearest->normal);
}

}  // namespace tetwright
