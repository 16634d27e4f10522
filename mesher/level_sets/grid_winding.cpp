// SPDX-License-Identifier: Apache-2.0
#include "mesher/level_sets/grid_winding.h"

#include <algorithm>
#include <cmath>

#include "common/geometry/ray_crossing.h"
#include "common/parallel/parallel_sort.h"
#include "common/tolerances.h"
#include "mesher/tuning/distance_tuning.h"

namespace tetwright {

namespace {

struct RowCrossing {
  std::uint32_t row;
  std::int32_t first;
  std::int32_t step;
};

/// The nodes of a row that a triangle's projection may cover at one x; `low > high` for none.
struct Range {
  double low = 1, high = 0;
  void add(double v) {
    if (low > high)
      low = high = v;
    else
      low = std::min(low, v), high = std::max(high, v);
  }
};

/// The y at which the edges of the projection meet the line at `x`.
Range shadow_at(const std::array<Vec3, 3>& p, double x) {
  Range range;
  for (int i = 0; i < 3; ++i) {
    const Vec3 &a = p[i], &b = p[(i + 1) % 3];
    if (std::min(a.x(), b.x()) > x || std::max(a.x(), b.x()) < x) continue;
    if (a.x() == b.x()) {
      range.add(a.y());
      range.add(b.y());
    } else {
      range.add(a.y() + (b.y() - a.y()) * ((x - a.x()) / (b.x() - a.x())));
    }
  }
  return range;
}

/// The lowest node of the row at (x, y) on or above the triangle. The plane gives a guess, exact signs the
/// answer.
int first_node_above(const std::array<Vec3, 3>& p, int crossing, int x, int y) {
  const Vec3 normal = (p[1] - p[0]).cross(p[2] - p[0]);
  const double low = std::min({p[0].z(), p[1].z(), p[2].z()});
  const double high = std::max({p[0].z(), p[1].z(), p[2].z()});
  double guess = p[0].z() - (normal.x() * (x - p[0].x()) + normal.y() * (y - p[0].y())) / normal.z();
  if (!(guess > low)) guess = low;  // also where the normal is horizontal and the guess is not a number
  if (guess > high) guess = high;
  int z = static_cast<int>(std::ceil(guess));
  const auto above = [&](int k) { return at_or_above(p[0], p[1], p[2], crossing, Vec3(x, y, k)); };
  while (!above(z)) ++z;
  while (above(z - 1)) --z;
  return z;
}

}  // namespace

GridWinding::GridWinding(std::span<const Vec3> points, std::span<const Triangle> triangles,
                         const std::array<int, 3>& cells)
    : nodes_x_(cells[0] + 1), nodes_y_(cells[1] + 1) {
  std::vector<RowCrossing> found = parallel_collect<RowCrossing>(
      0, triangles.size(), DistanceGrains::elements,
      [&](std::size_t begin, std::size_t end, std::vector<RowCrossing>& out) {
        for (std::size_t t = begin; t < end; ++t) {
          const std::array<Vec3, 3> p{points[triangles[t][0]], points[triangles[t][1]],
                                      points[triangles[t][2]]};
          const double left = std::min({p[0].x(), p[1].x(), p[2].x()});
          const double right = std::max({p[0].x(), p[1].x(), p[2].x()});
          for (int x = std::max(0, static_cast<int>(std::ceil(left)));
               x <= std::min(cells[0], static_cast<int>(std::floor(right))); ++x) {
            const Range shadow = shadow_at(p, x);
            if (shadow.low > shadow.high) continue;
            for (int y = std::max(0, static_cast<int>(std::ceil(shadow.low - tolerance::projected_triangle)));
                 y <= std::min(cells[1],
                               static_cast<int>(std::floor(shadow.high + tolerance::projected_triangle)));
                 ++y) {
              const int crossing = vertical_crossing(p[0], p[1], p[2], Vec3(x, y, 0));
              if (crossing == 0) continue;
              const auto row = static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(nodes_x_) +
                               static_cast<std::uint32_t>(x);
              out.push_back({row, first_node_above(p, crossing, x, y), crossing});
            }
          }
        }
      });

  const std::size_t rows = static_cast<std::size_t>(nodes_x_) * static_cast<std::size_t>(nodes_y_);
  starts_.assign(rows + 1, 0);
  for (const RowCrossing& c : found) ++starts_[c.row + 1];
  for (std::size_t r = 0; r < rows; ++r) starts_[r + 1] += starts_[r];
  crossings_.resize(found.size());
  std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
  for (const RowCrossing& c : found) crossings_[next[c.row]++] = {c.first, c.step};
  parallel_for(0, rows, DistanceGrains::elements, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r) {
      const std::span<Crossing> row{crossings_.data() + starts_[r], crossings_.data() + starts_[r + 1]};
      std::sort(row.begin(), row.end(),
                [](const Crossing& a, const Crossing& b) { return a.first < b.first; });
      std::int32_t winding = 0;
      for (Crossing& c : row) c.winding = winding += c.winding;
    }
  });
}

}  // namespace tetwright
