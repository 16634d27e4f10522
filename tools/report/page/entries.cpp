// SPDX-License-Identifier: Apache-2.0
#include "tools/report/page/entries.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/geometry/predicates.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/resources.h"
#include "tools/report/page/html_text.h"

namespace tetwright {

namespace {

constexpr double no_value = std::numeric_limits<double>::infinity();

PageEntry entry_of(const Diagnostic& d) {
  std::string text = d.count > 0 ? std::to_string(d.count) + " " + d.what : d.what;
  if (d.severity == Severity::note && !d.file.empty()) text.insert(0, d.file + ": ");
  return {std::move(text), d.done.empty() ? d.remedy : d.done, d.places, &kind_of(d.code)};
}

void add(const std::vector<Diagnostic>& diagnostics, PageEntries& entries) {
  for (const Diagnostic& d : diagnostics) {
    const bool is_found = d.severity == Severity::note || d.severity == Severity::warning;
    (is_found ? entries.found : entries.short_of).push_back(entry_of(d));
  }
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

PageEntries page_entries(const PrepareReport& run, const TetMesh& mesh, const CheckReport* check) {
  PageEntries entries;
  add(run.diagnostics, entries);
  if (check) add(diagnostics_of(*check), entries);
  if (!mesh.tets.empty()) add_worst(mesh, entries);
  return entries;
}

}  // namespace tetwright
