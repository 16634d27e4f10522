// SPDX-License-Identifier: Apache-2.0
#include "tetwright/mesher_input.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "common/geometry/measurable.h"
#include "common/message_text.h"
#include "mesher/input/body_builder.h"
#include "mesher/input/body_contacts.h"
#include "mesher/input/open_surfaces.h"
#include "mesher/input/patch_joining.h"
#include "mesher/input/qualified_names.h"
#include "mesher/input/self_crossings.h"
#include "mesher/input/sheet_surfaces.h"
#include "mesher/tuning/input_tuning.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

/// The tags assigned by the caller. Throws UsageError for a layer without a thickness.
std::set<MaterialTag> tags_in_use(const std::vector<MaterialSurface>& surfaces,
                                  const std::vector<MaterialLayer>& layers) {
  std::set<MaterialTag> tags;
  for (const MaterialSurface& s : surfaces) tags.insert(s.tag);
  for (const MaterialLayer& l : layers) {
    if (!(l.thickness > 0 && std::isfinite(l.thickness)))
      throw UsageError("the layer '" + l.name + "' must have a thickness above 0, not " +
                       short_number(l.thickness));
    tags.insert(l.tag);
  }
  return tags;
}

/// Makes the names of groups unique across surfaces (see qualify_names()). Groups that have only a number are
/// named after their surface.
void name_groups(std::vector<MaterialSurface>& surfaces, std::vector<Diagnostic>& findings) {
  const auto with_groups = std::count_if(surfaces.begin(), surfaces.end(),
                                         [](const MaterialSurface& s) { return !s.surface.groups.empty(); });
  if (with_groups < 2) return;
  std::vector<NamesOfBody> bodies;
  for (const MaterialSurface& s : surfaces) {
    bodies.push_back({s.name, s.file, {}});
    for (const SurfaceRegion& group : s.surface.groups)
      if (!group.name.empty()) bodies.back().names[group.name] = group.name;
  }
  UniqueNames unique([](const std::string& name) { return name; });
  qualify_names("names of patches", bodies, unique, findings);
  for (std::size_t i = 0; i < surfaces.size(); ++i)
    for (SurfaceRegion& group : surfaces[i].surface.groups)
      if (!group.name.empty())
        group.name = bodies[i].names.at(group.name);
      else if (group)
        group = {0, unique.add(surfaces[i].name + "_" + std::to_string(group.number))};
}

/// The area and centre of each group with triangles, ignoring triangles with missing points.
std::vector<MesherInput::Group> measure_groups(const std::vector<MaterialSurface>& surfaces) {
  std::map<SurfaceRegion, MesherInput::Group> measured;
  std::map<SurfaceRegion, double> largest;
  for (const MaterialSurface& s : surfaces)
    for (std::size_t t = 0; t < s.surface.triangle_groups.size(); ++t) {
      const SurfaceRegion& group = s.surface.groups[s.surface.triangle_groups[t]];
      const Triangle& corners = s.surface.triangles[t];
      const std::vector<Vec3>& points = s.surface.points;
      if (!group || std::any_of(corners.begin(), corners.end(), [&](Index p) { return p >= points.size(); }))
        continue;
      const Vec3 &a = points[corners[0]], &b = points[corners[1]], &c = points[corners[2]];
      const double area = (b - a).cross(c - a).norm() / 2;
      MesherInput::Group& own = measured.try_emplace(group, MesherInput::Group{group, 0, a}).first->second;
      own.area += area;
      double& max_area = largest[group];
      if (!(area > max_area)) continue;
      max_area = area;
      own.place = (a + b + c) / 3;
    }
  std::vector<MesherInput::Group> groups;
  groups.reserve(measured.size());
  for (auto& [group, own] : measured) groups.push_back(std::move(own));
  return groups;
}

void find_bounding_box(MesherInput& input) {
  input.low = input.bodies[0].surface.low;
  input.high = input.bodies[0].surface.high;
  for (const MesherInput::Body& b : input.bodies) {
    input.low = input.low.cwiseMin(b.surface.low);
    input.high = input.high.cwiseMax(b.surface.high);
  }
}

