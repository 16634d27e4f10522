// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/open_surfaces.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/message_text.h"
#include "mesher/input/height_block.h"
#include "mesher/input/surface_cleaning.h"
#include "mesher/input/thick_sheet.h"
#include "mesher/tuning/input_tuning.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

using OpenTuning = InputTuning::OpenSurfaces;

OrientedSurface orient(const MaterialSurface& from, std::vector<Diagnostic>& findings) {
  CleanedSurface cleaned = clean_surface(from.surface, from.file, findings);
  const std::vector<SurfaceComponent> components =
      split_into_components(cleaned.points, cleaned.triangles, cleaned.two_sided, from.file, findings);
  OrientedSurface s;
  s.names.emplace_back();
  s.names.insert(s.names.end(), from.surface.groups.begin(), from.surface.groups.end());
  for (Index c = 0; c < components.size(); ++c) {
    s.closed.push_back(components[c].closed);
    for (const Index t : components[c].triangles)
      s.add(cleaned.triangles[t], c, cleaned.groups.empty() ? 0 : cleaned.groups[t] + 1);
  }
  s.points = keep_used(cleaned.points, s.triangles);
  return s;
}

bool is_open(const OrientedSurface& s) {
  return std::any_of(s.closed.begin(), s.closed.end(), [](char closed) { return closed == 0; });
}

}  // namespace

std::uint32_t OrientedSurface::group(const std::string& name) {
  const auto known =
      std::find_if(names.begin(), names.end(), [&](const SurfaceRegion& r) { return r.name == name; });
  const auto found = static_cast<std::uint32_t>(known - names.begin());
  if (known == names.end()) names.push_back({0, name});
  return found;
}

void OrientedSurface::name_open(const std::string& name) {
  const std::uint32_t own = group(name);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (!closed[component[t]] && !names[groups[t]]) groups[t] = own;
}

void OrientedSurface::add(const Triangle& triangle, Index own_component, std::uint32_t own_group) {
  triangles.push_back(triangle);
  component.push_back(own_component);
  groups.push_back(own_group);
}

void close_open_surfaces(std::vector<MaterialSurface>& surfaces, const OpenSurfaceOptions& options,
                         std::vector<Diagnostic>& findings) {
  if (!options.base && !options.thickness) return;
  if (options.base && options.thickness)
    throw UsageError(
        "--base and --thicken are two ways to make a body of an open surface; leave one of them out");
  if (options.thickness && !(*options.thickness > 0 && std::isfinite(*options.thickness)))
    throw UsageError("the thickness of a shell must be above 0, not " + short_number(*options.thickness));
  bool any = false;
  for (MaterialSurface& from : surfaces) {
    std::vector<Diagnostic> own;
    OrientedSurface s = orient(from, own);
    if (!is_open(s)) continue;
    any = true;
    own.push_back(options.base ? add_base(s, from.file, *options.base)
                               : thicken(s, from.file, *options.thickness));
    // Its rim is no hole.
    std::erase_if(own, [](const Diagnostic& d) { return d.code == DiagnosticCode::holes_closed; });
    for (Diagnostic& finding : own) {
      finding.file = from.file;
      findings.push_back(std::move(finding));
    }
    from.surface = {std::move(s.points), std::move(s.triangles), std::move(s.names), std::move(s.groups)};
  }
  if (!any)
    throw UsageError(std::string(options.base ? "--base" : "--thicken") +
                     " is for open surfaces, and all of the input are closed; leave it out");
}

void require_enclosing(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles,
                       const std::vector<Index>& component, const std::vector<HoleRim>& rims,
                       const std::vector<char>& has_lid, const std::string& file) {
  struct Extent {
    std::size_t triangles = 0;
    double area = 0;
    Vec3 holes = Vec3::Zero();  // sum of area times normal
    const HoleRim* largest = nullptr;
    bool has_lid = false;  // on the largest
  };
  std::vector<Extent> extents;
  double area = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (component[t] >= extents.size()) extents.resize(component[t] + 1);
    const double own = area_vector(points, triangles[t]).norm();
    extents[component[t]].area += own;
    ++extents[component[t]].triangles;
    area += own;
  }
  for (std::size_t r = 0; r < rims.size(); ++r) {
    Extent& e = extents[component[rims[r].at_triangle[0]]];
    e.holes += rims[r].vector;
    if (e.largest && !(rims[r].vector.norm() > e.largest->vector.norm())) continue;
    e.largest = &rims[r];
    e.has_lid = has_lid[r] != 0;
  }
  double in_sheets = 0;
  const Extent* first = nullptr;
  for (const Extent& e : extents) {
    // Triangles on their own form no surface at all.
    if (!e.largest || e.has_lid || e.triangles < 2) continue;
    const double hole = e.largest->vector.norm();
    if (hole <= OpenTuning::max_cap_share * e.area ||
        e.holes.norm() < OpenTuning::min_one_sided_share * std::min(hole, e.area))
      continue;
    in_sheets += e.area;
    if (!first || e.area > first->area) first = &e;
  }
  if (!first || in_sheets <= OpenTuning::min_sheet_share * area) return;
  const double percent = std::round(100 * first->largest->vector.norm() / first->area);
  throw InputError(
      file, 0,
      "encloses nothing: it is an open sheet, whose hole, with a rim at " +
          place_text(points[first->largest->edges[0][0]]) + ", is " + short_number(percent) +
          " % as large as its surface; use --base auto for walls and a flat base below it, --thicken D "
          "for a shell, or --accept-changes to close it by the smallest cap");
}

}  // namespace tetwright
