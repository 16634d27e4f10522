// SPDX-License-Identifier: Apache-2.0
#include "mesher/features/feature_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "common/features/crease_pieces.h"
#include "common/geometry/box_tree.h"
#include "common/parallel/parallel_sort.h"

namespace tetwright {

namespace {

/// Sides of a volume, each of them a patch; the faces between labels have the patch 0.
constexpr std::size_t border_sides = 6;

}  // namespace

FeatureSurface::FeatureSurface(const MesherInput& input, const std::vector<SurfacePatches>& patches,
                               double corner_reach, std::shared_ptr<const MaterialField> field,
                               const ComplexPatches* complex, const std::vector<TriangleMesh>& caps,
                               GivenUpZone given_up, std::vector<double> cells,
                               std::shared_ptr<const ReferenceSurface> surroundings)
    : field_(std::move(field)),
      surroundings_(std::move(surroundings)),
      given_up_(std::move(given_up)),
      cells_(std::move(cells)) {
  Items items;
  if (surroundings_) {  // the patches of labels come first
    groups_.resize(1 + border_sides);
    sheet_of_patch_.resize(groups_.size());
    first_body_patch_ = static_cast<Patch>(groups_.size());
  }
  for (const MaterialLayer& layer : input.layers) bodies_[layer.tag] = 0;
  for (std::size_t b = 0; b < input.bodies.size(); ++b) bodies_[input.bodies[b].tag] = b;
  if (complex)
    add_complex(*complex, corner_reach, items);
  else
    add_bodies(input, patches, corner_reach, caps, items);
  no_patch_ = surroundings_ ? Patch{0} : static_cast<Patch>(groups_.size());
  if (surroundings_)
    for (std::size_t b = 0; b < patches.size(); ++b)
      if (const RepairedSurface& surface = input.bodies[b].surface; patches[b].any())
        creased_size_ = std::min(creased_size_.value_or(HUGE_VAL), (surface.high - surface.low).norm());
  auto [points, triangles, segments] = std::move(items);
  creases_ = ProjectionTree(points, std::move(segments));
  std::vector<Vec3> corner_places;
  std::vector<ProjectionTree::Item> corner_items;
  for (Index c = 0; c < corners_.size(); ++c) {
    corner_places.push_back(corners_[c].point);
    corner_items.push_back({{c, c, c}, {}});
  }
  corner_points_ = ProjectionTree(std::move(corner_places), std::move(corner_items));
  triangles_ = ProjectionTree(std::move(points), std::move(triangles));
  normals_.reserve(triangles_.items().size());
  for (const ProjectionTree::Item& item : triangles_.items()) {
    const Vec3& a = triangles_.corner(item, 0);
    const Vec3 n = (triangles_.corner(item, 1) - a).cross(triangles_.corner(item, 2) - a);
    const double length = n.norm();
    normals_.push_back(length > 0 ? Vec3(n / length) : Vec3(Vec3::Zero()));
  }
  if (surroundings_) find_flat_patches();
}

void FeatureSurface::find_flat_patches() {
  struct Plane {
    Vec3 normal = Vec3::Zero();  // of the largest triangle
    Vec3 point = Vec3::Zero();
    double area = 0;
    Box3 box;
  };
  std::vector<Plane> planes(groups_.size());
  const auto for_each_triangle = [&](const auto& visit) {
    for (std::size_t i = 0; i < triangles_.items().size(); ++i) {
      const ProjectionTree::Item& item = triangles_.items()[i];
      visit(planes[item.kind[0]], item.kind[0], i,
            std::array{triangles_.corner(item, 0), triangles_.corner(item, 1), triangles_.corner(item, 2)});
    }
  };
  for_each_triangle([&](Plane& plane, std::uint32_t, std::size_t i, const std::array<Vec3, 3>& c) {
    const double area = (c[1] - c[0]).cross(c[2] - c[0]).norm();
    if (area > plane.area) plane.area = area, plane.normal = normals_[i], plane.point = c[0];
    for (const Vec3& p : c) plane.box.add(p);
  });
  flat_.resize(planes.size());
  std::transform(planes.begin(), planes.end(), flat_.begin(), [](const Plane& p) { return p.area > 0; });
  std::fill_n(flat_.begin() + 1, border_sides, 1);
  for_each_triangle([&](const Plane& plane, std::uint32_t patch, std::size_t, const std::array<Vec3, 3>& c) {
    const double at_most = CutTuning::Labelling::flat_share * (plane.box.high - plane.box.low).norm();
    for (const Vec3& p : c)
      if (std::fabs(plane.normal.dot(p - plane.point)) > at_most) flat_[patch] = 0;
  });
}

void FeatureSurface::add_triangles(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles,
                                   const std::vector<std::uint16_t>& patches,
                                   const std::vector<std::uint8_t>& rough, Patch first_patch,
                                   double corner_reach, Items& items,
                                   std::span<const std::array<Index, 2>> without) {
  const auto first = static_cast<Index>(items.points.size());
  const auto patch_of = [&](std::uint16_t local) { return static_cast<Patch>(first_patch + local); };
  items.points.insert(items.points.end(), points.begin(), points.end());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Triangle& c = triangles[t];
    const Patch patch = patch_of(patches[t]);
    items.triangles.push_back({{first + c[0], first + c[1], first + c[2]},
                               {patch, static_cast<std::uint32_t>(sheet_of_patch_[patch]), 0}});
  }
  const SurfaceCreases found = find_creases(points, triangles, patches, corner_reach, rough);
  std::map<Index, std::set<Patch>> at_corners;
  for (const Index c : found.corners) at_corners[c] = {};
  for (const std::array<Index, 2>& edge : without)
    for (const Index p : edge) at_corners.erase(p);
  for (const SurfaceCreases::Segment& s : found.segments) {
    if (std::binary_search(without.begin(), without.end(), s.ends)) continue;
    add_segment(s, first, {patch_of(s.patches[0]), patch_of(s.patches[1])}, items);
    for (const Index end : s.ends)
      if (const auto corner = at_corners.find(end); corner != at_corners.end())
        for (const std::uint16_t p : s.patches) corner->second.insert(patch_of(p));
  }
  for (const auto& [c, meeting] : at_corners) {
    const std::size_t sheet = sheet_of_patch_[*meeting.begin()];
    const bool on_one_sheet =
        std::all_of(meeting.begin(), meeting.end(), [&](Patch p) { return sheet_of_patch_[p] == sheet; });
    if (!on_one_sheet || !is_given_up(points[c], sheet))
      corners_.push_back({points[c], {meeting.begin(), meeting.end()}});
  }
}

