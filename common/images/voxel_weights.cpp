// SPDX-License-Identifier: Apache-2.0
#include "common/images/voxel_weights.h"

#include <cmath>
#include <limits>
#include <utility>

namespace tetwright {

namespace {

/// Rounding of coordinates moves the faces of a tet by about this, relative to the coordinates.
constexpr double coordinate_rounding = 4 * std::numeric_limits<double>::epsilon();
/// Tets whose volume rounding changes by more than this are flat.
constexpr double flat_volume = 1e-5;

/// A point of a quadrature on triangles: barycentric weights of the corners, and the part of the area.
struct QuadraturePoint {
  std::array<double, 3> corners;
  double part;
};

/// Exact for polynomials of degree 4 (Dunavant 1985, International Journal for Numerical Methods in
/// Engineering 21).
constexpr double outer_near = 0.44594849091596488632, outer_part = 0.22338158967801146570;
constexpr double inner_near = 0.09157621350977074346, inner_part = 0.10995174365532186764;
constexpr std::array<QuadraturePoint, 6> degree_4{{
    {{outer_near, outer_near, 1 - 2 * outer_near}, outer_part},
    {{outer_near, 1 - 2 * outer_near, outer_near}, outer_part},
    {{1 - 2 * outer_near, outer_near, outer_near}, outer_part},
    {{inner_near, inner_near, 1 - 2 * inner_near}, inner_part},
    {{inner_near, 1 - 2 * inner_near, inner_near}, inner_part},
    {{1 - 2 * inner_near, inner_near, inner_near}, inner_part},
}};

/// Volume by which rounding of coordinates changes a tet.
double rounding_of(const std::array<Vec3, 4>& corners) {
  double area = 0, largest = 1;
  for (const auto& f : tet_faces)
    area += 0.5 * (corners[f[1]] - corners[f[0]]).cross(corners[f[2]] - corners[f[0]]).cwiseAbs().sum();
  for (const Vec3& p : corners) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  return coordinate_rounding * largest * area;
}

}  // namespace

/// Splits a polygon; one on the plane is below it.
void VoxelWeights::split(const Polygon& polygon, int axis, double at, Polygon& below, Polygon& above) {
  below.count = above.count = 0;
  bool any_below = false, any_above = false;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    any_below |= polygon.points[i][axis] < at;
    any_above |= polygon.points[i][axis] > at;
  }
  if (!any_above) {
    below = polygon;
    return;
  }
  if (!any_below) {
    above = polygon;
    return;
  }
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const Vec3& p = polygon.points[i];
    const Vec3& q = polygon.points[i + 1 < polygon.count ? i + 1 : 0];
    if (p[axis] <= at) below.add(p);
    if (p[axis] >= at) above.add(p);
    if (!((p[axis] < at && q[axis] > at) || (p[axis] > at && q[axis] < at))) continue;
    // From below to above, so that both faces at an edge get the same point.
    const bool up = p[axis] < at;
    const Vec3 &low = up ? p : q, &high = up ? q : p;
    Vec3 cut = low + (at - low[axis]) / (high[axis] - low[axis]) * (high - low);
    cut[axis] = at;
    below.add(cut);
    above.add(cut);
  }
  if (below.count < 3) below.count = 0;
  if (above.count < 3) above.count = 0;
}

void VoxelWeights::drop_outside(Polygon& polygon, int axis) const {
  Polygon outside, inside;
  const double begin = cells_[static_cast<std::size_t>(axis)].begin(0);
  for (std::size_t i = 0; i < polygon.count; ++i)
    if (polygon.points[i][axis] < begin) {
      split(polygon, axis, begin, outside, inside);
      polygon = inside;
      return;
    }
}

/// Moves the part below the upper end of a cell from `rest` to `taken`.
void VoxelWeights::take_cell(Polygon& rest, int axis, int cell, Polygon& taken) const {
  taken.count = 0;
  if (rest.count == 0) return;
  Polygon above;
  split(rest, axis, cells_[static_cast<std::size_t>(axis)].begin(cell + 1), taken, above);
  rest = above;
}

