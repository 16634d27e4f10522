// SPDX-License-Identifier: Apache-2.0
#include "mesher/level_sets/level_set.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "common/random.h"
#include "tests/mesher/test_surfaces.h"
#include "tetwright/resources.h"

namespace tetwright::level_set_test {
namespace {

RepairedSurface prepared(const TriangleMesh& mesh, std::size_t closed) {
  RepairedSurface s;
  s.points = mesh.points;
  s.triangles = mesh.triangles;
  s.closed = closed;
  s.low = s.high = mesh.points.front();
  for (const Vec3& p : mesh.points) s.low = s.low.cwiseMin(p), s.high = s.high.cwiseMax(p);
  return s;
}

struct Solid {
  GridFrame frame;
  std::shared_ptr<const LevelSet> level_set;
  Solid(const RepairedSurface& s, double cell) : frame(make_grid_frame(s.low, s.high, cell, false)) {
    level_set = LevelSet::of_surface(s, frame, nullptr);
  }
  Solid(const TriangleMesh& mesh, double cell) : Solid(prepared(mesh, mesh.triangles.size()), cell) {}
};

/// The mesh without the triangles for whose centroids `drop` is true.
template <class Drop>
TriangleMesh without(const TriangleMesh& mesh, Drop&& drop) {
  TriangleMesh left{mesh.points, {}};
  for (const Triangle& t : mesh.triangles)
    if (!drop((mesh.points[t[0]] + mesh.points[t[1]] + mesh.points[t[2]]) / 3)) left.triangles.push_back(t);
  return left;
}

template <class Use>
void for_each_node(const GridFrame& frame, Use&& use) {
  for (int x = 0; x <= frame.cells[0]; ++x)
    for (int y = 0; y <= frame.cells[1]; ++y)
      for (int z = 0; z <= frame.cells[2]; ++z) use(x, y, z);
}

/// The largest difference of the distances over a grid edge whose ends lie on both sides, or are both within
/// 1.5 cells, where OpenVDB's distances are exact.
double max_jump(const Solid& solid) {
  LevelSetSampler sampler(*solid.level_set);
  double largest = 0;
  for_each_node(solid.frame, [&](int x, int y, int z) {
    const double a = sampler.at_node(x, y, z);
    for (const double b :
         {sampler.at_node(x + 1, y, z), sampler.at_node(x, y + 1, z), sampler.at_node(x, y, z + 1)})
      if ((a < 0) != (b < 0) || (std::abs(a) < 1.5 && std::abs(b) < 1.5))
        largest = std::max(largest, std::abs(a - b));
  });
  return largest;
}

int corners_inside(LevelSetSampler& sampler, int x, int y, int z) {
  int inside = 0;
  for (int k = 0; k < 8; ++k) inside += sampler.at_node(x + (k & 1), y + (k >> 1 & 1), z + (k >> 2)) < 0;
  return inside;
}

TEST(LevelSet, DistancesOfASphere) {
  const Vec3 centre(1.5, -2, 0.25);
  constexpr double radius = 2, cell = 0.1;
  const Solid sphere(make_sphere(radius, centre, 6), cell);
  Random random(3);
  LevelSetSampler sampler(*sphere.level_set);
  for (int i = 0; i < 2000; ++i) {
    Vec3 direction(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
    direction.normalize();
    const double distance = 9 * (random.uniform() - 0.5);  // cells
    Vec3 gradient;
    const double read =
        sampler.at(sphere.frame.to_grid(centre + (radius + cell * distance) * direction), gradient);
    // Farther than two voxels away OpenVDB propagates distances from voxel to voxel.
    if (std::abs(distance) < 1) {
      EXPECT_NEAR(read, distance, 0.03);
      EXPECT_GT(gradient.normalized().dot(direction), 0.99);
    } else if (std::abs(distance) < 2.5) {
      EXPECT_NEAR(read, distance, 0.2);
    } else {
      EXPECT_EQ(read < 0, distance < 0);
    }
  }
}

// Solid walls and a cavity much wider than the band, over several of the tree's inner nodes of 128 cells.
TEST(LevelSet, SignsBeyondTheBand) {
  const Vec3 c(0.3, 0.1, -0.2);
  const Solid shell(joined(make_sphere(150, c, 3), turned_over(make_sphere(60, c, 3))), 1);
  LevelSetSampler sampler(*shell.level_set);
  const auto& n = shell.frame.cells;
  for (int x = 0; x <= n[0]; x += 5)
    for (int y = 0; y <= n[1]; y += 5)
      for (int z = 0; z <= n[2]; z += 5) {
        const double r = (shell.frame.to_input(Vec3(x, y, z)) - c).norm();
        const double distance = std::max(r - 150, 60 - r);
        if (std::abs(distance) < 8) continue;  // depends on the tessellation of the spheres
        ASSERT_EQ(sampler.at_node(x, y, z), distance < 0 ? -level_set_band : level_set_band)
            << x << ' ' << y << ' ' << z;
      }
}

TEST(LevelSet, InterfaceCellsAreThoseWithBothSigns) {
  const Solid sphere(make_sphere(2, {1.5, -2, 0.25}, 6), 0.25);
  const std::vector<MortonKey> keys = sphere.level_set->interface_cells();
  LevelSetSampler sampler(*sphere.level_set);
  std::size_t found = 0;
  const auto& n = sphere.frame.cells;
  for (int x = 0; x < n[0]; ++x)
    for (int y = 0; y < n[1]; ++y)
      for (int z = 0; z < n[2]; ++z) {
        const int inside = corners_inside(sampler, x, y, z);
        const bool listed = std::binary_search(keys.begin(), keys.end(), morton_encode(x, y, z));
        EXPECT_EQ(listed, inside != 0 && inside != 8);
        found += listed;
      }
  EXPECT_EQ(found, keys.size());
}

// No cell away from the surface is listed, for any position of the surface relative to the tree's leaves.
TEST(LevelSet, NoInterfaceCellsDeepInside) {
  for (double x : {6.5, 7.5, 8.5, 9.5, 10.5, 11.5, 12.5, 13.5}) {
    const Solid boxes(joined(make_box({0, 0, 0}, {2, 2, 2}), make_box({x, 6.5, 6.5}, {x + 30, 36.5, 36.5})),
                      1);
    LevelSetSampler sampler(*boxes.level_set);
    for (const MortonKey key : boxes.level_set->interface_cells()) {
      const auto cell = morton_decode(key);
      const int inside = corners_inside(sampler, static_cast<int>(cell[0]), static_cast<int>(cell[1]),
                                        static_cast<int>(cell[2]));
      ASSERT_TRUE(inside != 0 && inside != 8) << x;
    }
  }
}

TEST(LevelSet, SphereWithAHoleIsCapped) {
  constexpr double radius = 20.3;
  const TriangleMesh sphere = make_sphere(radius, {0.1, 0.2, 0.3}, 5);
  const Solid open(prepared(without(sphere, [](const Vec3& p) { return p.z() > 15.3; }), 0), 1);
  EXPECT_LE(max_jump(open), 1.03);
  LevelSetSampler sampler(*open.level_set);
  // A flat rim has a flat cap. Where cap and sphere are far from each other, the distance is from the closer
  // one.
  const double rim = 15.3;
  for_each_node(open.frame, [&](int x, int y, int z) {
    const Vec3 p = open.frame.to_input(Vec3(x, y, z)) - Vec3(0.1, 0.2, 0.3);
    const double distance = std::max(p.norm() - radius, p.z() + 0.3 - rim);
    const double read = sampler.at_node(x, y, z);
    if (distance < -1.5) {
      EXPECT_LT(read, 0) << p.transpose();
    }
    if (p.norm() > radius + 0.5 || p.z() + 0.3 > rim + 1) {
      EXPECT_GT(read, 0) << p.transpose();
    }
    if (p.z() < 10 && std::abs(distance) < 1.5) {
      EXPECT_NEAR(read, distance, 0.1) << p.transpose();
    }
    if (p.head<2>().norm() < 6 && std::abs(distance) < 1.5) {
      EXPECT_NEAR(read, distance, 0.7) << p.transpose();
    }
  });
}

TEST(LevelSet, SphereWithTrianglesMissing) {
  const TriangleMesh sphere = make_sphere(20.3, {0.1, 0.2, 0.3}, 5);
  Random random(11);
  const TriangleMesh torn = without(sphere, [&](const Vec3&) { return random.uniform() < 0.05; });
  for (const double cell : {1.0, 0.4}) {  // triangles of one and of three cells
    const Solid open(prepared(torn, 0), cell), closed(sphere, cell);
    EXPECT_LE(max_jump(open), 1.03);
    LevelSetSampler torn_sampler(*open.level_set), sampler(*closed.level_set);
    ASSERT_EQ(open.frame.cells, closed.frame.cells);
    double sum = 0, count = 0;
    for_each_node(open.frame, [&](int x, int y, int z) {
      const double expected = sampler.at_node(x, y, z), read = torn_sampler.at_node(x, y, z);
      if (std::abs(expected) > 2) {
        EXPECT_EQ(read < 0, expected < 0);
      } else {
        EXPECT_NEAR(read, expected, 1);
        sum += std::abs(read - expected);
        ++count;
      }
    });
    EXPECT_LT(sum / count, 0.03);
  }
}

// The cap is the disc, wider than the band and next to the bounding box.
TEST(LevelSet, HalfASphere) {
  constexpr double radius = 20.3;
  for (const double height : {0.0, 0.37}) {
    TriangleMesh half =
        without(make_sphere(radius, Vec3::Zero(), 5), [](const Vec3& p) { return p.z() > 0; });
    for (Vec3& p : half.points) p.z() = std::min(p.z(), 0.0) + height;  // unused points would widen the box
    const Solid open(prepared(half, 0), 1);
    EXPECT_LE(max_jump(open), 1.03);
    LevelSetSampler sampler(*open.level_set);
    for_each_node(open.frame, [&](int x, int y, int z) {
      const Vec3 p = open.frame.to_input(Vec3(x, y, z)) - Vec3(0, 0, height);
      const double distance = std::max(p.norm() - radius, p.z());
      const double read = sampler.at_node(x, y, z);
      if (std::abs(distance) > 1) {
        ASSERT_EQ(read < 0, distance < 0) << p.transpose();
      } else if (p.norm() < radius - 3) {
        ASSERT_NEAR(read, distance, 0.3) << p.transpose();
      }
    });
  }
}

TEST(LevelSet, BoxWithoutALid) {
  const Vec3 high(20.2, 17.7, 15.4);
  const TriangleMesh box =
      without(make_box(Vec3::Zero(), high), [&](const Vec3& p) { return p.z() == high.z(); });
  ASSERT_EQ(box.triangles.size(), 10u);
  const Solid open(prepared(box, 0), 1);
  EXPECT_LE(max_jump(open), 1.03);
  LevelSetSampler sampler(*open.level_set);
  for_each_node(open.frame, [&](int x, int y, int z) {
    const Vec3 p = open.frame.to_input(Vec3(x, y, z));
    const double distance = -std::min(p.minCoeff(), (high - p).minCoeff());
    if (std::abs(distance) > 1) {
      ASSERT_EQ(sampler.at_node(x, y, z) < 0, distance < 0) << p.transpose();
    }
  });
}

// An open part extends into a closed one, next to a closed cavity.
TEST(LevelSet, OpenAndClosedPartsTogether) {
  const TriangleMesh closed =
      joined(make_sphere(14.3, {0.1, 0.2, 0.3}), turned_over(make_sphere(6.2, {-4.1, 0.2, 0.3})));
  const TriangleMesh bowl =
      without(make_sphere(10.2, {12.1, 0.2, 0.3}), [](const Vec3& p) { return p.z() > 4; });
  const Solid solid(prepared(joined(closed, bowl), closed.triangles.size()), 1);
  EXPECT_LE(max_jump(solid), 1.03);
  LevelSetSampler sampler(*solid.level_set);
  const auto at = [&](const Vec3& p) { return sampler.at(solid.frame.to_grid(p)); };
  EXPECT_GT(at({-4, 0, 0}), 0);   // the cavity
  EXPECT_LT(at({0, 0, 10}), 0);   // the closed part
  EXPECT_LT(at({19, 0, 0}), 0);   // the open part
  EXPECT_LT(at({9, 0, 0}), 0);    // both
  EXPECT_GT(at({18, 0, 10}), 0);  // above the bowl's cap
}

TEST(LevelSet, SheetsHaveNoInside) {
  TriangleMesh sheet;
  constexpr int n = 30;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) sheet.points.push_back(Vec3(i, j, 0.3 * i + 0.2 * j));
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j) {
      const Index a = i * (n + 1) + j, b = a + n + 1;
      sheet.triangles.push_back({a, b, b + 1});
      sheet.triangles.push_back({a, b + 1, a + 1});
    }
  for (const double cell : {1.0, 0.43}) {
    const Solid solid(prepared(sheet, 0), cell);
    EXPECT_TRUE(solid.level_set->interface_cells().empty());
    LevelSetSampler sampler(*solid.level_set);
    for_each_node(solid.frame, [&](int x, int y, int z) { ASSERT_GT(sampler.at_node(x, y, z), 0); });
  }
}

// Above nested bowls the winding number exceeds 1/2 far beyond the rims.
TEST(LevelSet, NoInsideOutsideTheBox) {
  const auto below = [](const Vec3& p) { return p.z() > -4; };
  TriangleMesh bowls = without(make_sphere(20, {0, 0, 0}, 5), below);
  for (const double shift : {-2.0, -4.0, -6.0})
    bowls = joined(bowls, without(make_sphere(20, {0, 0, shift}, 5), below));
  RepairedSurface s = prepared(bowls, 0);
  s.points.clear();
  std::vector<Index> number(bowls.points.size(), no_index);
  for (Triangle& t : s.triangles)
    for (Index& v : t) {
      if (number[v] == no_index)
        number[v] = static_cast<Index>(s.points.size()), s.points.push_back(bowls.points[v]);
      v = number[v];
    }
  s = prepared({s.points, s.triangles}, 0);
  const Solid solid(s, 1);
  EXPECT_LE(max_jump(solid), 1.03);
  LevelSetSampler sampler(*solid.level_set);
  const Vec3 low = solid.frame.to_grid(s.low), high = solid.frame.to_grid(s.high);
  std::size_t inside = 0;
  for_each_node(solid.frame, [&](int x, int y, int z) {
    if (sampler.at_node(x, y, z) >= 0) return;
    ++inside;
    for (int a = 0; a < 3; ++a) {
      ASSERT_GE((std::array{x, y, z}[a]), low[a]);
      ASSERT_LE((std::array{x, y, z}[a]), high[a]);
    }
  });
  EXPECT_GT(inside, 1000u);
}

TEST(LevelSet, OpenSurfacesGiveTheSameForAnyThreads) {
  const RepairedSurface s = prepared(
      without(make_sphere(20.3, {0.1, 0.2, 0.3}, 5), [](const Vec3& p) { return p.z() > 10 || p.x() > 12; }),
      0);
  std::vector<double> values[2];
  for (const unsigned threads : {1u, 4u}) {
    const ThreadLimit limit(threads);
    const Solid solid(s, 1);
    LevelSetSampler sampler(*solid.level_set);
    for_each_node(solid.frame,
                  [&](int x, int y, int z) { values[threads > 1].push_back(sampler.at_node(x, y, z)); });
  }
  EXPECT_EQ(values[0], values[1]);
}

/// Expects the level set at `depth` to be `distance` plus `depth` near its zero, with the right sign
/// elsewhere.
template <class Distance>
void expect_depth(const RepairedSurface& s, double depth, Distance&& distance) {
  const GridFrame frame = make_grid_frame(s.low, s.high, 1, false);
  const auto level_set = LevelSet::at_depth(s, depth, frame, nullptr);
  LevelSetSampler sampler(*level_set);
  for_each_node(frame, [&](int x, int y, int z) {
    const double expected = distance(frame.to_input(Vec3(x, y, z))) + depth;
    const double read = sampler.at_node(x, y, z);
    ASSERT_NEAR(read, std::clamp<double>(expected, -level_set_band, level_set_band), 0.05)
        << depth << ": " << x << ' ' << y << ' ' << z;
  });
}

TEST(LevelSet, DepthsOfASphere) {
  const Vec3 c(0.1, 0.2, 0.3);
  const TriangleMesh mesh = make_sphere(44.3, c, 5);
  for (const double depth : {2.0, 10.3, 40.0})
    expect_depth(prepared(mesh, mesh.triangles.size()), depth,
                 [&](const Vec3& p) { return (p - c).norm() - 44.3; });
}

TEST(LevelSet, DepthsOfABox) {
  const Vec3 high(30.2, 25.7, 40.4);
  const TriangleMesh mesh = make_box(Vec3::Zero(), high);
  for (const double depth : {0.5, 2.0, 7.7, 12.5})
    expect_depth(prepared(mesh, 12), depth, [&](const Vec3& p) {
      const Vec3 beyond = (-p).cwiseMax(p - high);
      return beyond.maxCoeff() < 0 ? beyond.maxCoeff() : beyond.cwiseMax(0).norm();
    });
}

// The depth is measured from the cap as well.
TEST(LevelSet, DepthBelowACap) {
  const Vec3 high(20.2, 17.7, 15.4);
  const TriangleMesh box =
      without(make_box(Vec3::Zero(), high), [&](const Vec3& p) { return p.z() == high.z(); });
  const RepairedSurface s = prepared(box, 0);
  const GridFrame frame = make_grid_frame(s.low, s.high, 1, false);
  const auto level_set = LevelSet::at_depth(s, 5, frame, nullptr);
  LevelSetSampler sampler(*level_set);
  const auto at = [&](const Vec3& p) { return sampler.at(frame.to_grid(p)); };
  EXPECT_NEAR(at({10, 9, high.z() - 5}), 0, 0.05);
  EXPECT_NEAR(at({10, 9, high.z() - 4}), 1, 0.05);
  EXPECT_GT(at({10, 9, high.z() + 5}), 0);
}

TEST(LevelSet, NothingIsThatDeep) {
  const TriangleMesh mesh = make_sphere(10.3);
  const RepairedSurface s = prepared(mesh, mesh.triangles.size());
  EXPECT_TRUE(LevelSet::at_depth(s, 11, make_grid_frame(s.low, s.high, 1, false), nullptr)
                  ->interface_cells()
                  .empty());
}

TEST(LevelSet, CanBeCancelled) {
  Progress progress;
  progress.cancel();
  const RepairedSurface s = prepared(make_sphere(1), 0);
  EXPECT_THROW(LevelSet::of_surface(s, make_grid_frame(s.low, s.high, 0.1, false), &progress), Interrupted);
}

}  // namespace
}  // namespace tetwright::level_set_test