/// Throws UsageError for too many materials and for two of one name or tag.
void validate_materials(const MesherInput& input) {
  if (input.bodies.size() + input.layers.size() > InputTuning::Limits::max_materials)
    throw UsageError(std::to_string(input.bodies.size() + input.layers.size()) +
                     " materials are too many; at most " +
                     std::to_string(InputTuning::Limits::max_materials) + " can be meshed at a time");
  std::vector<std::pair<std::string, MaterialTag>> all;
  for (const MesherInput::Body& b : input.bodies) all.emplace_back(b.name, b.tag);
  for (const MaterialLayer& l : input.layers) all.emplace_back(l.name, l.tag);
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      if (!all[i].first.empty() && all[i].first == all[k].first)
        throw UsageError("two materials are called '" + all[i].first +
                         "'; give one another name with --material NAME=FILE");
      if (all[i].second == all[k].second)
        throw UsageError("two materials have the tag " + std::to_string(all[i].second));
    }
}

/// Joins bodies and sheets, together with walls of their files.
/// \return false, with a note why in place of those that keep the walls, if that fails; nothing else has
///   changed then
bool join_with_walls(MesherInput& input, const SheetSoup& inner, const std::vector<SheetSurface>& walls,
                     const ContactOptions& contact, Progress* progress) {
  MesherInput joined = input;
  SheetSoup all = inner;
  try {
    for (const SheetSurface& s : walls) all.add(s, joined.sheets, joined.findings);
    join_bodies(joined, all, contact, progress);
  } catch (const InputError& e) {
    std::erase_if(input.findings,
                  [](const Diagnostic& d) { return d.code == DiagnosticCode::walls_kept_as_sheets; });
    for (const SheetSurface& s : walls)
      input.findings.push_back({.code = DiagnosticCode::inner_walls_dropped,
                                .file = s.file,
                                .what = "walls of zero thickness, after all",
                                .done = "left out: " + std::string(e.what()),
                                .places = {s.surface.points[0]}});
    return false;
  }
  input = std::move(joined);
  return true;
}

}  // namespace

double longest_side(const MesherInput& input) { return (input.high - input.low).maxCoeff(); }

double largest_coordinate(const MesherInput& input) {
  return std::max(input.low.cwiseAbs().maxCoeff(), input.high.cwiseAbs().maxCoeff());
}

MesherInput make_mesher_input(std::vector<MaterialSurface> surfaces, std::vector<MaterialLayer> layers,
                              NestedRule nested, const ContactOptions& contact, const RegionOptions& regions,
                              Progress* progress, const SheetOptions& sheets, const CapOptions& caps) {
  if (surfaces.empty()) throw UsageError("there is no surface to mesh");
  MesherInput input;
  input.space = surfaces.front().surface.space;
  close_open_surfaces(surfaces, caps.open, input.findings);
  std::map<std::size_t, WalledSurface> joined = join_patches(surfaces, contact, input.findings, progress);
  name_groups(surfaces, input.findings);
  input.groups = measure_groups(surfaces);
  std::set<MaterialTag> tags = tags_in_use(surfaces, layers);
  input.layers = std::move(layers);
  BodyBuilder builder(input, std::move(tags), contact, caps, progress);
  builder.set_joined(std::move(joined));
  std::vector<Partition> partitions;
  const WallApproach walls =
      sheets.extend > 0 ? WallApproach(surfaces, sheets.surfaces) : WallApproach({}, {});
  for (const SheetSurface& s : sheets.surfaces)
    if (s.divides) partitions.push_back(make_partition(s, sheets.extend, walls, input.findings));
  std::set<std::string> names;
  for (const SheetSurface& s : sheets.surfaces) names.insert(s.name);
  builder.add(std::move(surfaces), nested, regions.rule, partitions, std::move(names));
  builder.name(regions.seeds);
  find_bounding_box(input);
  validate_materials(input);
  require_measurable(longest_side(input), largest_coordinate(input), "surface", input.bodies[0].file);
  SheetSoup inner;
  for (const SheetSurface& s : sheets.surfaces)
    if (!s.divides) inner.add(s, input.sheets, input.findings);
  if (!inner.empty() && !input.layers.empty())
    throw UsageError("sheets and layers cannot be combined: a sheet would end at the layer '" +
                     input.layers[0].name + "'; leave out one of them, or give the layer as a surface");
  const double tolerance = contact_tolerance(contact, (input.high - input.low).norm());
  for (MesherInput::Body& body : input.bodies) resolve_self_crossings(body, tolerance, progress);
  if (!builder.walls().empty() && join_with_walls(input, inner, builder.walls(), contact, progress))
    return input;
  join_bodies(input, inner, contact, progress);
  return input;
}

}  // namespace tetwright