/// Adds a segment of a crease but for the parts that are given up. Between two sheets of a complex is a
/// junction, which is kept.
void FeatureSurface::add_segment(const SurfaceCreases::Segment& segment, Index first,
                                 const PatchPair& patches, Items& items) const {
  const ProjectionTree::Kind kind{patches[0], patches[1], 0};
  const Index a = first + segment.ends[0], b = first + segment.ends[1];
  const std::size_t sheet = sheet_of_patch_[patches[0]];
  const auto is_in_zone = [&](const Vec3& p) { return is_given_up(p, sheet); };
  if (!given_up_.any() || sheet != sheet_of_patch_[patches[1]]) {
    items.segments.push_back({{a, b, b}, kind});
    return;
  }
  // Points beside the zone find the part of the crease next to them, not an end: pieces that cross its border
  // are kept.
  for_each_run(
      Vec3(items.points[a]), Vec3(items.points[b]), given_up_.piece(),
      [&](const Vec3& p, const Vec3& q) { return is_in_zone(p) && is_in_zone(q); },
      [&](const Vec3& p, const Vec3& q, bool lost) {
        if (lost) return;
        const auto added = static_cast<Index>(items.points.size());
        items.points.insert(items.points.end(), {p, q});
        items.segments.push_back({{added, added + 1, added + 1}, kind});
      });
}

