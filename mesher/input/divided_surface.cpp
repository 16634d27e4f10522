// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/divided_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "common/features/edge_uses.h"
#include "common/geometry/self_intersection.h"
#include "common/mesh/disjoint_sets.h"
#include "mesher/complex/surface_cells.h"
#include "mesher/complex/surface_imprint.h"
#include "mesher/input/surface_measures.h"
#include "mesher/tuning/complex_tuning.h"
#include "mesher/tuning/input_tuning.h"

namespace tetwright {

namespace {

/// Calls `body` with the uses of each edge.
template <class Body>
void for_each_edge(std::span<const Triangle> triangles, Body&& body) {
  const std::vector<EdgeUse> uses = edge_uses(triangles, {});
  for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
    while (j < uses.size() && uses[j].key == uses[i].key) ++j;
    body(std::span(uses).subspan(i, j - i));
  }
}

Triangle sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

class SurfaceDivider {
 public:
  SurfaceDivider(const CleanedSurface& surface, double tolerance)
      : surface_(surface), tolerance_(tolerance) {}

  DividedSurface divide(Progress* progress) {
    if (!imprint(progress)) return std::move(result_);
    count_borders();
    cells_ = find_cells(points_, triangles_);
    measure_cells();
    dissolve_small_cells();
    find_sheets();
    compare_repeated();
    add_cells();
    order_cells();
    return std::move(result_);
  }

 private:
  const Vec3& corner(Index t, std::size_t k) const { return points_[triangles_[t][k]]; }
  Vec3 centre(Index t) const { return (corner(t, 0) + corner(t, 1) + corner(t, 2)) / 3; }
  double area(Index t) const {
    return (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0)).norm() / 2;
  }
  /// The cell that one was joined with, or itself; `outside_` for the outside.
  Index label(Index cell) { return labels_->root(cell); }

  /// Cuts the sheets along the curves in which they meet.
  bool imprint(Progress* progress) {
    SurfaceSoup soup;
    soup.points = surface_.points;
    std::vector<Index> origin;
    result_.bounds.assign(surface_.triangles.size(), 0);
    result_.between.assign(surface_.triangles.size(), 0);
    for (Index t = 0; t < surface_.triangles.size(); ++t) {
      if (surface_.two_sided[t] && surface_.even[t]) {
        result_.bounds[t] = 1;
        continue;
      }
      soup.triangles.push_back(surface_.triangles[t]);
      origin.push_back(t);
    }
    if (soup.triangles.empty()) return false;
    number_sheets(soup);
    ImprintedSurfaces imprinted = imprint_surfaces(soup, tolerance_, progress);
    if (imprinted.unresolved) {
      result_.unresolved = imprinted.unresolved;
      return false;
    }
    points_ = std::move(imprinted.points);
    std::map<Triangle, Index> known;
    for (std::size_t i = 0; i < imprinted.triangles.size(); ++i) {
      const Triangle& t = imprinted.triangles[i];
      const auto [first, added] = known.try_emplace(sorted(t), static_cast<Index>(triangles_.size()));
      if (!added) {
        first_of_repeated_.push_back(first->second);
        result_.repeated.push_back(
            {{points_[t[0]], points_[t[1]], points_[t[2]]}, origin[imprinted.source[i]], false, false});
        continue;
      }
      triangles_.push_back(imprinted.triangles[i]);
      source_.push_back(origin[imprinted.source[i]]);
    }
    return !triangles_.empty();  // all may be smaller than the tolerance
  }

  /// Numbers sheets by area, so that smaller ones move onto larger ones.
  static void number_sheets(SurfaceSoup& soup) {
    DisjointSets sets(soup.triangles.size());
    for_each_edge(soup.triangles, [&](std::span<const EdgeUse> edge) {
      if (edge.size() == 2) sets.unite(edge[0].triangle, edge[1].triangle);
    });
    std::vector<double> areas(soup.triangles.size(), 0);
    std::vector<Index> roots;
    for (Index t = 0; t < soup.triangles.size(); ++t) {
      const auto& [a, b, c] = soup.triangles[t];
      areas[sets.root(t)] += (soup.points[b] - soup.points[a]).cross(soup.points[c] - soup.points[a]).norm();
      if (sets.is_root(t)) roots.push_back(t);
    }
    std::sort(roots.begin(), roots.end(),
              [&](Index a, Index b) { return areas[a] != areas[b] ? areas[a] > areas[b] : a < b; });
    std::vector<std::uint32_t> number(soup.triangles.size());
    for (std::uint32_t k = 0; k < roots.size(); ++k) number[roots[k]] = k;
    for (Index t = 0; t < soup.triangles.size(); ++t) soup.surface.push_back(number[sets.root(t)]);
  }

