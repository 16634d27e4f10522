// SPDX-License-Identifier: Apache-2.0
#include "mesher/features/cap_faces.h"

#include <algorithm>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "common/parallel/parallel_sort.h"
#include "mesher/tuning/cell_tuning.h"
#include "mesher/tuning/cut_tuning.h"

namespace tetwright {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Whether a face is on the boundary of all materials but the outside.
bool is_boundary(const InterfaceTriangle& t) {
  if (t.is_sheet()) return false;
  return t.material == outside_tag ? t.other.has_value() : !t.other;
}

struct TreeBuilder {
  std::vector<Vec3> points;
  std::vector<ProjectionTree::Item> items;

  void add(const std::vector<Vec3>& more, const std::vector<Triangle>& triangles, std::uint32_t kind) {
    const auto first = static_cast<Index>(points.size());
    points.insert(points.end(), more.begin(), more.end());
    for (const auto& [a, b, c] : triangles)
      items.push_back({{first + a, first + b, first + c}, {kind, 0, 0}});
  }
  ProjectionTree build() { return {std::move(points), std::move(items)}; }
};

}  // namespace

SurfaceCapFaces::SurfaceCapFaces(const MesherInput& input, const std::vector<TriangleMesh>& caps, double cell)
    : cell_(cell),
      near_((input.complex ? CellTuning::Caps::near_joined : CellTuning::Caps::near) *
            (input.high - input.low).norm()) {
  TreeBuilder surfaces, closings, winding;
  for (std::uint32_t h = 0; h < input.holes.size(); ++h) {
    const SurfaceHole& hole = input.holes[h];
    holes_.push_back({.name = hole.name, .flat = hole.flat, .sharp = hole.sharp});
    if (hole.sharp || hole.size < CellTuning::Caps::min_area * cell * cell) continue;
    std::vector<Triangle> edges;
    for (const auto& [a, b] : hole.rim) edges.push_back({a, b, b});
    closings.add(hole.points, hole.flat ? hole.triangles : edges, h + 1);
  }
  if (!closings.items.empty()) {
    for (const MesherInput::Body& body : input.bodies)
      surfaces.add(body.surface.points, body.surface.triangles, 0);
    for (const TriangleMesh& c : caps) winding.add(c.points, c.triangles, 0);
  }
  surfaces_ = surfaces.build();
  closings_ = closings.build();
  winding_caps_ = winding.build();
}

std::size_t SurfaceCapFaces::hole_of(const TetMesh& mesh, const InterfaceTriangle& face) const {
  const Vec3 &a = mesh.points[face.ids[0]], &b = mesh.points[face.ids[1]], &c = mesh.points[face.ids[2]];
  const Vec3 centre = (a + b + c) / 3;
  const auto any = [](const ProjectionTree::Item&) { return true; };
  const auto closing = closings_.nearest_of(centre, infinity, any);
  const auto surface = surfaces_.nearest_of(centre, infinity, any);
  if (!closing || !surface) return holes_.size();
  const ProjectionTree::Item& item = closings_.items()[closing->item];
  const std::size_t hole = item.kind[0] - 1;
  const double from_surface = (surface->point - centre).norm();
  if ((closing->point - centre).norm() > from_surface + near_) {
    const bool far = from_surface > cell_ && winding_caps_.any_within(centre, from_surface);
    return far && !holes_[hole].flat ? hole : holes_.size();
  }
  if (!holes_[hole].flat) return hole;
  const Vec3& first = closings_.corner(item, 0);
  const Vec3 normal = (closings_.corner(item, 1) - first).cross(closings_.corner(item, 2) - first);
  const Vec3 of_face = (b - a).cross(c - a);
  const double alike = std::abs(normal.dot(of_face));
  return alike >= CellTuning::Caps::min_facing * normal.norm() * of_face.norm() ? hole : holes_.size();
}

CapReport SurfaceCapFaces::name(TetMesh& mesh, CapNaming naming) const {
  CapReport report;
  report.holes = holes_.size();
  std::vector<CapReport::Cap> caps = holes_;
  std::vector<std::size_t> hole(mesh.interfaces.size(), holes_.size());
  const bool sharp_only = closings_.empty();
  std::map<std::string, std::size_t> sharp;
  for (std::size_t h = 0; h < holes_.size(); ++h)
    if (holes_[h].sharp) sharp[holes_[h].name] = h;
  parallel_for(0, mesh.interfaces.size(), CutGrains::searches, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const InterfaceTriangle& t = mesh.interfaces[i];
      if (t.is_sheet()) continue;
      if (const auto group = mesh.patch_groups.find({t.pair(), t.patch}); group != mesh.patch_groups.end())
        if (const auto known = sharp.find(group->second.name); known != sharp.end()) {
          hole[i] = known->second;
          continue;
        }
      if (!sharp_only && is_boundary(t)) hole[i] = hole_of(mesh, t);
    }
  });

  std::map<MaterialPair, std::uint16_t> last;
  for (const InterfaceTriangle& t : mesh.interfaces) {
    std::uint16_t& patch = last[t.pair()];
    patch = std::max(patch, t.patch);
  }
  std::map<std::pair<MaterialPair, std::size_t>, std::uint16_t> patches;
  for (std::size_t i = 0; i < hole.size(); ++i) {
    InterfaceTriangle& t = mesh.interfaces[i];
    const Vec3 &a = mesh.points[t.ids[0]], &b = mesh.points[t.ids[1]], &c = mesh.points[t.ids[2]];
    // Away from the material.
    const Vec3 vector = (t.material == outside_tag ? -0.5 : 0.5) * (b - a).cross(c - a);
    if (is_boundary(t)) report.boundary_area += vector.norm();
    if (hole[i] == holes_.size()) continue;
    if (is_boundary(t)) report.area += vector.norm();
    CapReport::Cap& cap = caps[hole[i]];
    ++cap.triangles;
    cap.area += vector.norm();
    cap.normal += vector;
    cap.centre += vector.norm() * (a + b + c) / 3;
    cap.named |= cap.sharp;
    if (cap.sharp || naming == CapNaming::sharp) continue;
    auto patch = patches.find({t.pair(), hole[i]});
    if (patch == patches.end()) {
      std::uint16_t& number = last[t.pair()];
      if (number == std::numeric_limits<std::uint16_t>::max()) continue;
      patch = patches.insert({{t.pair(), hole[i]}, ++number}).first;
      mesh.patch_groups[{t.pair(), number}] = {0, cap.name};
    }
    t.patch = patch->second;
    cap.named = true;
  }
  for (CapReport::Cap& cap : caps) {
    report.flat += cap.flat;
    if (cap.triangles == 0) continue;
    if (cap.area > 0) cap.centre /= cap.area;
    if (cap.normal.norm() > 0) cap.normal.normalize();
    report.caps.push_back(std::move(cap));
  }
  return report;
}

}  // namespace tetwright
