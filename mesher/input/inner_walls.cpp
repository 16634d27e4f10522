// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/inner_walls.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "common/mesh/disjoint_sets.h"
#include "mesher/tuning/input_tuning.h"

namespace tetwright {

namespace {

/// Triangles by their corners' coordinates: parts of a surface that was cut have points of their own.
class WallPieces {
 public:
  void add(const std::array<Vec3, 3>& corners, std::uint32_t group) {
    Triangle ids;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = corners[k];
      const auto [known, added] =
          numbers_.try_emplace({p.x(), p.y(), p.z()}, static_cast<Index>(points_.size()));
      if (added) points_.push_back(p);
      ids[k] = known->second;
    }
    triangles_.push_back(ids);
    groups_.push_back(group);
  }

  /// Moves pieces of at least some area to the walls.
  void take(double min_area, bool grouped, InnerWalls& walls) {
    DisjointSets sets(points_.size());
    for (const auto& [a, b, c] : triangles_) {
      sets.unite(a, b);
      sets.unite(a, c);
    }
    std::vector<double> areas(points_.size(), 0);
    for (const Triangle& t : triangles_) areas[sets.root(t[0])] += area(t);
    for (const double a : areas) walls.pieces += a > 0 && a >= min_area;
    double largest = -1;
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      if (areas[sets.root(triangles_[t][0])] < min_area) {
        walls.drop(area(triangles_[t]), centre(triangles_[t]));
        continue;
      }
      walls.kept.triangles.push_back(triangles_[t]);
      if (grouped) walls.kept.triangle_groups.push_back(groups_[t]);
      walls.area += area(triangles_[t]);
      if (area(triangles_[t]) <= largest) continue;
      largest = area(triangles_[t]);
      walls.place = centre(triangles_[t]);
    }
    walls.kept.points = keep_used(points_, walls.kept.triangles);
  }

 private:
  double area(const Triangle& t) const {
    return (points_[t[1]] - points_[t[0]]).cross(points_[t[2]] - points_[t[0]]).norm() / 2;
  }
  Vec3 centre(const Triangle& t) const { return (points_[t[0]] + points_[t[1]] + points_[t[2]]) / 3; }

  std::map<std::array<double, 3>, Index> numbers_;
  std::vector<Vec3> points_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> groups_;
};

/// For each number of WallTriangle::cell whether it is inside a body. One triangle decides for all of a cell.
std::map<Index, bool> inside_cells(const DividedSurface& divided,
                                   const std::function<bool(const Vec3&)>& inside) {
  std::map<Index, const WallTriangle*> largest;
  for (const WallTriangle& w : divided.sheets) {
    const WallTriangle*& known = largest[w.cell];
    if (!w.at_cell && (!known || w.area() > known->area())) known = &w;
  }
  std::map<Index, bool> result;
  for (const auto& [cell, w] : largest) result[cell] = w && inside(w->centre());
  return result;
}

std::array<Vec3, 3> corners_of(const CleanedSurface& surface, Index t) {
  const auto& [a, b, c] = surface.triangles[t];
  return {surface.points[a], surface.points[b], surface.points[c]};
}

}  // namespace

void InnerWalls::drop(double size, const Vec3& centre) {
  ++dropped;
  dropped_area += size;
  if (size <= largest_dropped) return;
  largest_dropped = size;
  dropped_place = centre;
}

