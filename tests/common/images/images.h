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

/// Value of an image at a voxel index, or 0 outside its box, by the definition of trilinear interpolation.
inline double trilinear(const ImageVolume& image, Vec3 p) {
  std::array<std::size_t, 3> low{}, high{};
  Vec3 part;
  for (int a = 0; a < 3; ++a) {
    const auto k = static_cast<std::size_t>(a);
    if (p[a] < -0.5 || p[a] > image.size[k] - 0.5) return 0;
    const double x = std::clamp(p[a], 0.0, image.size[k] - 1.0);
    low[k] = static_cast<std::size_t>(x);
    high[k] = std::min(low[k] + 1, static_cast<std::size_t>(image.size[k] - 1));
    part[a] = x - static_cast<double>(low[k]);
  }
  double sum = 0;
  for (int c = 0; c < 8; ++c) {
    std::array<std::size_t, 3> at{};
    double weight = 1;
    for (int a = 0; a < 3; ++a) {
      const bool up = (c >> a & 1) != 0;
      at[static_cast<std::size_t>(a)] = (up ? high : low)[static_cast<std::size_t>(a)];
      weight *= up ? part[a] : 1 - part[a];
    }
    sum += weight * image.channels[0][(at[2] * static_cast<std::size_t>(image.size[1]) + at[1]) *
                                          static_cast<std::size_t>(image.size[0]) +
                                      at[0]];
  }
  return sum;
}

/// Mean of a function over a tet, by `levels` halvings of its edges and four points in each part.
inline double mean_by_parts(const std::function<double(const Vec3&)>& f, const std::array<Vec3, 4>& tet,
                            int levels) {
  const auto& [a, b, c, d] = tet;
  if (levels == 0) {
    constexpr double own = 0.58541019662496845446, other = 0.13819660112501051518;
    double sum = 0;
    for (int i = 0; i < 4; ++i) {
      Vec3 p = Vec3::Zero();
      for (int j = 0; j < 4; ++j) p += (i == j ? own : other) * tet[static_cast<std::size_t>(j)];
      sum += f(p) / 4;
    }
    return sum;
  }
  const Vec3 ab = (a + b) / 2, ac = (a + c) / 2, ad = (a + d) / 2, bc = (b + c) / 2, bd = (b + d) / 2,
             cd = (c + d) / 2;
  double sum = 0;
  for (const std::array<Vec3, 4>& part : {std::array<Vec3, 4>{a, ab, ac, ad},
                                          {b, ab, bc, bd},
                                          {c, ac, bc, cd},
                                          {d, ad, bd, cd},
                                          {ab, cd, ac, ad},
                                          {ab, cd, ad, bd},
                                          {ab, cd, bd, bc},
                                          {ab, cd, bc, ac}})
    sum += mean_by_parts(f, part, levels - 1) / 8;
  return sum;
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
