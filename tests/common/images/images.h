// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "common/random.h"
#include "tetwright/image_volume.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// An image with values by voxel index.
inline ImageVolume image_of(const std::array<int, 3>& size,
                            const std::function<double(int, int, int)>& value) {
  ImageVolume image;
  image.size = size;
  std::vector<float>& voxels = image.channels.emplace_back();
  for (int z = 0; z < size[2]; ++z)
    for (int y = 0; y < size[1]; ++y)
      for (int x = 0; x < size[0]; ++x) voxels.push_back(static_cast<float>(value(x, y, z)));
  return image;
}

/// Moves an image to a rotated grid with three different spacings.
inline void rotate(ImageVolume& image) {
  image.directions =
      Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()).toRotationMatrix() * Vec3(0.3, 0.7, 2).asDiagonal();
  image.origin = Vec3(-12, 5, 100);
}

/// A position in voxel indices. Plain numbers, since tests are compiled without optimisation.
using VoxelPoint = std::array<double, 3>;

/// Value of an image at a voxel index, or 0 outside its box, by the definition of trilinear interpolation.
inline double trilinear(const ImageVolume& image, const VoxelPoint& p) {
  std::size_t low[3], high[3];
  double part[3];
  for (int a = 0; a < 3; ++a) {
    if (p[a] < -0.5 || p[a] > image.size[a] - 0.5) return 0;
    const double x = p[a] < 0 ? 0 : p[a] > image.size[a] - 1 ? image.size[a] - 1 : p[a];
    low[a] = static_cast<std::size_t>(x);
    high[a] = low[a] + (low[a] + 1 < static_cast<std::size_t>(image.size[a]) ? 1 : 0);
    part[a] = x - static_cast<double>(low[a]);
  }
  const float* voxels = image.channels[0].data();
  const auto nx = static_cast<std::size_t>(image.size[0]), ny = static_cast<std::size_t>(image.size[1]);
  double sum = 0;
  for (int c = 0; c < 8; ++c) {
    const bool x = (c & 1) != 0, y = (c & 2) != 0, z = (c & 4) != 0;
    sum += (x ? part[0] : 1 - part[0]) * (y ? part[1] : 1 - part[1]) * (z ? part[2] : 1 - part[2]) *
           voxels[((z ? high : low)[2] * ny + (y ? high : low)[1]) * nx + (x ? high : low)[0]];
  }
  return sum;
}

/// Barycentric weights of points in a tet: four in each part after `levels` halvings of its edges.
inline std::vector<std::array<double, 4>> points_in_parts(int levels) {
  using Weights = std::array<double, 4>;
  std::vector<std::array<Weights, 4>> parts{{Weights{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
  const auto middle = [](const Weights& a, const Weights& b) {
    return Weights{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2, (a[3] + b[3]) / 2};
  };
  for (; levels > 0; --levels) {
    std::vector<std::array<Weights, 4>> smaller;
    for (const auto& [a, b, c, d] : parts) {
      const Weights ab = middle(a, b), ac = middle(a, c), ad = middle(a, d), bc = middle(b, c),
                    bd = middle(b, d), cd = middle(c, d);
      for (const std::array<Weights, 4>& part : {std::array<Weights, 4>{a, ab, ac, ad},
                                                 {b, ab, bc, bd},
                                                 {c, ac, bc, cd},
                                                 {d, ad, bd, cd},
                                                 {ab, cd, ac, ad},
                                                 {ab, cd, ad, bd},
                                                 {ab, cd, bd, bc},
                                                 {ab, cd, bc, ac}})
        smaller.push_back(part);
    }
    parts = std::move(smaller);
  }
  std::vector<Weights> points;
  constexpr double own = 0.58541019662496845446, other = 0.13819660112501051518;
  for (const std::array<Weights, 4>& part : parts)
    for (std::size_t i = 0; i < 4; ++i) {
      Weights p{};
      for (std::size_t j = 0; j < 4; ++j)
        for (std::size_t k = 0; k < 4; ++k) p[k] += (i == j ? own : other) * part[j][k];
      points.push_back(p);
    }
  return points;
}

/// Mean of a function over a tet, by 16,384 points.
template <class Function>
double mean_by_parts(const Function& f, const std::array<Vec3, 4>& tet) {
  static const std::vector<std::array<double, 4>> points = points_in_parts(4);
  double corners[4][3];
  for (int i = 0; i < 4; ++i)
    for (int a = 0; a < 3; ++a) corners[i][a] = tet[static_cast<std::size_t>(i)][a];
  double sum = 0;
  for (const std::array<double, 4>& w : points) {
    VoxelPoint p;
    for (std::size_t a = 0; a < 3; ++a)
      p[a] = w[0] * corners[0][a] + w[1] * corners[1][a] + w[2] * corners[2][a] + w[3] * corners[3][a];
    sum += f(p);
  }
  return sum / static_cast<double>(points.size());
}

/// A random tet around a point.
inline std::array<Vec3, 4> random_tet(Random& random, const Vec3& centre, double size) {
  std::array<Vec3, 4> tet;
  do {
    for (Vec3& p : tet)
      p = centre + size * Vec3(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
  } while (std::abs((tet[1] - tet[0]).cross(tet[2] - tet[0]).dot(tet[3] - tet[0])) <
           0.01 * size * size * size);
  return tet;
}

}  // namespace tetwright
