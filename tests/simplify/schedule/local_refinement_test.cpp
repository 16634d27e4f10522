// SPDX-License-Identifier: Apache-2.0
#include "simplify/schedule/local_refinement.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "simplify/schedule/engine.h"
#include "simplify/schedule/selection.h"
#include "simplify/schedule/whole_mesh.h"
#include "tests/simplify/meshes.h"
#include "tetwright/mesh_quality.h"

namespace tetwright {
namespace {

/// A cube of side 4 whose top has a hill, with triangles finer than the faces of grid_mesh(4).
TriangleMesh cube_with_hill(const Vec3& place, double height, double width) {
  constexpr Index n = 160;
  TriangleMesh s;
  for (Index y = 0; y <= n; ++y)
    for (Index x = 0; x <= n; ++x) {
      const Vec3 p(4.0 * x / n, 4.0 * y / n, 4);
      s.points.push_back(p + Vec3(0, 0, height * std::exp(-(p - place).squaredNorm() / (width * width))));
    }
  for (Index y = 0; y < n; ++y)
    for (Index x = 0; x < n; ++x) {
      const Index a = y * (n + 1) + x, b = a + 1, c = a + n + 1, d = c + 1;
      s.triangles.push_back({a, b, d});
      s.triangles.push_back({a, d, c});
    }
  const auto first = static_cast<Index>(s.points.size());
  for (Index i = 0; i < 8; ++i) s.points.emplace_back(4.0 * (i & 1), 4.0 * (i >> 1 & 1), 4.0 * (i >> 2));
  for (const auto& [a, b, c, d] :
       {std::array<Index, 4>{0, 2, 3, 1}, {0, 1, 5, 4}, {1, 3, 7, 5}, {3, 2, 6, 7}, {2, 0, 4, 6}}) {
    s.triangles.push_back({first + a, first + b, first + c});
    s.triangles.push_back({first + a, first + c, first + d});
  }
  return s;
}

TEST(LocalRefinement, FollowsASurfaceWithinItsFaces) {
  const TriangleMesh surface = cube_with_hill({1.7, 1.25, 4}, 0.2, 0.25);
  const std::vector<std::uint8_t> free;
  Engine engine(grid_mesh(4), {"mesh", 384, 5, 10, 1, 0, ShapeObjective::both, nullptr, free, false}, nullptr,
                nullptr);
  engine.rules.error.max.reset();
  engine.begin_improvement();
  engine.keep_surface(&surface, true);
  const double scale = engine.mesh().space().scale(), limit = 0.08 * scale;
  engine.assign_samples(0.2 * scale);
  engine.rules.deviation.tolerance = engine.rules.deviation.max = 0.87 * limit;
  const auto far_tets = [&] {
    return tets_with_faces(engine.mesh(), engine.input_samples().add_far_samples(limit));
  };
  ASSERT_EQ(far_tets().size(), 1);  // the tet at the face below the hill
  WholeMesh whole(engine);
  const ImprovementPlan plan{.kind = "close",
                             .angle = 0.12,
                             .leave_surface_angle = 0,
                             .target_tets = 384,
                             .min_tets = 100,
                             .max_tets = 2000,
                             .fast = false,
                             .brief = false,
                             .max_rounds = 20};
  refine_beyond_tolerance(engine, whole, plan, 0.1, limit);
  EXPECT_TRUE(far_tets().empty());
  EXPECT_LT(engine.mesh().live_tets(), 600);
  EXPECT_LT(engine.input_samples().deviation(nullptr).from_surface.upper, 0.081);
  const TetMesh mesh = std::move(engine).take();
  EXPECT_TRUE(check_mesh(mesh).empty());
}

}  // namespace
}  // namespace tetwright
