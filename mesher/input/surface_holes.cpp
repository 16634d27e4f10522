// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/surface_holes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "common/features/edge_uses.h"
#include "common/geometry/projection_tree.h"
#include "common/message_text.h"
#include "mesher/input/flat_caps.h"
#include "mesher/input/open_surfaces.h"
#include "mesher/input/surface_components.h"
#include "mesher/tuning/input_tuning.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

using Tuning = InputTuning::Holes;

/// The share of a cap's rim that turns by more than an angle.
double turning_share(const FlatCap& cap, const std::vector<HoleRim>& rims, const std::vector<Vec3>& points,
                     const std::vector<Triangle>& triangles, double angle) {
  const Vec3 normal = cap.vector.normalized();
  double turning = 0, all = 0;
  for (const std::size_t r : cap.rims)
    for (std::size_t i = 0; i < rims[r].edges.size(); ++i) {
      const auto& [a, b] = rims[r].edges[i];
      const double length = (points[b] - points[a]).norm();
      const Vec3 beside = area_vector(points, triangles[rims[r].at_triangle[i]]);
      all += length;
      if (std::atan2(beside.cross(normal).norm(), beside.dot(normal)) > angle) turning += length;
    }
  return all > 0 ? turning / all : 0;
}

/// The group of the triangle at the longest edge of a cap's rim.
std::uint32_t group_beside(const FlatCap& cap, const std::vector<HoleRim>& rims,
                           const std::vector<Vec3>& points, const std::vector<Index>& in_surface,
                           const std::vector<std::uint32_t>& groups) {
  double longest = -1;
  std::uint32_t group = 0;
  for (const std::size_t r : cap.rims)
    for (std::size_t i = 0; i < rims[r].edges.size(); ++i) {
      const double length = (points[rims[r].edges[i][1]] - points[rims[r].edges[i][0]]).norm();
      if (length <= longest) continue;
      longest = length;
      group = groups[in_surface[rims[r].at_triangle[i]]];
    }
  return group;
}

/// A hole with the points of the rims.
SurfaceHole hole_of(const std::vector<const HoleRim*>& rims, const std::vector<Triangle>& triangles,
                    const std::vector<Vec3>& points) {
  SurfaceHole hole;
  std::map<Index, Index> numbers;
  const auto number = [&](Index p) {
    const auto [known, added] = numbers.try_emplace(p, static_cast<Index>(hole.points.size()));
    if (added) hole.points.push_back(points[p]);
    return known->second;
  };
  for (const HoleRim* rim : rims)
    for (const auto& [a, b] : rim->edges) {
      const Index from = number(a);
      hole.rim.push_back({from, number(b)});
    }
  for (const auto& [a, b, c] : triangles) {
    const Index first = number(a), second = number(b);
    hole.triangles.push_back({first, second, number(c)});
  }
  return hole;
}

SurfaceHole open_hole(const HoleRim& rim, const std::vector<Vec3>& points) {
  SurfaceHole hole = hole_of({&rim}, {}, points);
  hole.size = rim.vector.norm();
  const auto centre = static_cast<Index>(hole.points.size());
  hole.points.push_back(rim.centre);
  for (const auto& [a, b] : hole.rim) hole.triangles.push_back({a, b, centre});
  return hole;
}

/// Spreads the bits of an edge's key (the finalizer of SplitMix64).
std::uint64_t mixed(std::uint64_t key) {
  key = (key ^ (key >> 30)) * 0xbf58476d1ce4e5b9u;
  key = (key ^ (key >> 27)) * 0x94d049bb133111ebu;
  return key ^ (key >> 31);
}

double degrees_of(const FeatureAngle& angle) {
  constexpr double automatic = 35;  // as of find_patches()
  constexpr double never = 360;
  return angle.rule == FeatureAngle::Rule::off       ? never
         : angle.rule == FeatureAngle::Rule::degrees ? angle.degrees
                                                     : automatic;
}

}  // namespace

