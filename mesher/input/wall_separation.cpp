// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/wall_separation.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "common/geometry/surface_tree.h"
#include "mesher/input/body_contacts.h"
#include "mesher/input/surface_holes.h"
#include "mesher/tuning/complex_tuning.h"
#include "mesher/tuning/input_tuning.h"

namespace tetwright {

namespace {

double box_diagonal(const std::vector<Vec3>& points) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : points) box.extend(p);
  return box.diagonal().norm();
}

std::vector<const RepairedSurface*> surfaces_of(const DividedSurface& divided) {
  std::vector<const RepairedSurface*> all;
  for (const SurfaceCell& cell : divided.cells) all.push_back(&cell.surface);
  return all;
}

/// Whether each open patch bounds a cell or is a wall inside one.
bool open_patches_belong(const CleanedSurface& surface, const WalledSurface& walled) {
  const InnerWalls walls = walls_inside(surfaces_of(walled.divided), surface, walled.patches, walled.divided);
  std::vector<char> belongs = walls.whole;
  for (Index t = 0; t < surface.triangles.size(); ++t)
    if (walled.divided.bounds[t]) belongs[walled.patches.of[t]] = 1;
  for (Index p = 0; p < walled.patches.count; ++p)
    if (walled.patches.open[p] && !belongs[p]) return false;
  return true;
}

/// Takes patches that bound no cell out of a surface.
/// \return false, with the surface as it was, unless all of them are inside what is left, and that is closed
bool take_walls_out(CleanedSurface& surface, const CleanedSurface& all, const std::string& file,
                    NestedRule nested, WalledSurface& walled) {
  std::vector<char> loose(walled.patches.count, 1);
  for (Index t = 0; t < all.triangles.size(); ++t)
    if (walled.divided.bounds[t]) loose[walled.patches.of[t]] = 0;
  if (std::find(loose.begin(), loose.end(), 1) == loose.end()) return false;
  CleanedSurface rest = without_patches(surface, walled.patches, loose);
  if (rest.triangles.empty() || has_free_edges(rest.triangles)) return false;
  const SurfaceRepair repaired = repair_cleaned(rest, file, nested, {});
  if (repaired.surface.closed != repaired.surface.triangles.size()) return false;
  std::vector<const RepairedSurface*> solids{&repaired.surface};
  for (const RepairedSurface& s : repaired.nested) solids.push_back(&s);
  InnerWalls walls = walls_inside(solids, all, walled.patches, walled.divided);
  if (walls.whole != loose || walls.kept.triangles.empty()) return false;
  walled.walls = std::move(walls);
  walled.given = all;
  surface = std::move(rest);
  return true;
}

}  // namespace

std::optional<WalledSurface> separate_walls(CleanedSurface& surface, const std::string& file,
                                            NestedRule nested, RegionRule rule, const ContactOptions& contact,
                                            Progress* progress) {
  const bool odd = may_have_inner_walls(surface);
  if (!odd && !has_free_edges(surface.triangles)) return {};
  const double diagonal = box_diagonal(surface.points);
  if (!std::isfinite(diagonal)) return {};
  const double tolerance = contact_tolerance(contact, diagonal);
  if (diagonal < ComplexTuning::Contact::min_body * tolerance) return {};
  WalledSurface walled;
  walled.patches = find_connected_patches(surface.points, surface.triangles);
  const bool open = walled.patches.any_open();
  if (open ? !walled.patches.open_within_closed(surface.points, surface.triangles)
           : rule == RegionRule::outer)
    return {};
  // A doubled open wall is no pair of shells that touch.
  CleanedSurface all = surface;
  for (Index t = 0; t < all.triangles.size(); ++t)
    if (walled.patches.open[walled.patches.of[t]]) all.two_sided[t] = all.even[t] = 0;
  walled.divided = divide_surface(all, tolerance, progress);
  if (walled.divided.unresolved || walled.divided.cells.empty()) return {};
  bool divides = odd;
  for (Index t = 0; t < all.triangles.size() && !divides; ++t)
    divides = walled.patches.open[walled.patches.of[t]] && walled.divided.between[t];
  if (divides && walled.divided.has_inner_walls()) {
    if (open && !open_patches_belong(all, walled)) return {};
    if (rule == RegionRule::cells) {
      walled.given = std::move(all);
      return walled;
    }
  }
  if (!take_walls_out(surface, all, file, nested, walled)) return {};
  return walled;
}

InnerWalls walls_inside(const std::vector<const RepairedSurface*>& solids, const CleanedSurface& surface,
                        const ConnectedPatches& patches, const DividedSurface& divided) {
  double area = 0;
  for (const RepairedSurface* s : solids) area += s->area;
  std::vector<std::optional<SurfaceTree>> trees(solids.size());  // built if a point is in their box
  const auto inside = [&](const Vec3& point) {
    for (std::size_t k = 0; k < solids.size(); ++k) {
      const RepairedSurface& s = *solids[k];
      if ((point.array() < s.low.array()).any() || (point.array() > s.high.array()).any()) continue;
      if (!trees[k]) trees[k].emplace(s.points, s.triangles);
      if (trees[k]->winding_number(point) >= 0.5) return true;
    }
    return false;
  };
  return find_inner_walls(surface, patches, divided, inside, InputTuning::Walls::min_share * area);
}

}  // namespace tetwright