  void count_borders() {
    at_border_.assign(triangles_.size(), 0);
    for_each_edge(triangles_, [&](std::span<const EdgeUse> edge) {
      if (edge.size() != 1) return;
      at_border_[edge[0].triangle] = 1;
      const auto [a, b] = ends_of(edge[0].key);
      if (result_.border_edges++ == 0) result_.border = (points_[a] + points_[b]) / 2;
    });
  }

  /// Volumes of cells; of each piece of the surface the cell around it is the outside.
  void measure_cells() {
    outside_ = cells_.count;
    labels_.emplace(cells_.count + 1);
    volumes_.assign(cells_.count, 0);
    areas_.assign(cells_.count, 0);
    const Vec3 apex = points_[triangles_[0][0]];
    std::vector<Index> around(triangles_.size(), no_index);
    for (Index t = 0; t < triangles_.size(); ++t) {
      const double volume = (corner(t, 0) - apex).dot((corner(t, 1) - apex).cross(corner(t, 2) - apex)) / 6;
      volumes_[cells_.sides[t][0]] += volume;
      volumes_[cells_.sides[t][1]] -= volume;
      for (const Index cell : cells_.sides[t]) areas_[cell] += area(t);
    }
    for (Index t = 0; t < triangles_.size(); ++t)
      for (const Index cell : cells_.sides[t])
        if (Index& lowest = around[cells_.piece[t]]; lowest == no_index || volumes_[cell] < volumes_[lowest])
          lowest = cell;
    // A root is the smallest number of its set, so that the outside is known by a flag.
    is_outside_.assign(cells_.count + 1, 0);
    for (const Index cell : around)
      if (cell != no_index) labels_->unite(cell, outside_), is_outside_[cell] = 1;
    total_ = 0;
    for (Index c = 0; c < cells_.count; ++c)
      if (!is_outside_[c]) total_ += volumes_[c];
  }

  /// Joins cells that are small or thinner than the tolerance with the neighbour of the largest common area,
  /// smallest first.
  void dissolve_small_cells() {
    std::vector<Index> small;
    for (Index c = 0; c < cells_.count; ++c)
      if (!is_outside_[c] && (volumes_[c] < ComplexTuning::Cells::thin_share * tolerance_ * areas_[c] ||
                              volumes_[c] < InputTuning::Cells::min_share * total_))
        small.push_back(c);
    if (small.empty()) return;
    std::sort(small.begin(), small.end(), [&](Index a, Index b) {
      return volumes_[a] != volumes_[b] ? volumes_[a] < volumes_[b] : a < b;
    });
    std::map<Index, std::vector<Index>> faces;
    for (const Index c : small) faces[c];
    for (Index t = 0; t < triangles_.size(); ++t)
      for (const Index cell : cells_.sides[t])
        if (const auto own = faces.find(cell); own != faces.end()) own->second.push_back(t);
    for (const Index c : small) {
      std::map<Index, double> beside;
      for (const Index t : faces[c])
        for (const Index cell : cells_.sides[t])
          if (label(cell) != label(c)) beside[label(cell)] += area(t);
      if (beside.empty()) continue;
      const Index to = std::max_element(beside.begin(), beside.end(), [](const auto& a, const auto& b) {
                         return a.second < b.second;
                       })->first;
      if (result_.dissolved_cells++ == 0) result_.dissolved = centre(faces[c][0]);
      labels_->unite(c, to);
    }
  }

