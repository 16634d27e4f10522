// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/body_contacts.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include "common/message_text.h"
#include "mesher/complex/labelled_complex.h"
#include "mesher/input/contact_groups.h"
#include "mesher/input/surface_measures.h"
#include "mesher/tuning/complex_tuning.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

bool is_closed(const RepairedSurface& s) { return s.closed == s.triangles.size(); }

/// All bodies' surfaces; points of different bodies stay apart.
SurfaceSoup soup_of(const MesherInput& input) {
  SurfaceSoup soup;
  for (std::size_t b = 0; b < input.bodies.size(); ++b) {
    const RepairedSurface& s = input.bodies[b].surface;
    const auto first = static_cast<Index>(soup.points.size());
    soup.points.insert(soup.points.end(), s.points.begin(), s.points.end());
    for (const Triangle& t : s.triangles) {
      soup.triangles.push_back({first + t[0], first + t[1], first + t[2]});
      soup.surface.push_back(static_cast<std::uint32_t>(b));
    }
  }
  return soup;
}

bool boxes_meet(const MesherInput& input, double tolerance) {
  for (std::size_t a = 0; a < input.bodies.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) {
      const RepairedSurface &s = input.bodies[a].surface, &t = input.bodies[b].surface;
      if ((s.low.array() <= t.high.array() + tolerance).all() &&
          (t.low.array() <= s.high.array() + tolerance).all())
        return true;
    }
  return false;
}

/// Replaces a body's surface by its part of the complex.
void take_surface(MesherInput::Body& body, const std::vector<Vec3>& points,
                  const std::vector<Triangle>& triangles, const std::vector<Index>& sources,
                  Index first_source) {
  RepairedSurface s;
  s.intersects_itself = body.surface.intersects_itself;
  std::vector<Index> number(points.size(), no_index);
  for (Triangle t : triangles) {
    for (Index& p : t) {
      if (number[p] == no_index) {
        number[p] = static_cast<Index>(s.points.size());
        s.points.push_back(points[p]);
      }
      p = number[p];
    }
    s.triangles.push_back(t);
  }
  if (!body.surface.groups.empty()) {
    const auto none = static_cast<std::uint32_t>(body.groups.size());
    body.groups.emplace_back();
    for (const Index source : sources)
      s.groups.push_back(source == no_index ? none : body.surface.groups[source - first_source]);
  }
  s.closed = s.triangles.size();
  measure_surface(s);
  body.surface = std::move(s);
}

/// Reports that two bodies cross, or refuses it.
void add_overlap(const BodyOverlap& overlap, OverlapRule rule, MesherInput& input) {
  const MesherInput::Body &first = input.bodies[overlap.first], &second = input.bodies[overlap.second];
  std::string names = "'";
  names.append(first.name).append("' and '").append(second.name).append("'");
  const std::string volume = short_number(overlap.volume);
  if (rule == OverlapRule::error)
    throw InputError(second.file, 0,
                     "the bodies " + names + " cross at " + place_text(overlap.place) +
                         ": both claim a volume of " + volume +
                         "; separate them, or let the later one keep it with --on-overlap later");
  const std::string owner = rule == OverlapRule::later   ? second.name
                            : rule == OverlapRule::first ? first.name
                                                         : first.name + "+" + second.name;
  input.overlaps.push_back({first.name, second.name, overlap.volume, owner, overlap.place});
  input.findings.push_back({.code = DiagnosticCode::bodies_overlap,
                            .file = second.file,
                            .what = "bodies that cross: " + names + " both claim a volume of " + volume,
                            .done = "it belongs to '" + owner + "'",
                            .places = {overlap.place}});
}

/// Reports the parts of sheets that are not faces of the complex.
/// \throws InputError for a sheet without a face in it
void report_sheets(const std::vector<SheetFate>& fates, MesherInput& input) {
  for (std::size_t k = 0; k < fates.size(); ++k) {
    const SheetFate& fate = fates[k];
    const MesherInput::Sheet& sheet = input.sheets[k];
    const std::string name = "the sheet '" + sheet.group.name + "'";
    if (fate.kept == 0 && fate.on_faces.area > 0)
      throw InputError(sheet.file, 0,
                       name + " lies on the boundary of a body, at " + place_text(fate.on_faces.place) +
                           ", and not inside; to name faces of the boundary, give the body's surface named "
                           "groups");
    if (fate.kept == 0 && fate.outside.area > 0)
      throw InputError(sheet.file, 0,
                       name + " is in no body, the largest triangle at " + place_text(fate.outside.place) +
                           "; check its units and position, or leave it out");
    if (fate.kept == 0)
      throw InputError(
          sheet.file, 0,
          name + " lies on another sheet, at " + place_text(fate.repeated.place) + "; leave one of them out");
    const auto note = [&](DiagnosticCode code, const SheetLoss& loss, const char* where) {
      if (!(loss.area > 0)) return;
      input.findings.push_back(
          {.code = code,
           .file = sheet.file,
           .what = "a part of " + name + " " + where + ", with an area of " + short_number(loss.area),
           .done = "left out",
           .places = {loss.place}});
    };
    note(DiagnosticCode::sheet_cut_off, fate.outside, "outside all bodies");
    note(DiagnosticCode::sheet_on_faces, fate.on_faces, "on the boundary of a body");
    note(DiagnosticCode::sheet_on_faces, fate.repeated, "on another sheet");
  }
}

MaterialTag free_tag(const MesherInput& input) {
  std::set<MaterialTag> used;
  for (const MesherInput::Body& body : input.bodies) used.insert(body.tag);
  for (const MaterialLayer& layer : input.layers) used.insert(layer.tag);
  MaterialTag tag = 1;
  while (used.contains(tag)) ++tag;
  return tag;
}