/// Clears the nodes around a tet.
void VoxelWeights::begin(const std::array<Vec3, 4>& corners) {
  Vec3 low = corners[0], high = corners[0];
  for (const Vec3& p : corners) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const auto nodes = [&](int axis) {
    const GridCells& cells = cells_[static_cast<std::size_t>(axis)];
    return Nodes{cells.at(low[axis]) - 1, cells.at(high[axis]) + 1};
  };
  x_ = nodes(0);
  y_ = nodes(1);
  z_ = nodes(2);
  for (std::vector<double>& plane : planes_) plane.assign(x_.count() * y_.count(), 0);
}

bool VoxelWeights::in_one_cell(const std::array<Vec3, 4>& corners) const {
  if (x_.count() > 2 || y_.count() > 2 || z_.count() > 2) return false;
  for (const Vec3& p : corners)
    for (int axis = 0; axis < 3; ++axis)
      if (!cells_[static_cast<std::size_t>(axis)].contains(p[axis])) return false;
  return true;
}

/// Adds to the nodes of a cell.
/// \param products integrals of 1, x, y, xy, z, xz, yz, xyz, from the lower nodes of the cell
void VoxelWeights::add_products(const std::array<double, 8>& products, double factor) {
  const auto& [one, x, y, xy, z, xz, yz, xyz] = products;
  const std::array<double, 8> shares{one - x - y - z + xy + xz + yz - xyz,
                                     x - xy - xz + xyz,
                                     y - xy - yz + xyz,
                                     xy - xyz,
                                     z - xz - yz + xyz,
                                     xz - xyz,
                                     yz - xyz,
                                     xyz};
  for (std::size_t i = 0; i < shares.size(); ++i)
    share(static_cast<int>(i / 4), y_.begin + static_cast<int>(i / 2 % 2),
          x_.begin + static_cast<int>(i % 2)) += factor * shares[i];
}

/// Adds a tet inside one cell, by the integrals of products of barycentric weights.
void VoxelWeights::add_one_cell(const std::array<Vec3, 4>& corners, double volume) {
  const Vec3 node(x_.begin, y_.begin, z_.begin);
  double x = 0, y = 0, z = 0, xy = 0, xz = 0, yz = 0, xyz = 0;
  for (const Vec3& corner : corners) {
    const Vec3 p = corner - node;
    x += p.x();
    y += p.y();
    z += p.z();
    xy += p.x() * p.y();
    xz += p.x() * p.z();
    yz += p.y() * p.z();
    xyz += p.x() * p.y() * p.z();
  }
  add_products({1, x / 4, y / 4, (x * y + xy) / 20, z / 4, (x * z + xz) / 20, (y * z + yz) / 20,
                (x * y * z + x * yz + y * xz + z * xy + 2 * xyz) / 120},
               volume);
}

void VoxelWeights::add_point(const Vec3& p) {
  const double x = p.x() - x_.begin, y = p.y() - y_.begin, z = p.z() - z_.begin;
  add_products({1, x, y, x * y, z, x * z, y * z, x * y * z}, 1);
}

/// Adds a piece of a face inside a cell, or with x = last() + 1 beyond the last one.
void VoxelWeights::add_piece(const Polygon& piece, int x, int y, int z) {
  const Vec3 node(x - 1, y - 1, z - 1);
  const auto column = static_cast<std::size_t>(x - column_begin_);
  const bool beyond = x > cells_[0].last();
  const double start = x == 0 ? 0.5 : 0;  // of the cell's part inside the box
  const double upper_start = start * start / 2, lower_start = start - upper_start;
  Edges whole{}, lower{}, upper{};
  for (std::size_t i = 2; i < piece.count; ++i) {
    const Vec3 a = piece.points[0] - node, b = piece.points[i - 1] - node, c = piece.points[i] - node;
    const double area = 0.5 * ((b.y() - a.y()) * (c.z() - a.z()) - (c.y() - a.y()) * (b.z() - a.z()));
    for (const QuadraturePoint& q : degree_4) {
      const Vec3 p = q.corners[0] * a + q.corners[1] * b + q.corners[2] * c;
      const double weight = q.part * area, to_upper = p.x() * p.x() / 2 - upper_start,
                   to_lower = p.x() - p.x() * p.x() / 2 - lower_start;
      const double above = weight * p.z(), below = weight - above;
      const Edges edges{below - below * p.y(), below * p.y(), above - above * p.y(), above * p.y()};
      for (std::size_t e = 0; e < edges.size(); ++e) {
        whole[e] += edges[e];
        lower[e] += edges[e] * to_lower;
        upper[e] += edges[e] * to_upper;
      }
    }
  }
  for (std::size_t e = 0; e < whole.size(); ++e) of_pieces_[column][e] += whole[e];
  if (beyond) return;
  for (std::size_t e = 0; e < whole.size(); ++e) {
    of_nodes_[column][e] += lower[e];
    of_nodes_[column + 1][e] += upper[e];
  }
}

