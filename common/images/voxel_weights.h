// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Cells of a grid of voxels along one axis. Centres of voxels are at 0 to size - 1. Cell c is between the
/// centres of voxels c - 1 and c, where the image is interpolated; the first and the last one are the halves
/// of voxels beyond the outermost centres, where the image is constant.
struct GridCells {
  int size;  ///< voxels

  int last() const { return size; }
  /// Lower end of a cell; with `cell` = last() + 1 the upper end of the last one.
  double begin(int cell) const {
    return cell == 0 ? -0.5 : cell > size ? static_cast<double>(size) - 0.5 : static_cast<double>(cell - 1);
  }
  /// Cell of a position, the first or the last one for positions beyond the grid.
  int at(double x) const {
    return x < 0 ? 0 : x >= static_cast<double>(size) ? size : static_cast<int>(x) + 1;
  }
  bool contains(double x) const { return begin(0) <= x && x <= begin(size + 1); }
  /// Nearest voxel to a node: node i is the centre of voxel i, from -1 to `size`.
  int voxel(int node) const { return std::clamp(node, 0, size - 1); }
};

/// Shares of voxels in a tet: the integral over the tet of the weight that each voxel has in trilinear
/// interpolation. The mean weighted by them is the mean of the interpolated image over the tet, exactly.
///
/// Integration along the first axis is analytic and leaves integrals over the projections of the tet's faces,
/// cut into pieces at the planes between cells. The integrand is a polynomial of degree 4 in each, for which
/// the quadrature is exact. So only rounding makes errors, and a tet takes time proportional to the number of
/// pieces and of voxels in its box.
///
/// An object serves one thread, and keeps its memory from tet to tet.
class VoxelWeights {
 public:
  /// \param size voxels along each axis
  explicit VoxelWeights(const std::array<int, 3>& size) : cells_{{{size[0]}, {size[1]}, {size[2]}}} {}

  /// Measures of a tet, voxels cubed.
  struct Measures {
    double volume = 0;  ///< positive also for inverted tets; 1 for flat ones
    double inside = 0;  ///< sum of all shares: the volume inside the image's box
  };
  /// Receives voxels that are consecutive along the first axis, with the share of each. A voxel at the border
  /// may be in several calls.
  using Visit = std::function<void(std::size_t voxel, const double* shares, std::size_t count)>;

  /// Calls `visit` for all voxels with a share. Those of a tet so flat that rounding hides its volume are the
  /// weights of its centroid.
  /// \param corners in voxel indices, finite
  Measures for_each_run(const std::array<Vec3, 4>& corners, const Visit& visit);
  /// Smaller shares of the tet of the last or current call are due to rounding, voxels cubed.
  double rounding() const { return rounding_; }

  /// Calls `visit` for the voxels that trilinear interpolation at a point uses, with their weights.
  /// \return false, without a call, for points outside the image's box
  bool for_each_run(const Vec3& p, const Visit& visit);

 private:
  /// A convex polygon. A triangle cut by two planes along each axis has up to 9 corners.
  struct Polygon {
    std::size_t count = 0;
    std::array<Vec3, 12> points;

    // Rounding can make a plane cut a polygon more than twice; what exceeds the space has no area.
    void add(const Vec3& p) {
      if (count < points.size()) points[count++] = p;
    }
  };
  /// Range of nodes along an axis.
  struct Nodes {
    int begin = 0, end = 0;
    std::size_t count() const { return static_cast<std::size_t>(end - begin); }
  };
  /// For each of the four edges of a column of cells along the first axis.
  using Edges = std::array<double, 4>;

  static void split(const Polygon& polygon, int axis, double at, Polygon& below, Polygon& above);
  void drop_outside(Polygon& polygon, int axis) const;
  void take_cell(Polygon& rest, int axis, int cell, Polygon& taken) const;
  void begin(const std::array<Vec3, 4>& corners);
  bool in_one_cell(const std::array<Vec3, 4>& corners) const;
  void add_products(const std::array<double, 8>& products, double factor);
  void add_one_cell(const std::array<Vec3, 4>& corners, double volume);
  void add_point(const Vec3& p);
  void add_layer(std::array<Polygon, 4>& faces, int z);
  void add_column(const std::array<Polygon, 4>& faces, int y, int z);
  void add_piece(const Polygon& piece, int x, int y, int z);
  void finish_column(int y);
  double& share(int side, int y, int x) {
    return planes_[static_cast<std::size_t>(side)][static_cast<std::size_t>(y - y_.begin) * x_.count() +
                                                   static_cast<std::size_t>(x - x_.begin)];
  }
  double visit_lower_plane(int z, double sign, const Visit& visit);

  std::array<GridCells, 3> cells_;
  Nodes x_, y_, z_;  ///< nodes around the tet
  /// Shares of the nodes below and above a layer of cells.
  std::array<std::vector<double>, 2> planes_;
  /// Shares of the nodes of a column, from x_.begin.
  std::vector<Edges> of_nodes_;
  /// Integrals over pieces of faces in a column, by their cells, which all cells before have a share in.
  std::vector<Edges> of_pieces_;
  double rounding_ = 0;
  int column_begin_ = 0, column_end_ = 0;  ///< cells of the column that faces meet
};

}  // namespace tetwright