bool has_free_edges(const std::vector<Triangle>& triangles) {
  // Edges of two triangles cancel out, so that closed surfaces need no sorting.
  std::uint64_t odd = 0;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(t[k], t[(k + 1) % 3]);
      odd ^= mixed(std::uint64_t{a} << 32 | b);
    }
  if (odd == 0) return false;
  const std::vector<EdgeUse> uses = edge_uses(triangles, {});
  for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
    while (j < uses.size() && uses[j].key == uses[i].key) ++j;
    if (j - i == 1) return true;
  }
  return false;
}

std::vector<SurfaceHole> close_flat_holes(CleanedSurface& surface, std::vector<SurfaceRegion>& groups,
                                          const std::string& file, const CapOptions& options,
                                          std::vector<Diagnostic>& findings) {
  std::vector<SurfaceHole> holes;
  if (!has_free_edges(surface.triangles)) return holes;
  std::vector<Triangle> oriented = surface.triangles;
  std::vector<Diagnostic> unused;
  const std::vector<SurfaceComponent> components =
      split_into_components(surface.points, oriented, surface.two_sided, file, unused);
  std::vector<Triangle> triangles;  // of components, without inner walls
  std::vector<Index> in_surface, component;
  for (Index c = 0; c < components.size(); ++c)
    for (const Index t : components[c].triangles) {
      triangles.push_back(oriented[t]);
      in_surface.push_back(t);
      component.push_back(c);
    }
  const std::vector<HoleRim> rims = find_rims(surface.points, triangles);
  std::vector<FlatCap> caps;
  if (options.close_flat) caps = find_flat_caps(surface.points, triangles, rims, component);
  const double angle = degrees_of(options.feature_angle) * std::numbers::pi / 180;
  const auto turns = [&](const FlatCap& cap) {
    return turning_share(cap, rims, surface.points, triangles, angle) > Tuning::sharp_share;
  };
  if (!options.open.accept_sheets) {
    // A lid on walls around it closes a body, however low these are.
    std::vector<char> has_lid(rims.size(), 0);
    for (const FlatCap& cap : caps)
      for (const std::size_t r : cap.rims) has_lid[r] = cap.kept && turns(cap);
    require_enclosing(surface.points, triangles, component, rims, has_lid, file);
  }
  double area = 0;
  for (const Triangle& t : triangles) area += area_vector(surface.points, t).norm();
  std::vector<char> closed(rims.size(), 0);
  std::size_t edges = 0;
  std::optional<Vec3> place;
  for (const FlatCap& cap : caps) {
    if (!cap.kept) continue;
    std::vector<const HoleRim*> own;
    for (const std::size_t r : cap.rims) {
      own.push_back(&rims[r]);
      closed[r] = 1;
      edges += rims[r].edges.size();
    }
    if (!place) place = surface.points[own[0]->edges[0][0]];
    SurfaceHole& hole = holes.emplace_back(hole_of(own, cap.triangles, surface.points));
    hole.flat = true;
    hole.size = cap.vector.norm();
    hole.sharp = hole.size >= Tuning::min_sharp_share * area && turns(cap);
    if (hole.sharp && surface.groups.empty()) {
      groups.insert(groups.begin(), SurfaceRegion{});
      surface.groups.assign(surface.triangles.size(), 0);
    }
    if (hole.sharp) {
      hole.group = static_cast<std::uint32_t>(groups.size());
      groups.emplace_back();
    }
    const std::uint32_t group = surface.groups.empty() || hole.sharp
                                    ? hole.group
                                    : group_beside(cap, rims, surface.points, in_surface, surface.groups);
    surface.triangles.insert(surface.triangles.end(), cap.triangles.begin(), cap.triangles.end());
    const std::size_t count = surface.triangles.size();
    surface.two_sided.resize(count, 0);
    surface.even.resize(count, 0);
    if (!surface.groups.empty()) surface.groups.resize(count, group);
  }
  add_finding(findings, DiagnosticCode::holes_closed, "boundary edges of flat holes", edges, place,
              "closed in the planes of their rims");
  for (std::size_t r = 0; r < rims.size(); ++r)
    if (!closed[r]) holes.push_back(open_hole(rims[r], surface.points));
  order_holes(holes);
  return holes;
}