/// Adds the parts of the cells that the faces of the column enclose, and the column to the planes of nodes.
void VoxelWeights::finish_column(int y) {
  Edges behind{};
  for (int x = column_end_ - 1; x >= column_begin_; --x) {
    const auto column = static_cast<std::size_t>(x - column_begin_);
    // Integrals of both nodes' weights over the part of a cell that is inside the box.
    const double lower = x == 0 ? 0.125 : x == cells_[0].last() ? 0.375 : 0.5;
    const double upper = x == 0 ? 0.375 : x == cells_[0].last() ? 0.125 : 0.5;
    for (std::size_t e = 0; e < behind.size(); ++e) {
      behind[e] += of_pieces_[column + 1][e];
      of_nodes_[column][e] += behind[e] * lower;
      of_nodes_[column + 1][e] += behind[e] * upper;
    }
  }
  for (int x = column_begin_ - 1; x < column_end_; ++x) {
    const int column = x - column_begin_ + 1;
    const Edges& edges = of_nodes_[static_cast<std::size_t>(column)];
    for (int e = 0; e < 4; ++e) share(e / 2, y - 1 + e % 2, x) += edges[static_cast<std::size_t>(e)];
  }
}

/// Adds a column of cells along the first axis.
/// \param faces parts of the tet's faces inside it
void VoxelWeights::add_column(const std::array<Polygon, 4>& faces, int y, int z) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Polygon& face : faces)
    for (std::size_t i = 0; i < face.count; ++i) {
      low = std::min(low, face.points[i].x());
      high = std::max(high, face.points[i].x());
    }
  if (low > high) return;
  // Cut points may be rounded across a plane that the tet only touches.
  column_begin_ = std::clamp(cells_[0].at(low), x_.begin + 1, x_.end - 1);
  column_end_ = std::clamp(cells_[0].at(high) + 1, column_begin_ + 1, x_.end);
  const auto count = static_cast<std::size_t>(column_end_ - column_begin_) + 1;
  of_nodes_.assign(count, Edges{});
  of_pieces_.assign(count, Edges{});
  for (const Polygon& face : faces) {
    if (face.count == 0) continue;
    Polygon rest = face, piece;
    drop_outside(rest, 0);
    double begin = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < rest.count; ++i) begin = std::min(begin, rest.points[i].x());
    const int first = rest.count > 0 ? std::max(cells_[0].at(begin), column_begin_) : column_end_;
    for (int x = first; x < column_end_ && rest.count > 0; ++x) {
      take_cell(rest, 0, x, piece);
      if (piece.count > 0) add_piece(piece, x, y, z);
    }
    if (rest.count == 0) continue;
    const bool beyond = column_end_ > cells_[0].last();  // of the image; else by rounding
    add_piece(rest, beyond ? column_end_ : column_end_ - 1, y, z);
  }
  finish_column(y);
}

