// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/table1/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/geometry/distance_tree.h"
#include "common/random.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

double area(const TriangleMesh& m, const Triangle& t) {
  return (m.points[t[1]] - m.points[t[0]]).cross(m.points[t[2]] - m.points[t[0]]).norm() / 2;
}

std::vector<Vec3> area_samples(const TriangleMesh& m, std::size_t count) {
  double total = 0;
  for (const Triangle& t : m.triangles) total += area(m, t);
  std::vector<Vec3> samples;
  Random random(1);
  const double step = total / static_cast<double>(count);
  double sum = 0, next = step * random.uniform();
  for (const Triangle& t : m.triangles)
    for (sum += area(m, t); next < sum; next += step) {
      // Uniform in the triangle: a square is folded along its diagonal.
      double u = random.uniform(), v = random.uniform();
      if (u + v > 1) u = 1 - u, v = 1 - v;
      samples.push_back(m.points[t[0]] + u * (m.points[t[1]] - m.points[t[0]]) +
                        v * (m.points[t[2]] - m.points[t[0]]));
    }
  return samples;
}

std::vector<Vec3> extreme_samples(const TriangleMesh& m) {
  std::vector<Vec3> samples;
  std::vector<std::uint8_t> used(m.points.size(), 0);
  for (const Triangle& t : m.triangles) {
    const Vec3 &a = m.points[t[0]], &b = m.points[t[1]], &c = m.points[t[2]];
    for (const Index p : t)
      if (!used[p]) {
        used[p] = 1;
        samples.push_back(m.points[p]);
      }
    samples.insert(samples.end(), {(a + b) / 2, (b + c) / 2, (c + a) / 2, (a + b + c) / 3});
  }
  return samples;
}

std::vector<double> distances(const std::vector<Vec3>& samples, const DistanceTree& tree, double size) {
  std::vector<double> out(samples.size());
  parallel_for(0, samples.size(), 1024, [&](std::size_t begin, std::size_t end) {
    double reach = size / 1000;
    for (std::size_t i = begin; i < end; ++i) {
      // A bound shortens the search: the distance of the last sample, enlarged until a triangle is found.
      for (;; reach *= 4) {
        out[i] = tree.distance(samples[i], reach);
        if (out[i] < reach || reach > 4 * size) break;
      }
      reach = std::max(size / 10000, 2 * out[i]);
    }
  });
  return out;
}

OneWayDistance one_way(const TriangleMesh& from, const DistanceTree& to, double size, std::size_t count) {
  OneWayDistance d;
  const std::vector<double> even = distances(area_samples(from, count), to, size);
  for (const double x : even) {
    d.rms += x * x / static_cast<double>(even.size());
    d.max = std::max(d.max, x);
  }
  d.rms = std::sqrt(d.rms);
  for (const double x : distances(extreme_samples(from), to, size)) d.max = std::max(d.max, x);
  return d;
}

}  // namespace

double diagonal(const TriangleMesh& surface) {
  if (surface.triangles.empty()) return 0;
  Vec3 low = surface.points[surface.triangles[0][0]], high = low;
  for (const Triangle& t : surface.triangles)
    for (const Index p : t) {
      low = low.cwiseMin(surface.points[p]);
      high = high.cwiseMax(surface.points[p]);
    }
  return (high - low).norm();
}

SurfaceDistance surface_distance(const TriangleMesh& surface, const TriangleMesh& reference,
                                 std::size_t count) {
  const double size = diagonal(reference);
  const DistanceTree surface_tree(surface.points, surface.triangles);
  const DistanceTree reference_tree(reference.points, reference.triangles);
  return {one_way(surface, reference_tree, size, count), one_way(reference, surface_tree, size, count)};
}

}  // namespace tetwright