  /// Measures triangles that bound nothing.
  void find_sheets() {
    double largest = -1;
    for (Index t = 0; t < triangles_.size(); ++t) {
      const Index behind = label(cells_.sides[t][0]), front = label(cells_.sides[t][1]);
      const bool is_bound = cells_.sides[t][0] != cells_.sides[t][1];
      if (is_bound) result_.bounds[source_[t]] = 1;
      if (behind != front && behind != label(outside_) && front != label(outside_))
        result_.between[source_[t]] = 1;
      if (behind != front) continue;
      const double own = area(t);
      ++result_.sheet_triangles;
      result_.sheet_area += own;
      if (behind == label(outside_)) result_.outside_sheet_area += own;
      result_.sheets.push_back({{corner(t, 0), corner(t, 1), corner(t, 2)},
                                source_[t],
                                behind == label(outside_),
                                at_border_[t] != 0,
                                cells_.sides[t][0],
                                is_bound});
      if (own > largest) largest = own, result_.sheet = centre(t);
    }
  }

  /// Repeated triangles bound what the first ones with the same corners do.
  void compare_repeated() {
    for (std::size_t i = 0; i < result_.repeated.size(); ++i) {
      WallTriangle& own = result_.repeated[i];
      const auto [behind, front] = cells_.sides[first_of_repeated_[i]];
      own.cell = behind;
      own.at_cell = behind != front;
      own.outside = label(behind) == label(outside_);
    }
  }

  /// One surface for each bounded cell.
  void add_cells() {
    std::map<Index, std::vector<Index>> faces;  // by label
    for (Index t = 0; t < triangles_.size(); ++t) {
      const Index behind = label(cells_.sides[t][0]), front = label(cells_.sides[t][1]);
      if (behind == front) continue;
      for (const Index side : {behind, front})
        if (side != label(outside_)) faces[side].push_back(t);
    }
    const auto crossing = self_intersections(points_, triangles_);
    result_.crossing_pairs = crossing.size();
    if (!crossing.empty()) result_.crossing = corner(crossing[0].first, 0);
    std::vector<char> crosses(triangles_.size(), 0);
    for (const auto& [f, g] : crossing) crosses[f] = crosses[g] = 1;
    const std::vector<std::set<Index>> bounded = cells_of_groups();
    for (const auto& [cell, list] : faces) {
      SurfaceCell& own = result_.cells.emplace_back();
      for (const Index t : list) {
        Triangle ids = triangles_[t];
        const bool is_behind = label(cells_.sides[t][0]) == cell;
        if (!is_behind) std::swap(ids[1], ids[2]);
        own.walled |= label(cells_.sides[t][is_behind ? 1 : 0]) != label(outside_);
        own.surface.triangles.push_back(ids);
        own.surface.intersects_itself |= crosses[t] != 0;
        if (!surface_.groups.empty()) own.surface.groups.push_back(surface_.groups[source_[t]]);
      }
      own.surface.closed = own.surface.triangles.size();
      own.surface.points = keep_used(points_, own.surface.triangles);
      measure_surface(own.surface);
      name(own, cell, list, bounded);
    }
  }

  /// For each group the cells that each of its triangles bounds.
  std::vector<std::set<Index>> cells_of_groups() {
    std::vector<std::set<Index>> common;
    std::vector<char> seen;
    for (Index t = 0; t < triangles_.size() && !surface_.groups.empty(); ++t) {
      const std::uint32_t group = surface_.groups[source_[t]];
      if (group >= common.size()) common.resize(group + 1), seen.resize(group + 1, 0);
      const std::set<Index> sides{label(cells_.sides[t][0]), label(cells_.sides[t][1])};
      if (!seen[group])
        common[group] = sides;
      else
        std::erase_if(common[group], [&](Index cell) { return !sides.contains(cell); });
      seen[group] = 1;
    }
    return common;
  }

  /// Finds the group that names a cell.
  void name(SurfaceCell& own, Index cell, const std::vector<Index>& faces,
            const std::vector<std::set<Index>>& bounded) {
    if (bounded.empty()) return;
    std::set<std::uint32_t> all, outer;
    for (const Index t : faces) {
      const std::uint32_t group = surface_.groups[source_[t]];
      all.insert(group);
      if (label(cells_.sides[t][0]) == label(outside_) || label(cells_.sides[t][1]) == label(outside_))
        outer.insert(group);
    }
    const std::set<std::uint32_t>& naming = outer.empty() ? all : outer;
    if (naming.size() == 1 && bounded[*naming.begin()].contains(cell)) own.group = *naming.begin();
  }

