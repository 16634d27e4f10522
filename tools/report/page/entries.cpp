// SPDX-License-Identifier: Apache-2.0
#include "tools/report/page/entries.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/geometry/predicates.h"
#include "common/geometry/quality.h"
#include "common/parallel/parallel.h"
#include "tools/app/printed_report.h"
#include "tools/report/page/html_text.h"

namespace tetwright {

namespace {

constexpr double no_value = std::numeric_limits<double>::infinity();

PageEntry entry_of(const InputFinding& f) {
  PageEntry entry{f.file + ": " + std::to_string(f.finding.count) + " " + f.finding.what, f.finding.done, {}};
  if (f.finding.place) entry.places.push_back(*f.finding.place);
  return entry;
}

void add_check(const CheckReport& check, PageEntries& entries) {
  for (const MeshFinding& f : check.findings) {
    PageEntry entry{mesh_finding_line(f), "", {}};
    for (const MeshPlace& place : f.places)
      if (place.at) entry.places.push_back(*place.at);
    (is_warning(f.fault) ? entries.found : entries.short_of).push_back(std::move(entry));
  }
  if (check.topology_differences)
    for (const std::string& difference : *check.topology_differences)
      entries.short_of.push_back({"topology differs: " + difference, "", {}});
}

/// The smallest value of any tet, and the first tet that has it.
using Worst = std::pair<double, std::size_t>;

/// `value` is asked for the corners of each tet.
template <class Value>
Worst worst_tet(const TetMesh& mesh, const Value& value) {
  constexpr std::size_t grain = 1 << 14;
  std::vector<Worst> parts((mesh.tets.size() + grain - 1) / grain, Worst(no_value, 0));
  parallel_chunks(parts.size(), [&](std::size_t part, unsigned) {
    const std::size_t last = std::min(mesh.tets.size(), (part + 1) * grain);
    for (std::size_t t = part * grain; t < last; ++t) {
      const Tet& v = mesh.tets[t];
      const std::array<Vec3, 4> x{mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]], mesh.points[v[3]]};
      parts[part] = std::min(parts[part], Worst(value(x), t));
    }
  });
  return *std::min_element(parts.begin(), parts.end());
}

Vec3 centre(const TetMesh& mesh, std::size_t t) {
  Vec3 sum = Vec3::Zero();
  for (const Index p : mesh.tets[t]) sum += mesh.points[p] / 4;
  return sum;
}

void add_worst(const TetMesh& mesh, PageEntries& entries) {
  const auto [solid, of_solid] = worst_tet(mesh, [](const std::array<Vec3, 4>& x) {
    // As mesh_statistics() counts it.
    return orient3d(x[0], x[1], x[2], x[3]) > 0 ? min_solid_angle(x[0], x[1], x[2], x[3]) : 0.0;
  });
  const auto [largest, of_largest] = worst_tet(mesh, [](const std::array<Vec3, 4>& x) {
    const std::array<double, 6> angles = dihedral_angles(x);
    const double angle = *std::max_element(angles.begin(), angles.end());
    return std::isnan(angle) ? no_value : -angle;
  });
  constexpr int angle_decimals = 4;
  entries.worst.push_back({"The smallest solid angle, " + fixed_number(solid, angle_decimals) + " sr",
                           "",
                           {centre(mesh, of_solid)}});
  if (std::isfinite(largest))
    entries.worst.push_back({"The largest dihedral angle, " + fixed_number(-largest, 1) + " degrees",
                             "",
                             {centre(mesh, of_largest)}});
}

}  // namespace

PageEntries page_entries(const RunReport& run, const TetMesh& mesh, const CheckReport* check) {
  PageEntries entries;
  for (const Shortfall& s : run.shortfall) entries.short_of.push_back({s.message, "", s.places});
  for (const InputFinding& f : run.findings) entries.found.push_back(entry_of(f));
  for (const RunNote& note : further_notes(run))
    entries.found.push_back(
        {note.text, "", note.place ? std::vector<Vec3>{*note.place} : std::vector<Vec3>{}});
  if (check) add_check(*check, entries);
  if (!mesh.tets.empty()) add_worst(mesh, entries);
  return entries;
}

}  // namespace tetwright
