// SPDX-License-Identifier: Apache-2.0
#include "mesher/sizing/narrow_sheets.h"

#include <algorithm>
#include <cmath>

#include "common/geometry/projection_tree.h"
#include "common/parallel/parallel_sort.h"
#include "mesher/tuning/cell_tuning.h"

namespace tetwright {

namespace {

using Sheets = CellTuning::NarrowSheets;

Vec3 unit_normal(const std::vector<Vec3>& points, const Triangle& ids) {
  return (points[ids[1]] - points[ids[0]]).cross(points[ids[2]] - points[ids[0]]).normalized();
}

/// Calls `visit(point)` for points of a triangle at most `spacing` apart: the centres of equal parts.
template <class Visit>
void for_samples(const std::vector<Vec3>& points, const Triangle& ids, double spacing, const Visit& visit) {
  const Vec3 &a = points[ids[0]], u = points[ids[1]] - a, v = points[ids[2]] - a;
  const double longest = std::max({u.norm(), v.norm(), (v - u).norm()});
  const int n = static_cast<int>(std::clamp(std::ceil(longest / spacing), 1.0, Sheets::max_samples));
  for (int i = 0; i < n; ++i)
    for (int k = 0; i + k < n; ++k) visit(a + (i + 1.0 / 3) / n * u + (k + 1.0 / 3) / n * v);
}

}  // namespace

std::vector<RefinementRegion> find_narrow_sheets(const LabelledComplex& complex, double cell) {
  if (complex.sheet_components < 2) return {};
  std::vector<ProjectionTree::Item> items;
  for (Index f = 0; f < complex.sheets.size(); ++f)
    items.push_back({complex.sheets[f].ids, {complex.sheets[f].component, f, 0}});
  const ProjectionTree tree(complex.points, std::move(items));
  const double wanted = Sheets::cells_between * cell;
  return parallel_collect<RefinementRegion>(
      0, complex.sheets.size(), Sheets::grain,
      [&](std::size_t begin, std::size_t end, std::vector<RefinementRegion>& out) {
        for (std::size_t f = begin; f < end; ++f) {
          const LabelledComplex::SheetFace& own = complex.sheets[f];
          const Vec3 normal = unit_normal(complex.points, own.ids);
          for_samples(complex.points, own.ids, cell, [&](const Vec3& p) {
            const auto hit = tree.nearest_of(
                p, wanted, [&](const ProjectionTree::Item& item) { return item.kind[0] != own.component; });
            if (!hit) return;
            const Vec3 across = hit->point - p;
            const double thickness = across.norm();
            const Triangle& other = complex.sheets[tree.items()[hit->item].kind[1]].ids;
            if (std::abs(normal.dot(across)) < Sheets::facing * thickness ||
                std::abs(normal.dot(unit_normal(complex.points, other))) < Sheets::facing)
              return;
            const double halvings =
                std::ceil(std::log2(wanted / std::max(thickness, wanted / Sheets::max_ratio)));
            if (halvings >= 1) out.push_back({p + across / 2, static_cast<int>(halvings)});
          });
        }
      });
}

}  // namespace tetwright
