// SPDX-License-Identifier: Apache-2.0
#include "tetwright/mesher_input.h"

#include <algorithm>
#include <utility>

#include "common/features/edge_uses.h"
#include "common/geometry/self_intersection.h"
#include "common/message_text.h"
#include "mesher/input/surface_cleaning.h"
#include "mesher/input/surface_components.h"
#include "mesher/input/surface_measures.h"
#include "mesher/input/surface_nesting.h"
#include "mesher/tuning/input_tuning.h"
#include "tetwright/error.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

/// Assembles a surface from the chosen components, closed ones first.
/// \param crossing by triangle, 1 if it intersects another one
RepairedSurface assemble(const CleanedSurface& from, const std::vector<SurfaceComponent>& components,
                         const std::vector<char>& crossing, const std::vector<Index>& chosen) {
  RepairedSurface s;
  for (const bool closed : {true, false}) {
    for (Index c : chosen)
      if (components[c].closed == closed)
        for (Index t : components[c].triangles) {
          s.triangles.push_back(from.triangles[t]);
          if (!from.groups.empty()) s.groups.push_back(from.groups[t]);
          s.intersects_itself |= crossing[t] != 0;
        }
    if (closed) s.closed = s.triangles.size();
  }
  s.points = keep_used(from.points, s.triangles);
  measure_surface(s);
  return s;
}

/// True for triangles that cross each other although none of their corners are close: not just neighbours
/// whose common points were rounded.
bool are_tangled(const CleanedSurface& s, Index f, Index g) {
  const Vec3& apex = s.points[s.triangles[f][0]];
  double size = 0;
  for (const Index p : s.triangles[f]) size = std::max(size, (s.points[p] - apex).norm());
  for (const Index p : s.triangles[f])
    for (const Index q : s.triangles[g])
      if ((s.points[p] - s.points[q]).norm() < InputTuning::Soups::close * size) return false;
  return true;
}

/// \throws InputError for triangles that form no surface: most share no edge with another, and they cross
///   everywhere. Distances from such triangles mean nothing, and all of space would be thin walls.
void refuse_soup(const CleanedSurface& s, const std::vector<std::pair<Index, Index>>& crossing,
                 const std::string& file) {
  if (crossing.size() < s.triangles.size()) return;
  const std::vector<EdgeUse> uses = edge_uses(s.triangles, {});
  std::vector<char> connected(s.triangles.size(), 0);
  for (std::size_t i = 1; i < uses.size(); ++i)
    if (uses[i].key == uses[i - 1].key) connected[uses[i].triangle] = connected[uses[i - 1].triangle] = 1;
  const auto loose = static_cast<std::size_t>(std::count(connected.begin(), connected.end(), 0));
  if (2 * loose < s.triangles.size()) return;
  const auto tangled =
      static_cast<std::size_t>(std::count_if(crossing.begin(), crossing.end(), [&](const auto& pair) {
        return are_tangled(s, pair.first, pair.second);
      }));
  if (tangled < s.triangles.size()) return;
  throw InputError(file, 0,
                   "the triangles form no surface: " + std::to_string(loose) + " of " +
                       std::to_string(s.triangles.size()) + " share no edge with another, and " +
                       std::to_string(tangled) + " pairs cross, one at " +
                       place_text(s.points[s.triangles[crossing[0].first][0]]) +
                       "; give a surface of connected triangles");
}

}  // namespace

void measure_surface(RepairedSurface& s) {
  s.low = s.high = s.points[0];
  for (const Vec3& p : s.points) s.low = s.low.cwiseMin(p), s.high = s.high.cwiseMax(p);
  const Vec3 apex = 0.5 * s.low + 0.5 * s.high;
  const auto sum = [&](auto&& of_triangle) {
    return parallel_sum(0, s.triangles.size(), InputGrains::triangles,
                        [&](std::size_t begin, std::size_t end) {
                          double total = 0;
                          for (std::size_t t = begin; t < end; ++t) {
                            const auto& [a, b, c] = s.triangles[t];
                            total += of_triangle(s.points[a], s.points[b], s.points[c]);
                          }
                          return total;
                        });
  };
  s.area = sum([](const Vec3& a, const Vec3& b, const Vec3& c) { return 0.5 * (b - a).cross(c - a).norm(); });
  s.volume = sum([&](const Vec3& a, const Vec3& b, const Vec3& c) {
    return (a - apex).dot((b - apex).cross(c - apex)) / 6;
  });
}

SurfaceRepair repair_surface(const TriangleMesh& surface, const std::string& file, NestedRule nested) {
  std::vector<Diagnostic> findings;
  CleanedSurface cleaned = clean_surface(surface, file, findings);
  return repair_cleaned(std::move(cleaned), file, nested, std::move(findings));
}

SurfaceRepair repair_cleaned(CleanedSurface cleaned, const std::string& file, NestedRule nested,
                             std::vector<Diagnostic> findings) {
  SurfaceRepair result;
  result.findings = std::move(findings);
  const std::vector<SurfaceComponent> components =
      split_into_components(cleaned.points, cleaned.triangles, cleaned.two_sided, file, result.findings);
  const auto crossing = self_intersections(cleaned.points, cleaned.triangles);
  refuse_soup(cleaned, crossing, file);
  if (!crossing.empty())
    add_finding(result.findings, DiagnosticCode::surface_self_intersects, "pairs of triangles that intersect",
                crossing.size(), cleaned.points[cleaned.triangles[crossing[0].first][0]],
                "kept; points inside any part count as inside");
  const ArrangedComponents arranged =
      arrange_components(cleaned.points, cleaned.triangles, components, crossing, nested, result.findings);
  std::vector<char> elsewhere = arranged.redundant;
  for (Index c : arranged.nested) elsewhere[c] = 1;
  std::vector<Index> chosen;
  for (Index c = 0; c < components.size(); ++c) {
    if (!elsewhere[c]) chosen.push_back(c);
    if (arranged.turn[c])
      for (Index t : components[c].triangles) std::swap(cleaned.triangles[t][1], cleaned.triangles[t][2]);
  }
  std::vector<char> crosses(cleaned.triangles.size(), 0);
  for (const auto& [f, g] : crossing) crosses[f] = crosses[g] = 1;
  result.surface = assemble(cleaned, components, crosses, chosen);
  for (Index c : arranged.nested) result.nested.push_back(assemble(cleaned, components, crosses, {c}));
  return result;
}

}  // namespace tetwright
