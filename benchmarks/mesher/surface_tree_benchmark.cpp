// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/surface_tree.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>

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

void distances(benchmark::State& state) {
  const TriangleMesh mesh = bumpy_sphere();
  const SurfaceTree tree(mesh.points, mesh.triangles);
  const double reach = 1e-3 * static_cast<double>(state.range(0));
  const std::vector<Vec3> points = queries(mesh, reach);
  for (auto _ : state)
    for (const Vec3& p : points) benchmark::DoNotOptimize(tree.distance(p, 2 * reach));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points.size()));
}
BENCHMARK(distances)->ArgName("reach")->Arg(10)->Arg(1000)->Unit(benchmark::kMillisecond);

void build_surface_tree(benchmark::State& state) {
  const TriangleMesh mesh = bumpy_sphere();
  for (auto _ : state) benchmark::DoNotOptimize(SurfaceTree(mesh.points, mesh.triangles));
}
BENCHMARK(build_surface_tree)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace tetwright