  /// Sorts by volume; runs of equal volumes by their lowest point: smallest z, then y, then x.
  void order_cells() {
    std::vector<SurfaceCell>& cells = result_.cells;
    std::stable_sort(cells.begin(), cells.end(), [](const SurfaceCell& a, const SurfaceCell& b) {
      return a.surface.volume > b.surface.volume;
    });
    Vec3 low = points_[0], high = points_[0];
    for (const Vec3& p : points_) low = low.cwiseMin(p), high = high.cwiseMax(p);
    const double step = InputTuning::Cells::equal * (high - low).norm();
    const auto lowest = [&](const SurfaceCell& cell) {
      std::array<double, 3> best{INFINITY, INFINITY, INFINITY};
      for (const Vec3& p : cell.surface.points)
        best = std::min(best, {std::round(p.z() / step), std::round(p.y() / step), std::round(p.x() / step)});
      return best;
    };
    for (auto first = cells.begin(); first != cells.end();) {
      const double smallest = (1 - InputTuning::Cells::equal) * first->surface.volume;
      const auto last =
          std::find_if(first, cells.end(), [&](const SurfaceCell& c) { return c.surface.volume < smallest; });
      if (last - first > 1)
        std::stable_sort(first, last,
                         [&](const SurfaceCell& a, const SurfaceCell& b) { return lowest(a) < lowest(b); });
      first = last;
    }
  }

  const CleanedSurface& surface_;
  double tolerance_;
  DividedSurface result_;
  std::vector<Vec3> points_;
  std::vector<Triangle> triangles_;
  std::vector<Index> source_;  ///< of each triangle: that of the surface
  std::vector<Index> first_of_repeated_;
  SurfaceCells cells_;
  Index outside_ = 0;                   ///< a number of labels_ after those of the cells
  std::optional<DisjointSets> labels_;  ///< cells that are joined
  std::vector<char> is_outside_;        ///< by cell
  std::vector<char> at_border_;         ///< by triangle
  std::vector<double> volumes_, areas_;
  double total_ = 0;  ///< volume of all bounded cells
};

}  // namespace

bool DividedSurface::has_inner_walls() const {
  double area = 0;
  bool walled = false;
  for (const SurfaceCell& c : cells) area += c.surface.area, walled |= c.walled;
  return walled && outside_sheet_area <= area;
}

CleanedSurface outline_of(const DividedSurface& divided) {
  CleanedSurface all;
  std::map<std::array<double, 3>, Index> numbers;
  std::map<Triangle, std::size_t> sides;  // number of cells at each triangle
  for (const SurfaceCell& cell : divided.cells) {
    for (Triangle t : cell.surface.triangles) {
      for (Index& p : t) {
        const Vec3& point = cell.surface.points[p];
        const auto [known, added] =
            numbers.try_emplace({point.x(), point.y(), point.z()}, static_cast<Index>(all.points.size()));
        if (added) all.points.push_back(point);
        p = known->second;
      }
      all.triangles.push_back(t);
      ++sides[sorted(t)];
    }
    all.groups.insert(all.groups.end(), cell.surface.groups.begin(), cell.surface.groups.end());
  }
  std::vector<Triangle> outer;
  std::vector<std::uint32_t> groups;
  for (Index t = 0; t < all.triangles.size(); ++t) {
    if (sides.at(sorted(all.triangles[t])) > 1) continue;
    outer.push_back(all.triangles[t]);
    if (!all.groups.empty()) groups.push_back(all.groups[t]);
  }
  all.triangles = std::move(outer);
  all.groups = std::move(groups);
  all.points = keep_used(all.points, all.triangles);
  all.two_sided.assign(all.triangles.size(), 0);
  all.even.assign(all.triangles.size(), 0);
  return all;
}

bool may_have_inner_walls(const CleanedSurface& surface) {
  bool found = false;
  for_each_edge(surface.triangles, [&](std::span<const EdgeUse> edge) {
    if (edge.size() < 2) return;
    std::size_t count = 0;
    for (const EdgeUse& use : edge) count += surface.even[use.triangle] ? 2 : 1;
    found |= count > 2 && count % 2 != 0;
  });
  return found;
}

DividedSurface divide_surface(const CleanedSurface& surface, double tolerance, Progress* progress) {
  return SurfaceDivider(surface, tolerance).divide(progress);
}

}  // namespace tetwright