void order_holes(std::vector<SurfaceHole>& holes) {
  std::stable_sort(holes.begin(), holes.end(),
                   [](const SurfaceHole& a, const SurfaceHole& b) { return a.size > b.size; });
  const auto lowest = [](const SurfaceHole& hole, double step) {
    std::array<double, 3> best{INFINITY, INFINITY, INFINITY};
    for (const Vec3& p : hole.points)
      best = std::min(best, {std::round(p.z() / step), std::round(p.y() / step), std::round(p.x() / step)});
    return best;
  };
  for (auto first = holes.begin(); first != holes.end();) {
    const double smallest = (1 - Tuning::equal) * first->size;
    const auto last =
        std::find_if(first, holes.end(), [&](const SurfaceHole& h) { return h.size < smallest; });
    if (const double step = Tuning::equal * std::sqrt(first->size); last - first > 1 && step > 0)
      std::stable_sort(first, last, [&](const SurfaceHole& a, const SurfaceHole& b) {
        return lowest(a, step) < lowest(b, step);
      });
    first = last;
  }
}

void name_holes(std::vector<SurfaceHole>& holes, const std::vector<RegionSeed>& seeds,
                const std::set<std::string>& taken, double diagonal) {
  if (!seeds.empty() && holes.empty())
    throw UsageError("there is no cap to call '" + seeds[0].name +
                     "': the surfaces have no holes; leave out --cap");
  std::vector<Vec3> points;
  std::vector<ProjectionTree::Item> items;
  if (!seeds.empty())
    for (std::uint32_t h = 0; h < holes.size(); ++h) {
      const auto first = static_cast<Index>(points.size());
      points.insert(points.end(), holes[h].points.begin(), holes[h].points.end());
      for (const auto& [a, b, c] : holes[h].triangles)
        items.push_back({{first + a, first + b, first + c}, {h, 0, 0}});
    }
  const ProjectionTree tree(std::move(points), std::move(items));
  std::set<std::string> used = taken;
  std::map<std::size_t, const RegionSeed*> named;
  for (const RegionSeed& seed : seeds) {
    const std::string what = "the cap '" + seed.name + "' at " + place_text(seed.point);
    const auto hit = tree.nearest_of(seed.point, std::numeric_limits<double>::infinity(),
                                     [](const ProjectionTree::Item&) { return true; });
    if (!hit) throw UsageError(what + " is near no hole; choose another point");
    const double distance = (hit->point - seed.point).norm();
    if (distance > Tuning::near * diagonal)
      throw UsageError(what + " is " + short_number(distance) + " from the nearest cap, at " +
                       place_text(hit->point) + ", and at most " + short_number(Tuning::near * diagonal) +
                       " is near; choose a point on the cap");
    const std::size_t hole = tree.items()[hit->item].kind[0];
    const auto [known, added] = named.insert({hole, &seed});
    if (!added && known->second->name != seed.name)
      throw UsageError(what + " is the same as '" + known->second->name + "' at " +
                       place_text(known->second->point) + "; leave one of them out");
    if (added && !used.insert(seed.name).second)
      throw UsageError(what + ": another patch has this name; choose another one");
    holes[hole].name = seed.name;
  }
  std::size_t next = 1;
  for (std::size_t h = 0; h < holes.size(); ++h) {
    if (named.contains(h)) {
      ++next;
      continue;
    }
    std::string name;
    do name = "cap_" + std::to_string(next++);
    while (!used.insert(name).second);
    holes[h].name = std::move(name);
  }
}

}  // namespace tetwright