namespace {

/// Adds caps with the patches of the nearest triangles of their body. Without caps, points on them would be
/// drawn to the rims.
/// \param first first of `items` that belongs to the body
void add_caps(const TriangleMesh& caps, std::size_t first, std::vector<Vec3>& points,
              std::vector<ProjectionTree::Item>& items) {
  if (caps.triangles.empty()) return;
  const ProjectionTree body(points, {items.begin() + static_cast<std::ptrdiff_t>(first), items.end()});
  std::vector<ProjectionTree::Item> added(caps.triangles.size());
  const auto shift = static_cast<Index>(points.size());
  parallel_for(0, added.size(), CutGrains::searches, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto& [a, b, c] = caps.triangles[i];
      const auto hit = body.nearest_of((caps.points[a] + caps.points[b] + caps.points[c]) / 3,
                                       std::numeric_limits<double>::infinity(),
                                       [](const ProjectionTree::Item&) { return true; });
      added[i] = {{shift + a, shift + b, shift + c}, body.items()[hit->item].kind};
    }
  });
  points.insert(points.end(), caps.points.begin(), caps.points.end());
  items.insert(items.end(), added.begin(), added.end());
}

}  // namespace

void FeatureSurface::add_bodies(const MesherInput& input, const std::vector<SurfacePatches>& patches,
                                double corner_reach, const std::vector<TriangleMesh>& caps, Items& items) {
  for (std::size_t b = 0; b < input.bodies.size(); ++b) {
    const RepairedSurface& surface = input.bodies[b].surface;
    if (are_given_up(patches[b]) && !patches[b].any()) {
      bodies_.erase(input.bodies[b].tag);
      continue;
    }
    const std::size_t first_patch = groups_.size();
    groups_.resize(first_patch + patches[b].count);
    sheet_of_patch_.resize(groups_.size(), b);
    for (std::size_t t = 0; t < surface.groups.size(); ++t)
      groups_[first_patch + patches[b].patches[t]] = input.bodies[b].groups[surface.groups[t]];
    const std::size_t first_item = items.triangles.size();
    const double smaller = cells_.empty() ? 1 : cells_[b] / *std::max_element(cells_.begin(), cells_.end());
    add_triangles(surface.points, surface.triangles, patches[b].patches, patches[b].rough,
                  static_cast<Patch>(first_patch), smaller * corner_reach, items);
    if (b < caps.size()) add_caps(caps[b], first_item, items.points, items.triangles);
  }
}

void FeatureSurface::add_complex(const ComplexPatches& complex, double corner_reach, Items& items) {
  sheets_ = complex.sheets;
  bodies_of_sheet_.resize(sheets_.size());
  // Region 0 is the outside, and `bodies` counts from there.
  for (const auto& [regions, sheet] : sheets_)
    bodies_of_sheet_[sheet] = {
        std::size_t{regions.first == outside_region ? regions.second : regions.first} - 1,
        std::size_t{regions.second} - 1};
  inner_sheets_ = complex.inner_sheets;
  const auto first_patch = static_cast<Patch>(groups_.size());
  first_continued_ = static_cast<Patch>(first_patch + complex.first_continued);
  sheet_of_patch_.insert(sheet_of_patch_.end(), complex.sheet_of_patch.begin(), complex.sheet_of_patch.end());
  groups_.insert(groups_.end(), complex.groups.begin(), complex.groups.end());
  add_triangles(complex.points, complex.triangles, complex.patches, complex.rough, first_patch, corner_reach,
                items, complex.touching);
  std::vector<ProjectionTree::Item> touching;
  for (const auto& [a, b] : complex.touching) touching.push_back({{a, b, b}, {}});
  touching_edges_ = ProjectionTree(complex.points, std::move(touching));
}

