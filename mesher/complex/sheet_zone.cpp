// SPDX-License-Identifier: Apache-2.0
#include "mesher/complex/sheet_zone.h"

#include <algorithm>
#include <cmath>

#include "common/geometry/point_triangle.h"
#include "common/geometry/triangle_distance.h"
#include "common/parallel/parallel_sort.h"
#include "common/tolerances.h"
#include "mesher/complex/sheet_borders.h"
#include "mesher/tuning/complex_tuning.h"

namespace tetwright {

namespace {

using SheetLengths = ComplexTuning::Sheets;
using Zone = ComplexTuning::Zone;

}  // namespace

SheetZone::SheetZone(const LabelledComplex& complex, const GridFrame& voxels)
    : components_(complex.sheet_components), branches_(complex, voxels) {
  add_faces(complex, voxels);
  find_voxels(voxels);
}

double SheetZone::reach() { return SheetLengths::reach; }

void SheetZone::add_faces(const LabelledComplex& complex, const GridFrame& voxels) {
  const SheetBorders borders = continue_sheets(complex, SheetLengths::continued * voxels.cell_size);
  std::vector<Vec3> points;
  points.reserve(borders.points.size());
  for (const Vec3& p : borders.points) points.push_back(voxels.to_grid(p));
  std::vector<std::vector<Face>> faces(components_.size());
  const auto add = [&](const Triangle& t, std::uint32_t component, bool continued) {
    const Vec3 &a = points[t[0]], &b = points[t[1]], &c = points[t[2]];
    const Vec3 normal = (b - a).cross(c - a);
    if (normal.norm() > 0) faces[component].push_back({{a, b, c}, normal.normalized(), continued});
  };
  for (const LabelledComplex::SheetFace& f : complex.sheets) {
    add(f.ids, f.component, false);
    std::vector<RegionIndex>& regions = components_[f.component].regions;
    if (const auto at = std::lower_bound(regions.begin(), regions.end(), f.region);
        at == regions.end() || *at != f.region)
      regions.insert(at, f.region);
  }
  for (std::size_t t = 0; t < borders.triangles.size(); ++t)
    add(borders.triangles[t], complex.sheets[borders.faces[t]].component, true);
  for (std::size_t c = 0; c < components_.size(); ++c) {
    Component& component = components_[c];
    std::vector<Box3> boxes;
    std::vector<Vec3> middles;
    for (const Face& f : faces[c]) {
      boxes.emplace_back();
      for (const Vec3& p : f.corners) boxes.back().add(p);
      middles.push_back(f.corners[0] + f.corners[1] + f.corners[2]);
      if (!f.continued) component.box.add(boxes.back());
    }
    component.box.low.array() -= 2 * SheetLengths::reach;
    component.box.high.array() += 2 * SheetLengths::reach;
    const std::vector<Index> order = median_order(boxes, middles, Zone::leaf_size);
    component.tree = BoxTree(order.size(), Zone::leaf_size, [&](std::size_t i) { return boxes[order[i]]; });
    for (const Index i : order) component.faces.push_back(faces[c][i]);
  }
}

void SheetZone::find_voxels(const GridFrame& voxels) {
  std::vector<std::array<Vec3, 3>> faces;
  for (const Component& c : components_)
    for (const Face& f : c.faces)
      if (!f.continued) faces.push_back(f.corners);
  voxels_ = parallel_collect<MortonKey>(
      0, faces.size(), ComplexGrains::divided,
      [&](std::size_t begin, std::size_t end, std::vector<MortonKey>& out) {
        constexpr double limit =
            (half_cube_diagonal + SheetLengths::fine_cells) * (half_cube_diagonal + SheetLengths::fine_cells);
        for (std::size_t i = begin; i < end; ++i) {
          Box3 box;
          for (const Vec3& p : faces[i]) box.add(p);
          std::array<int, 3> low, high;
          for (int a = 0; a < 3; ++a) {
            const auto k = static_cast<std::size_t>(a);
            low[k] = std::max(0, static_cast<int>(std::floor(box.low[a] - SheetLengths::fine_cells)) - 1);
            high[k] = std::min(voxels.cells[k] - 1,
                               static_cast<int>(std::floor(box.high[a] + SheetLengths::fine_cells)) + 1);
          }
          const TriangleDistance distance(faces[i][0], faces[i][1], faces[i][2]);
          for (int z = low[2]; z <= high[2]; ++z)
            for (int y = low[1]; y <= high[1]; ++y)
              for (int x = low[0]; x <= high[0]; ++x)
                if (distance.squared(Vec3(x + 0.5, y + 0.5, z + 0.5), limit) <= limit)
                  out.push_back(morton_encode({x, y, z}));
        }
      });
  parallel_sort_unique(voxels_);
}

SheetZone::Foot SheetZone::nearest(const Component& component, const Vec3& point, bool continued) {
  constexpr double limit = 4 * SheetLengths::reach * SheetLengths::reach;
  Foot found{limit, {}, nullptr};
  double alignment = 0;
  std::size_t number = 0;
  component.tree.nearest(point, limit, component.tree.all(), [&](std::size_t i, double best) {
    const Face& f = component.faces[i];
    if (f.continued && !continued) return best;
    const Vec3 away = point - closest_point(point, f.corners[0], f.corners[1], f.corners[2]);
    const double squared = away.squaredNorm();
    if (squared > found.squared * (1 + Zone::tie)) return best;
    // Among equally near triangles the one that faces the point most directly knows its side.
    const double aligned = std::abs(f.normal.dot(away));
    if (found.face && squared >= found.squared * (1 - Zone::tie) &&
        (aligned < alignment || (aligned == alignment && i > number)))
      return best;
    found = {std::min(found.squared, squared), away, &f};
    alignment = aligned;
    number = i;
    return found.squared * (1 + Zone::tie);
  });
  return found;
}

void SheetZone::find(const Vec3& point, std::vector<Near>& out) const {
  out.clear();
  for (std::uint32_t c = 0; c < components_.size(); ++c) {
    const Component& component = components_[c];
    if (!component.box.contains(point)) continue;
    const Foot own = nearest(component, point, false);
    if (!own.face) continue;
    const Foot foot = nearest(component, point, true);
    const double distance = std::sqrt(own.squared), length = foot.away.norm();
    const bool in_front = side(foot) > 0;
    Near near{c, in_front ? length : -length, foot.face->normal, distance, own.face->normal, true};
    if (length > tolerance::smallest_distance) near.ahead_gradient = foot.away / near.ahead;
    if (distance > tolerance::smallest_distance) near.away = own.away / distance;
    out.push_back(near);
  }
  branches_.hide(point, 2 * SheetLengths::reach, out);
}

bool SheetZone::is_in(std::uint32_t component, RegionIndex region) const {
  const std::vector<RegionIndex>& regions = components_[component].regions;
  return std::binary_search(regions.begin(), regions.end(), region);
}

}  // namespace tetwright
