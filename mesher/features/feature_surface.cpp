// SPDX-License-Identifier: Apache-2.0
#include "mesher/features/feature_surface.h"

#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include "common/parallel/parallel_sort.h"
#include "mesher/tuning/cut_tuning.h"

namespace tetwright {

FeatureSurface::FeatureSurface(const MesherInput& input, const std::vector<SurfacePatches>& patches,
                               double corner_reach, std::shared_ptr<const MaterialField> field,
                               const ComplexPatches* complex, const std::vector<TriangleMesh>& caps)
    : field_(std::move(field)) {
  Items items;
  for (const MaterialLayer& layer : input.layers) bodies_[layer.tag] = 0;
  for (std::size_t b = 0; b < input.bodies.size(); ++b) bodies_[input.bodies[b].tag] = b;
  if (complex)
    add_complex(*complex, corner_reach, items);
  else
    add_bodies(input, patches, corner_reach, caps, items);
  no_patch_ = static_cast<Patch>(groups_.size());
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
    items.segments.push_back({{first + s.ends[0], first + s.ends[1], first + s.ends[1]},
                              {patch_of(s.patches[0]), patch_of(s.patches[1]), 0}});
    for (const Index end : s.ends)
      if (const auto corner = at_corners.find(end); corner != at_corners.end())
        for (const std::uint16_t p : s.patches) corner->second.insert(patch_of(p));
  }
  for (const auto& [c, meeting] : at_corners)
    corners_.push_back({points[c], {meeting.begin(), meeting.end()}});
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
    if (patches[b].verdict == SurfacePatches::Verdict::meeting && !patches[b].any()) {
      bodies_.erase(input.bodies[b].tag);
      continue;
    }
    const std::size_t first_patch = groups_.size();
    groups_.resize(first_patch + patches[b].count);
    sheet_of_patch_.resize(groups_.size(), b);
    for (std::size_t t = 0; t < surface.groups.size(); ++t)
      groups_[first_patch + patches[b].patches[t]] = input.bodies[b].groups[surface.groups[t]];
    const std::size_t first_item = items.triangles.size();
    add_triangles(surface.points, surface.triangles, patches[b].patches, patches[b].rough,
                  static_cast<Patch>(first_patch), corner_reach, items);
    if (b < caps.size()) add_caps(caps[b], first_item, items.points, items.triangles);
  }
}

void FeatureSurface::add_complex(const ComplexPatches& complex, double corner_reach, Items& items) {
  sheets_ = complex.sheets;
  inner_sheets_ = complex.inner_sheets;
  first_continued_ = complex.first_continued;
  sheet_of_patch_ = complex.sheet_of_patch;
  groups_ = complex.groups;
  add_triangles(complex.points, complex.triangles, complex.patches, complex.rough, 0, corner_reach, items,
                complex.touching);
}

std::optional<std::size_t> FeatureSurface::sheet_of(const InterfaceTriangle& face) const {
  const auto find = [&](MaterialOrOutside material) -> std::optional<std::size_t> {
    const auto body = material ? bodies_.find(*material) : bodies_.end();
    if (body == bodies_.end()) return {};
    return body->second;
  };
  const std::optional<std::size_t> first = find(face.material), second = find(face.other);
  if (!sheets_.empty()) {
    const auto label = [](const std::optional<std::size_t>& body) {
      return static_cast<RegionIndex>(body ? *body + 1 : outside_region);
    };
    if (face.other == face.material) {
      const auto inner = inner_sheets_.find({face.patch, label(first)});
      if (inner == inner_sheets_.end()) return {};
      return inner->second;
    }
    return sheet_between(label(first), label(second));
  }
  if (!first || !second) return first ? first : second;
  if (*first == *second) return {};
  return std::max(*first, *second);
}

std::optional<FeatureSurface::Place> FeatureSurface::nearest(const Vec3& p, std::size_t sheet, double at_most,
                                                             const Vec3* facing) const {
  const auto hit = triangles_.nearest_of(p, at_most, [&](const ProjectionTree::Item& item) {
    if (item.kind[1] != sheet) return false;
    return !facing || normals_[static_cast<std::size_t>(&item - triangles_.items().data())].dot(*facing) >=
                          CutTuning::Labelling::min_facing;
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

std::optional<Vec3> FeatureSurface::onto_patch(const Vec3& point, MaterialOrOutside first,
                                               MaterialOrOutside second, Patch patch,
                                               double max_distance) const {
  if (patch == no_patch_) return field_->project(point, first, second, max_distance);
  const auto place = nearest_of_patch(point, patch, max_distance);
  if (!place) return {};
  return place->point;
}

std::optional<Vec3> FeatureSurface::onto_crease(const Vec3& point, double max_distance) const {
  const auto place = nearest_crease(point, max_distance, [](const PatchPair&) { return true; });
  if (!place) return {};
  return place->point;
}

std::optional<Vec3> FeatureSurface::onto_crease_between(const Vec3& p, const PatchPair& pair,
                                                        double at_most) const {
  return creases_.nearest(p, {pair[0], pair[1], 0}, at_most);
}

}  // namespace tetwright