std::optional<std::size_t> FeatureSurface::sheet_of(const InterfaceTriangle& face) const {
  if (is_beside_bodies(face)) return {};
  const auto find = [&](MaterialOrOutside material) -> std::optional<std::size_t> {
    const auto body = material ? bodies_.find(*material) : bodies_.end();
    if (body == bodies_.end()) return {};
    return body->second;
  };
  const std::optional<std::size_t> first = find(face.material), second = find(face.other);
  if (!sheets_.empty()) {
    if (face.other == face.material) {
      const auto inner = inner_sheets_.find({face.patch, region_of(face.material)});
      if (inner == inner_sheets_.end()) return {};
      return inner->second;
    }
    return sheet_between(region_of(face.material), region_of(face.other));
  }
  if (!first || !second) return first ? first : second;
  if (*first == *second) return {};
  return std::max(*first, *second);
}

std::optional<double> FeatureSurface::cell_of(std::size_t sheet) const {
  if (cells_.empty()) return {};
  if (!has_junctions()) return cells_[sheet];
  if (sheet >= bodies_of_sheet_.size()) return {};
  const auto [first, second] = bodies_of_sheet_[sheet];
  return std::min(cells_[first], cells_[second]);
}

bool FeatureSurface::are_alike(const InterfaceTriangle& a, const InterfaceTriangle& b) const {
  if (!surroundings_) return a.pair() == b.pair();
  const auto bodies_of = [&](const InterfaceTriangle& t) {
    const auto body_of = [&](MaterialOrOutside m) {
      return m && bodies_.contains(*m) ? m : MaterialOrOutside();
    };
    const MaterialOrOutside first = body_of(t.material), second = body_of(t.other);
    return first < second ? std::pair(first, second) : std::pair(second, first);
  };
  return bodies_of(a) == bodies_of(b);
}

std::optional<std::size_t> FeatureSurface::sheet_across_gap(const InterfaceTriangle& face, const Vec3& at,
                                                            double reach) const {
  if (!has_junctions() || !face.other || *face.other == face.material) return {};
  const auto first = bodies_.find(face.material), second = bodies_.find(*face.other);
  if (first == bodies_.end() || second == bodies_.end()) return {};
  const std::size_t earlier = std::min(first->second, second->second),
                    later = std::max(first->second, second->second);
  const auto region = [](std::size_t body) { return static_cast<RegionIndex>(body + 1); };
  if (sheet_between(region(earlier), region(later))) return {};
  const auto own = sheet_between(outside_region, region(earlier)),
             facing = sheet_between(outside_region, region(later));
  if (!own || !facing || !nearest(at, *own, reach) || !nearest(at, *facing, reach)) return {};
  const auto bounds = [&](std::size_t sheet, std::size_t body) {
    const auto& bodies = bodies_of_sheet_[sheet];
    return std::find(bodies.begin(), bodies.end(), body) != bodies.end();
  };
  const auto is_shared = [&](const PatchPair& pair) {
    const std::size_t a = sheet_of_patch_[pair[0]], b = sheet_of_patch_[pair[1]];
    return a < bodies_of_sheet_.size() && b < bodies_of_sheet_.size() &&
           ((bounds(a, earlier) && bounds(b, later)) || (bounds(a, later) && bounds(b, earlier)));
  };
  // Zone::touching_thickness is larger than that of other gaps.
  constexpr double to_edges = 2;
  if (nearest_crease(at, reach, is_shared) || touching_edges_.any_within(at, to_edges * reach)) return {};
  return own;
}

bool FeatureSurface::is_given_up(const Vec3& p, std::size_t sheet) const {
  if (!has_junctions()) return given_up_.contains(p, sheet);
  return sheet < bodies_of_sheet_.size() &&
         std::any_of(bodies_of_sheet_[sheet].begin(), bodies_of_sheet_[sheet].end(),
                     [&](std::size_t body) { return given_up_.contains(p, body); });
}

