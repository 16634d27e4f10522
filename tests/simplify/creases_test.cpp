// SPDX-License-Identifier: Apache-2.0

// Feature edges and corners of parts keep their exact positions during simplification.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "simplify/operations/fitting.h"
#include "tests/simplify/meshes.h"
#include "tests/simplify/workbench.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/simplify.h"
#include "tetwright/surface_mesh.h"

namespace tetwright::creases_test {
namespace {

/// Working coordinates are on a lattice of 2^-30, and lengths here up to 2.
constexpr double exact = 2e-9;

Eigen::Matrix3d rotation() {
  return (Eigen::AngleAxisd(0.5, Vec3(1, 2, 3).normalized()) *
          Eigen::AngleAxisd(0.9, Vec3(3, -1, 2).normalized()))
      .toRotationMatrix();
}

/// A unit cube of n x n x n x 6 tets, optionally without a quarter, with interior points moved at random;
/// rotated, with patches.
TetMesh block(int n, bool quarter_missing) {
  TetMesh mesh = grid_mesh({n, n, n}, [&](int x, int y, int) -> std::optional<MaterialTag> {
    if (quarter_missing && 2 * x >= n && 2 * y >= n) return {};
    return 1;
  });
  mesh.interfaces = find_interfaces(mesh);
  std::vector<std::uint8_t> boundary(mesh.points.size(), 0);
  for (const InterfaceTriangle& t : mesh.interfaces)
    for (const Index p : t.ids) boundary[p] = 1;
  Random random(7);
  for (std::size_t p = 0; p < mesh.points.size(); ++p) {
    Vec3& at = mesh.points[p];
    for (int a = 0; a < 3; ++a) {
      const double by = 0.3 * (random.uniform() - 0.5);
      if (!boundary[p]) at[a] += by;
    }
    at = rotation() * at / n;
  }
  EXPECT_TRUE(find_mesh_patches(mesh, {}, "mesh").any());
  return mesh;
}

double volume_of(const TetMesh& mesh) {
  double sum = 0;
  for (const Tet& t : mesh.tets)
    sum += tet_volume(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]);
  return sum;
}

/// Expects the boundary points on the sides of the block, and the feature edges and corners of `before` on
/// those of `after`.
void expect_exact(const TetMesh& before, const TetMesh& after) {
  for (const MeshFinding& f : check_mesh(after)) ADD_FAILURE() << mesh_finding_line(f);
  for (const InterfaceTriangle& t : after.interfaces)
    for (const Index p : t.ids) {
      const Vec3 at = rotation().transpose() * after.points[p];
      double off = 1;
      for (int a = 0; a < 3; ++a)
        for (const double side : {0.0, 0.5, 1.0})
          if (side != 0.5 || a < 2) off = std::min(off, std::abs(at[a] - side));
      EXPECT_LT(off, exact) << at.transpose();
    }
  const CreaseCurves creases = mesh_creases(after), wanted = mesh_creases(before);
  ASSERT_EQ(creases.corners.size(), wanted.corners.size());
  for (const Vec3& corner : wanted.corners)
    EXPECT_TRUE(std::any_of(creases.corners.begin(), creases.corners.end(),
                            [&](const Vec3& c) { return (c - corner).norm() < exact; }));
  const auto length = [](const CreaseCurves& c) {
    double sum = 0;
    for (const auto& [a, b] : c.segments) sum += (c.points[b] - c.points[a]).norm();
    return sum;
  };
  EXPECT_NEAR(length(creases), length(wanted), 1e-7);
  EXPECT_NEAR(volume_of(after), volume_of(before), 1e-7);
}

TEST(Creases, OfBlocksStayExactAtAnyCount) {
  for (const bool quarter_missing : {false, true})
    for (const std::size_t target : {std::size_t{250}, std::size_t{3000}}) {
      const TetMesh before = block(14, quarter_missing);
      SimplifyOptions options;
      options.target_tets = target;
      const TetMesh after = simplify(before, options, nullptr, nullptr);
      EXPECT_NEAR(static_cast<double>(after.tets.size()), static_cast<double>(target),
                  0.01 * static_cast<double>(target) + 1);
      EXPECT_GE(mesh_statistics(after, 0.1).min_solid_angle, 0.1) << target << ' ' << quarter_missing;
      expect_exact(before, after);
    }
}

TEST(Creases, OfBlocksStayExactWhenShapesImprove) {
  const TetMesh before = block(8, true);
  ImproveOptions options;
  options.min_solid_angle = 0.15;
  expect_exact(before, improve(before, options, nullptr, nullptr));
  options.only_below = 0.12;
  expect_exact(before, improve(before, options, nullptr, nullptr));
}

/// A square whose points are moved onto circles around its centre.
TetMesh disc(int n, int layers) {
  TetMesh mesh = grid_mesh({n, n, layers}, [](int, int, int) { return std::optional<MaterialTag>(1); });
  for (Vec3& p : mesh.points) {
    const double x = 2 * p.x() / n - 1, y = 2 * p.y() / n - 1;
    const double round = std::max(std::abs(x), std::abs(y)), length = std::hypot(x, y);
    const double scale = length > 0 ? round / length : 0;
    p = {x * scale, y * scale, 2 * p.z() / n};
  }
  return mesh;
}

TEST(Creases, ThatAreCurvedStayWithinAThousandthOfTheDiagonal) {
  TetMesh before = disc(32, 6);
  // Tets at the four corners of the square are flat along the rim; the mesh is accepted nevertheless.
  ASSERT_EQ(find_mesh_patches(before, {FeatureAngle::Rule::degrees, 40}, "disc").count, 3U);
  SimplifyOptions options;
  options.target_tets = 1500;
  const TetMesh after = simplify(before, options, nullptr, nullptr);
  const CreaseCurves rims = mesh_creases(after);
  EXPECT_LT(rims.segments.size(), mesh_creases(before).segments.size() / 2);
  EXPECT_TRUE(rims.corners.empty());
  Box3 box;
  for (const Vec3& p : before.points) box.add(p);
  // Chords of the input's polygon deviate by another 0.0005.
  const double allowed = 0.001 * (box.high - box.low).norm() + 0.0012;
  for (const auto& [a, b] : rims.segments) {
    const Vec3 middle = (rims.points[a] + rims.points[b]) / 2;
    EXPECT_LT(std::abs(std::hypot(middle.x(), middle.y()) - 1), allowed);
  }
}

/// A cube [0, 1]^3 with exact patches, from which the mesh's feature edges deviate.
class ExactCube final : public ReferenceSurface {
 public:
  double signed_distance(const Vec3&, MaterialTag) const override { return 0; }
  std::optional<Vec3> project(const Vec3&, MaterialOrOutside, MaterialOrOutside, double) const override {
    return {};
  }
  bool has_patches() const override { return true; }
  std::optional<Vec3> onto_patch(const Vec3& p, MaterialOrOutside, MaterialOrOutside, std::uint16_t patch,
                                 double max_distance) const override {
    Vec3 on = p.cwiseMax(0).cwiseMin(1);
    on[patch / 2] = patch % 2;
    return within(p, on, max_distance);
  }
  std::optional<Vec3> onto_crease(const Vec3& p, double max_distance) const override {
    std::optional<Vec3> best;
    for (int along = 0; along < 3; ++along)
      for (int k = 0; k < 4; ++k) {
        Vec3 on = p.cwiseMax(0).cwiseMin(1);
        on[(along + 1) % 3] = k % 2;
        on[(along + 2) % 3] = k / 2;
        if (!best || (on - p).norm() < (*best - p).norm()) best = on;
      }
    return within(p, *best, max_distance);
  }
  std::optional<Vec3> onto_corner(const Vec3& p, double max_distance) const override {
    Vec3 on;
    for (int a = 0; a < 3; ++a) on[a] = p[a] < 0.5 ? 0 : 1;
    return within(p, on, max_distance);
  }

