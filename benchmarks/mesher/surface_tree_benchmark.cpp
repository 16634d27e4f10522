// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/surface_tree.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>

#include "common/geometry/distance_tree.h"
#include "common/random.h"
#include "tetwright/surface_mesh.h"

namespace tetwright {
namespace {

/// A sphere of about 200,000 triangles between meridians and parallels, with bumps of a tenth of the radius.
TriangleMesh bumpy_sphere() {
  constexpr int around = 317, rows = 317;
  TriangleMesh mesh;
  for (int i = 0; i <= rows; ++i)
    for (int j = 0; j < around; ++j) {
      const double u = std::numbers::pi * i / rows, v = 2 * std::numbers::pi * j / around;
      const Vec3 d(std::sin(u) * std::cos(v), std::sin(u) * std::sin(v), std::cos(u));
      mesh.points.push_back(d * (1 + 0.1 * std::sin(9 * d.x()) * std::sin(8 * d.y()) * std::sin(7 * d.z())));
    }
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < around; ++j) {
      const auto a = static_cast<Index>(i * around + j),
                 b = static_cast<Index>(i * around + (j + 1) % around);
      mesh.triangles.push_back({a, a + around, b});
      mesh.triangles.push_back({b, a + around, b + around});
    }
  return mesh;
}

/// Bars of 2 x 1000 slivers that cross each other, not along any axis.
TriangleMesh bars() {
  constexpr int around = 1000;
  TriangleMesh mesh;
  for (const Vec3& along : {Vec3(3, 2, 1), Vec3(-2, 3, 1), Vec3(1, -2, 3)}) {
    const Vec3 axis = along.normalized(), first = axis.unitOrthogonal(), second = axis.cross(first);
    const auto start = static_cast<Index>(mesh.points.size());
    for (int k = 0; k < around; ++k) {
      const double angle = 2 * std::numbers::pi * k / around;
      for (const double end : {-1.0, 1.0})
        mesh.points.push_back(end * axis + 0.3 * (std::cos(angle) * first + std::sin(angle) * second));
    }
    for (int k = 0; k < around; ++k) {
      const auto a = start + static_cast<Index>(2 * k),
                 b = start + static_cast<Index>(2 * ((k + 1) % around));
      mesh.triangles.push_back({a, b, a + 1});
      mesh.triangles.push_back({b, b + 1, a + 1});
    }
  }
  return mesh;
}

/// Random points, each within `reach` of a point of the surface along each axis.
std::vector<Vec3> queries(const TriangleMesh& mesh, double reach) {
  Random random(1);
  std::vector<Vec3> points(1 << 16);
  for (Vec3& p : points) {
    p = mesh.points[random.below(static_cast<std::uint32_t>(mesh.points.size()))];
    for (int a = 0; a < 3; ++a) p[a] += reach * (2 * random.uniform() - 1);
  }
  return points;
}

/// Uses one thread. The reach is in thousandths of the sphere's radius.
void winding_numbers(benchmark::State& state) {
  const TriangleMesh mesh = bumpy_sphere();
  const SurfaceTree tree(mesh.points, mesh.triangles);
  const std::vector<Vec3> points = queries(mesh, 1e-3 * static_cast<double>(state.range(0)));
  for (auto _ : state)
    for (const Vec3& p : points) benchmark::DoNotOptimize(tree.winding_number(p));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points.size()));
}
BENCHMARK(winding_numbers)->ArgName("reach")->Arg(10)->Arg(1000)->Unit(benchmark::kMillisecond);

void measure_distances(benchmark::State& state, const TriangleMesh& mesh) {
  const DistanceTree tree(mesh.points, mesh.triangles);
  const double reach = 1e-3 * static_cast<double>(state.range(0));
  const std::vector<Vec3> points = queries(mesh, reach);
  for (auto _ : state)
    for (const Vec3& p : points) benchmark::DoNotOptimize(tree.distance(p, 2 * reach));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points.size()));
}
void distances(benchmark::State& state) { measure_distances(state, bumpy_sphere()); }
BENCHMARK(distances)->ArgName("reach")->Arg(10)->Arg(1000)->Unit(benchmark::kMillisecond);
void distances_from_slivers(benchmark::State& state) { measure_distances(state, bars()); }
BENCHMARK(distances_from_slivers)->ArgName("reach")->Arg(10)->Arg(1000)->Unit(benchmark::kMillisecond);

void build_surface_tree(benchmark::State& state) {
  const TriangleMesh mesh = bumpy_sphere();
  for (auto _ : state) benchmark::DoNotOptimize(SurfaceTree(mesh.points, mesh.triangles));
}
BENCHMARK(build_surface_tree)->Unit(benchmark::kMillisecond)->UseRealTime();

void build_distance_tree(benchmark::State& state) {
  const TriangleMesh mesh = bumpy_sphere();
  for (auto _ : state) benchmark::DoNotOptimize(DistanceTree(mesh.points, mesh.triangles));
}
BENCHMARK(build_distance_tree)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace tetwright
