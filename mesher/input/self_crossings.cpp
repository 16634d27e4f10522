// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/self_crossings.h"

#include <utility>

#include "common/geometry/self_intersection.h"
#include "mesher/complex/labelled_complex.h"
#include "mesher/complex/surface_imprint.h"
#include "mesher/input/surface_cleaning.h"
#include "mesher/input/surface_measures.h"

namespace tetwright {

bool resolve_self_crossings(MesherInput::Body& body, double tolerance, Progress* progress) {
  const RepairedSurface& from = body.surface;
  if (!from.intersects_itself || from.closed != from.triangles.size()) return false;
  const SurfacePatches patches = find_patches(from.points, from.triangles, {}, from.groups, body.file);
  if (patches.verdict != SurfacePatches::Verdict::part) return false;

  SurfaceSoup by_patch{from.points, from.triangles, {}};
  by_patch.surface.assign(patches.patches.begin(), patches.patches.end());
  const ImprintedSurfaces imprinted = imprint_surfaces(by_patch, tolerance, progress);
  if (!imprinted.any || imprinted.unresolved) return false;
  SurfaceSoup whole = std::move(by_patch);
  whole.surface.assign(whole.triangles.size(), 0);
  const ComplexResult found = build_complex(imprinted, whole, 1, tolerance, OverlapRule::later, {}, progress);
  if (found.inconsistent || found.lost[0]) return false;

  RepairedSurface resolved;
  for (Index f = 0; f < found.complex.faces.size(); ++f) {
    Triangle ids = found.complex.faces[f].ids;
    if (found.complex.faces[f].behind == outside_region) std::swap(ids[1], ids[2]);
    resolved.triangles.push_back(ids);
    if (from.groups.empty()) continue;
    const Index source = found.body_sources[0][found.complex.sources(f)[0].triangle];
    resolved.groups.push_back(from.groups[source]);
  }
  resolved.points = keep_used(found.complex.points, resolved.triangles);
  if (!self_intersections(resolved.points, resolved.triangles).empty()) return false;
  resolved.closed = resolved.triangles.size();
  measure_surface(resolved);
  body.surface = std::move(resolved);
  return true;
}

}  // namespace tetwright