/// Adds a layer of cells, and removes what is inside it from `faces`.
void VoxelWeights::add_layer(std::array<Polygon, 4>& faces, int z) {
  std::array<Polygon, 4> layer, column;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    take_cell(faces[f], 2, z, layer[f]);
    drop_outside(layer[f], 1);
    for (std::size_t i = 0; i < layer[f].count; ++i) {
      low = std::min(low, layer[f].points[i].y());
      high = std::max(high, layer[f].points[i].y());
    }
  }
  if (low > high) return;
  const int first = std::clamp(cells_[1].at(low), y_.begin + 1, y_.end - 1),
            end = std::min(cells_[1].at(high) + 1, y_.end);
  for (int y = first; y < end; ++y) {
    for (std::size_t f = 0; f < faces.size(); ++f) take_cell(layer[f], 1, y, column[f]);
    add_column(column, y, z);
  }
}

/// Passes on the shares of the lower plane, and makes the upper one the lower one.
/// \return their sum
double VoxelWeights::visit_lower_plane(int z, double sign, const Visit& visit) {
  const int first = std::max(x_.begin, 0), last = std::min(x_.end, cells_[0].size) - 1;
  const int nodes = last - first + 1;
  const auto count = static_cast<std::size_t>(nodes);
  double sum = 0;
  for (int y = y_.begin; y < y_.end; ++y) {
    // Nodes beyond the image have the values of its outermost voxels.
    if (x_.begin < first) share(0, y, first) += share(0, y, x_.begin);
    if (x_.end - 1 > last) share(0, y, last) += share(0, y, x_.end - 1);
    double* row = &share(0, y, first);
    bool any = false;
    for (std::size_t i = 0; i < count; ++i) {
      row[i] *= sign;
      sum += row[i];
      any |= row[i] != 0;
    }
    if (!any) continue;
    const auto plane =
        static_cast<std::size_t>(cells_[2].voxel(z)) * static_cast<std::size_t>(cells_[1].size);
    visit((plane + static_cast<std::size_t>(cells_[1].voxel(y))) * static_cast<std::size_t>(cells_[0].size) +
              static_cast<std::size_t>(first),
          row, count);
  }
  std::fill(planes_[0].begin(), planes_[0].end(), 0);
  std::swap(planes_[0], planes_[1]);
  return sum;
}

VoxelWeights::Measures VoxelWeights::for_each_run(const std::array<Vec3, 4>& corners, const Visit& visit) {
  const double volume =
      (corners[1] - corners[0]).cross(corners[2] - corners[0]).dot(corners[3] - corners[0]) / 6;
  Measures measures;
  measures.volume = std::abs(volume);
  rounding_ = 0;
  begin(corners);
  if (in_one_cell(corners)) {
    if (measures.volume == 0) measures.volume = 1;
    add_one_cell(corners, measures.volume);
    for (int z = z_.begin; z < z_.end; ++z) measures.inside += visit_lower_plane(z, 1, visit);
    return measures;
  }
  rounding_ = rounding_of(corners);
  if (!(rounding_ <= flat_volume * measures.volume)) {
    rounding_ = 0;
    measures.volume = 1;
    if (for_each_run(Vec3((corners[0] + corners[1] + corners[2] + corners[3]) / 4), visit))
      measures.inside = 1;
    return measures;
  }
  std::array<Polygon, 4> faces;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (const std::uint8_t v : tet_faces[f]) faces[f].add(corners[v]);
    drop_outside(faces[f], 2);
  }
  const double sign = volume < 0 ? -1 : 1;
  for (int z = z_.begin + 1; z < z_.end; ++z) {
    add_layer(faces, z);
    measures.inside += visit_lower_plane(z - 1, sign, visit);
  }
  measures.inside += visit_lower_plane(z_.end - 1, sign, visit);
  return measures;
}

bool VoxelWeights::for_each_run(const Vec3& p, const Visit& visit) {
  for (int axis = 0; axis < 3; ++axis)
    if (!cells_[static_cast<std::size_t>(axis)].contains(p[axis])) return false;
  rounding_ = 0;
  begin({p, p, p, p});
  add_point(p);
  for (int z = z_.begin; z < z_.end; ++z) (void)visit_lower_plane(z, 1, visit);
  return true;
}

}  // namespace tetwright