/// Appends a body for each volume that several bodies have in common.
void add_common_volumes(const ComplexResult& found, MesherInput& input) {
  std::set<std::string> names;
  for (const MesherInput::Body& body : input.bodies) names.insert(body.name);
  for (const std::vector<std::size_t>& owners : found.common) {
    std::string name;
    for (const std::size_t b : owners) name += (name.empty() ? "" : "+") + input.bodies[b].name;
    const std::string& file = input.bodies[owners.back()].file;
    if (!names.insert(name).second)
      throw UsageError("the volume in which bodies cross would be called '" + name +
                       "' like another body; rename that one, or choose another rule for --on-overlap");
    input.bodies.push_back({name, free_tag(input), file, {}, {}});
  }
}

}  // namespace

double contact_tolerance(const ContactOptions& options, double diagonal) {
  const double tolerance = options.tolerance.value_or(options.relative_tolerance * diagonal);
  if (!(tolerance > 0 && std::isfinite(tolerance)))
    throw UsageError("the contact tolerance must be above 0, not " + short_number(tolerance));
  return tolerance;
}

void require_larger_than_tolerance(double size, double tolerance, const std::string& name,
                                   const std::string& file) {
  if (size < ComplexTuning::Contact::min_body * tolerance)
    throw InputError(file, 0,
                     "the contact tolerance of " + short_number(tolerance) + " is too large for '" + name +
                         "', which is only " + short_number(size) +
                         " across; use a smaller --contact-tolerance");
}

void join_bodies(MesherInput& input, const SheetSoup& sheets, const ContactOptions& options,
                 Progress* progress) {
  const double tolerance = contact_tolerance(options, (input.high - input.low).norm());
  if (sheets.empty() && (input.bodies.size() < 2 || !boxes_meet(input, tolerance))) return;
  const auto not_joined = [&](const std::string& file, const std::string& why, const Vec3& place) {
    if (!sheets.empty())
      throw InputError(file, 0,
                       "the sheet '" + input.sheets[0].group.name +
                           "' cannot be joined with this surface, at " + place_text(place) + ": " + why +
                           "; repair the surface, or leave the sheet out");
    input.findings.push_back({.code = DiagnosticCode::bodies_not_joined,
                              .file = file,
                              .what = "surfaces that meet are not joined",
                              .done = why,
                              .places = {place}});
  };
  for (const MesherInput::Body& body : input.bodies)
    require_larger_than_tolerance((body.surface.high - body.surface.low).norm(), tolerance, body.name,
                                  body.file);
  SurfaceSoup soup = soup_of(input);
  SoupSheets in_soup;
  in_soup.count = input.sheets.size();
  if (!sheets.empty()) sheets.append_to(soup, static_cast<std::uint32_t>(input.bodies.size()), in_soup.sheet);
  const ImprintedSurfaces imprinted = imprint_surfaces(soup, tolerance, progress);
  if (!imprinted.any && sheets.empty()) return;
  for (const MesherInput::Body& body : input.bodies)
    if (!is_closed(body.surface)) {
      not_joined(body.file, "its surface is open; contacts are accurate to a cell", body.surface.points[0]);
      return;
    }
  if (imprinted.too_many_points)
    throw InputError(input.bodies.back().file, 0,
                     "at " + place_text(*imprinted.unresolved) +
                         " surfaces meet so often that cutting them does not end with the contact tolerance "
                         "of " +
                         short_number(tolerance) +
                         "; use a smaller --contact-tolerance, or repair the surfaces there");
  if (imprinted.unresolved) {
    not_joined(input.bodies.back().file,
               "their facets there are about as small as the contact tolerance of " +
                   short_number(tolerance) + "; contacts are accurate to a cell",
               *imprinted.unresolved);
    return;
  }
  ComplexResult found =
      build_complex(imprinted, soup, input.bodies.size(), tolerance, options.overlap, in_soup, progress);
  input.joined_bytes = found.peak_bytes;
  if (found.inconsistent) {
    not_joined(input.bodies.back().file, "a surface crosses itself there; contacts are accurate to a cell",
               *found.inconsistent);
    return;
  }
  if (found.torn) {
    const MesherInput::Body& body = input.bodies[*found.torn];
    not_joined(body.file,
               "'" + body.name + "' would lose or gain more volume than the contact tolerance of " +
                   short_number(tolerance) + " explains; use a smaller --contact-tolerance",
               body.surface.points[0]);
    return;
  }
  // Meshing refuses a body that later ones cover as a whole.
  if (std::count(found.lost.begin(), found.lost.end(), 1) > 0) return;
  report_sheets(found.sheets, input);
  for (const BodyOverlap& o : found.overlaps) add_overlap(o, options.overlap, input);
  add_common_volumes(found, input);
  for (const BodyContact& c : found.contacts)
    input.contacts.push_back({input.bodies[c.first].name, input.bodies[c.second].name, c.area, c.pieces,
                              c.largest_gap, c.largest_overlap});
  Index first_source = 0;
  for (std::size_t b = 0; b < input.bodies.size(); ++b) {
    const auto count = static_cast<Index>(input.bodies[b].surface.triangles.size());
    take_surface(input.bodies[b], imprinted.points, found.body_triangles[b], found.body_sources[b],
                 first_source);
    first_source += count;
  }
  input.complex = std::make_shared<const LabelledComplex>(std::move(found.complex));
  if (!input.groups.empty()) name_contact_groups(input);
}

}  // namespace tetwright