unsigned FeatureSurface::border_planes(const Vec3& point, double slack) const {
  if (!is_surrounded() || !field_->volume()) return 0;
  const GridFrame& frame = field_->frame();
  return side_planes(frame.to_grid(point), frame.volume(), slack);
}

Vec3 FeatureSurface::onto_border(const Vec3& point, unsigned planes) const {
  if (planes == 0) return point;
  const GridFrame& frame = field_->frame();
  const CellBox volume = frame.volume();
  // In skewed volumes not the closest point, unless the plane is one of several.
  Vec3 at = frame.to_grid(point);
  for (int a = 0; a < 3; ++a) {
    if (planes >> 2 * a & 1) at[a] = volume.low[a];
    if (planes >> 2 * a & 2) at[a] = volume.high[a];
  }
  return frame.to_input(at);
}

std::optional<FeatureSurface::Place> FeatureSurface::nearest(const Vec3& p, std::size_t sheet, double at_most,
                                                             const Vec3* facing, double min_facing) const {
  const auto hit = triangles_.nearest_of(p, at_most, [&](const ProjectionTree::Item& item) {
    if (item.kind[1] != sheet) return false;
    return !facing ||
           normals_[static_cast<std::size_t>(&item - triangles_.items().data())].dot(*facing) >= min_facing;
  });
  if (!hit) return {};
  return Place{hit->point, normals_[hit->item], static_cast<Patch>(triangles_.items()[hit->item].kind[0])};
}

std::optional<FeatureSurface::Place> FeatureSurface::nearest_of_patch(const Vec3& p, Patch patch,
                                                                      double at_most) const {
  const auto hit = triangles_.nearest_of(
      p, at_most, [&](const ProjectionTree::Item& item) { return item.kind[0] == patch; });
  if (!hit) return {};
  return Place{hit->point, normals_[hit->item], patch};
}

namespace {

/// The nearer one of two points, if there are any.
std::optional<Vec3> nearer(const Vec3& point, const std::optional<Vec3>& a, const std::optional<Vec3>& b) {
  if (!a || !b) return a ? a : b;
  return (*b - point).squaredNorm() < (*a - point).squaredNorm() ? b : a;
}

}  // namespace

std::optional<Vec3> FeatureSurface::onto_patch(const Vec3& point, MaterialOrOutside first,
                                               MaterialOrOutside second, Patch patch,
                                               double max_distance) const {
  if (is_beside_bodies(first, second))
    return surroundings_->has_patches() ? surroundings_->onto_patch(point, first, second, patch, max_distance)
                                        : surroundings_->project(point, first, second, max_distance);
  if (patch == no_patch_ || (given_up_.any() && is_given_up(point, sheet_of(patch))))
    return field_->project(point, first, second, max_distance);
  const auto place = nearest_of_patch(point, patch, max_distance);
  if (!place) return {};
  return place->point;
}

std::optional<Vec3> FeatureSurface::onto_crease(const Vec3& point, double max_distance) const {
  const auto place = nearest_crease(point, max_distance, [](const PatchPair&) { return true; });
  std::optional<Vec3> own;
  if (place) own = place->point;
  return surroundings_ ? nearer(point, own, surroundings_->onto_crease(point, max_distance)) : own;
}

std::optional<Vec3> FeatureSurface::onto_corner(const Vec3& point, double max_distance) const {
  const std::optional<Vec3> own = corner_points_.nearest(point, {}, max_distance);
  return surroundings_ ? nearer(point, own, surroundings_->onto_corner(point, max_distance)) : own;
}

std::optional<Vec3> FeatureSurface::onto_crease_between(const Vec3& p, const PatchPair& pair,
                                                        double at_most) const {
  return creases_.nearest(p, {pair[0], pair[1], 0}, at_most);
}

}  // namespace tetwright