InnerWalls find_inner_walls(const CleanedSurface& surface, const ConnectedPatches& patches,
                            const DividedSurface& divided, const std::function<bool(const Vec3&)>& inside,
                            double min_area) {
  InnerWalls walls;
  std::map<Index, bool> in_body = inside_cells(divided, inside);
  std::vector<char> bounds(patches.count, 0);
  for (Index t = 0; t < surface.triangles.size(); ++t) bounds[patches.of[t]] |= divided.bounds[t];
  std::vector<double> area_inside(patches.count, 0), area_on_others(patches.count, 0);
  const auto is_inside = [&](const WallTriangle& w) { return !w.at_cell && in_body.at(w.cell); };
  for (const WallTriangle& w : divided.sheets)
    if (is_inside(w)) area_inside[patches.of[w.source]] += w.area();
  for (const WallTriangle& w : divided.repeated)
    if (is_inside(w)) area_on_others[patches.of[w.source]] += w.area();
  for (Index p = 0; p < patches.count; ++p)
    walls.whole.push_back(!bounds[p] && area_inside[p] + area_on_others[p] >=
                                            InputTuning::Walls::inside_share * patches.area[p]);
  const bool grouped = !surface.groups.empty();
  const auto group = [&](Index t) { return grouped ? surface.groups[t] : 0; };
  // A patch that lies mostly on earlier ones leaves only what they do not have.
  const auto keeps_all = [&](Index p) { return walls.whole[p] && area_inside[p] >= area_on_others[p]; };
  WallPieces pieces;
  for (Index t = 0; t < surface.triangles.size(); ++t)
    if (keeps_all(patches.of[t])) pieces.add(corners_of(surface, t), group(t));
  for (const WallTriangle& w : divided.sheets) {
    const Index p = patches.of[w.source];
    if (keeps_all(p)) continue;
    if ((bounds[p] || walls.whole[p]) && is_inside(w))
      pieces.add(w.corners, group(w.source));
    else
      walls.drop(w.area(), w.centre());
  }
  for (const WallTriangle& w : divided.repeated)
    if (const Index p = patches.of[w.source]; walls.whole[p] && !keeps_all(p))
      walls.drop(w.area(), w.centre());
  pieces.take(min_area, grouped, walls);
  return walls;
}

CleanedSurface without_patches(const CleanedSurface& surface, const ConnectedPatches& patches,
                               const std::vector<char>& left_out) {
  CleanedSurface rest;
  for (Index t = 0; t < surface.triangles.size(); ++t) {
    if (left_out[patches.of[t]]) continue;
    rest.triangles.push_back(surface.triangles[t]);
    if (!surface.groups.empty()) rest.groups.push_back(surface.groups[t]);
    rest.two_sided.push_back(surface.two_sided[t]);
    rest.even.push_back(surface.even[t]);
  }
  rest.points = keep_used(surface.points, rest.triangles);
  return rest;
}

WallSheet sheet_of_walls(const InnerWalls& walls, const CleanedSurface& surface,
                         const DividedSurface& divided, const MaterialSurface& from,
                         std::set<std::string>& taken) {
  const std::vector<SurfaceRegion>& groups = from.surface.groups;
  std::vector<char> of_boundary(groups.size(), 0);
  for (Index t = 0; t < surface.groups.size(); ++t)
    if (divided.bounds[t]) of_boundary[surface.groups[t]] = 1;
  const auto free_name = [&] {
    const std::string first = from.name.empty() ? "sheet" : from.name + "_sheet";
    std::string own = first;
    for (int k = 2; !taken.insert(own).second; ++k) own = first + "_" + std::to_string(k);
    return own;
  };
  WallSheet result{{"", walls.kept, from.file}, {}};
  TriangleMesh& mesh = result.sheet.surface;
  std::string unnamed;
  std::map<std::uint32_t, std::uint32_t> number;  // of the groups that occur
  for (std::uint32_t& g : mesh.triangle_groups) {
    const auto [known, added] = number.try_emplace(g, static_cast<std::uint32_t>(mesh.groups.size()));
    if (added) {
      const SurfaceRegion& own = groups[g];
      const bool names_wall = own && !of_boundary[g];
      if (names_wall) result.groups.push_back(own);
      if (!names_wall && unnamed.empty()) unnamed = free_name();
      mesh.groups.push_back({0, !names_wall        ? unnamed
                                : own.name.empty() ? from.name + "_" + std::to_string(own.number)
                                                   : own.name});
    }
    g = known->second;
  }
  result.sheet.name = mesh.groups.size() == 1 ? mesh.groups[0].name : unnamed.empty() ? free_name() : unnamed;
  return result;
}

}  // namespace tetwright