 private:
  static std::optional<Vec3> within(const Vec3& p, const Vec3& on, double max_distance) {
    if ((on - p).norm() <= max_distance) return on;
    return {};
  }
};

TEST(Creases, OfAReferenceAreReachedFromBesideThem) {
  constexpr int n = 10;
  TetMesh before = grid_mesh(n);
  before.interfaces = find_interfaces(before);
  for (Vec3& p : before.points) p /= n;
  for (InterfaceTriangle& t : before.interfaces)
    for (int a = 0; a < 3; ++a)
      for (int side = 0; side < 2; ++side)
        if (before.points[t.ids[0]][a] == side && before.points[t.ids[1]][a] == side &&
            before.points[t.ids[2]][a] == side)
          t.patch = static_cast<std::uint16_t>(2 * a + side);
  // Cut off edges and corners slightly.
  for (Vec3& p : before.points) {
    const auto outer = (p.array() == 0 || p.array() == 1).count();
    if (outer >= 2) p = Vec3::Constant(0.5) + 0.99 * (p - Vec3::Constant(0.5));
  }
  const ExactCube cube;
  SimplifyOptions options;
  options.target_tets = 600;
  options.reference = &cube;
  const TetMesh after = simplify(before, options, nullptr, nullptr);
  const CreaseCurves creases = mesh_creases(after);
  EXPECT_EQ(creases.corners.size(), 8U);
  for (const Vec3& c : creases.corners) EXPECT_LT((*cube.onto_corner(c, 1) - c).norm(), exact);
  for (const Vec3& p : creases.points) EXPECT_LT((*cube.onto_crease(p, 1) - p).norm(), exact);
  EXPECT_NEAR(volume_of(after), 1, 1e-3);
}

TEST(Creases, FitOnlyWhatIsOffThem) {
  TetMesh mesh = block(4, false);
  Workbench w(std::move(mesh));
  const SurfaceProjection projection(w.mesh, nullptr);
  EXPECT_TRUE(projection.has_patches());
  BlockRules rules;
  rules.project_onto(projection, w.mesh.diagonal());
  ASSERT_TRUE(rules.has_patches());
  EXPECT_NEAR(*rules.surface.max_feature_distance, 0.001 * w.mesh.diagonal(), 1e-12);
  rules.error.max = 1e9;
  for (const Index p : w.live_points()) {
    (void)w.star(p);
    EXPECT_EQ(fit_to_crease(*w.ws, rules, 1e-4f), Outcome::no_candidate);
  }
  // Without patches it is not queried for feature edges.
  Workbench smooth(grid_mesh(3));
  const SurfaceProjection none(smooth.mesh, nullptr);
  BlockRules plain;
  plain.project_onto(none, 1);
  EXPECT_FALSE(plain.has_patches());
}

}  // namespace
}  // namespace tetwright::creases_test
