// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <utility>

#include "common/random.h"
#include "common/samples/random_interior.h"
#include "tests/simplify/meshes.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/resources.h"
#include "tetwright/simplify.h"

namespace tetwright::improvement_test {
namespace {

using Tag = std::optional<MaterialTag>;

TetMesh crooked(std::uint64_t seed) {
  TetMesh mesh = grid_mesh({6, 6, 6}, [](int x, int y, int) { return Tag(x < 3 ? 1 : y < 3 ? 2 : 3); });
  jitter(mesh, seed, 0.55);
  return mesh;
}

TEST(Improve, EndsAlsoWithoutABound) {
  ImproveOptions options;
  options.min_solid_angle = 0;
  options.max_iterations = 3;
  EXPECT_TRUE(check_mesh(improve(crooked(1), options)).empty());
}

TEST(Improve, BettersTheShapesAndKeepsTheRest) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const TetMesh mesh = crooked(seed);
    SimplifyReport report;
    const TetMesh after = improve(mesh, ImproveOptions(), &report);
    const MeshStatistics was = mesh_statistics(mesh), is = mesh_statistics(after);
    for (const MeshFinding& f : check_mesh(after)) ADD_FAILURE() << mesh_finding_line(f);
    for (const std::string& d : topology_differences(topology(mesh), topology(after))) ADD_FAILURE() << d;
    EXPECT_NEAR(static_cast<double>(is.tets), static_cast<double>(was.tets),
                0.05 * static_cast<double>(was.tets));
    EXPECT_GT(was.below_count, 20u);
    EXPECT_EQ(is.below_count, 0u);
    EXPECT_GT(is.min_dihedral, 2 * was.min_dihedral);
    for (const auto& [tag, m] : was.materials)
      EXPECT_NEAR(is.materials.at(tag).volume, m.volume, 0.02 * m.volume);
    ASSERT_FALSE(report.iterations.empty());
    for (const IterationReport& it : report.iterations) EXPECT_EQ(it.kind, "improve");
  }
}

TEST(Improve, OpensLoopsOfJunctionCurvesThatAreSmallerThanATet) {
  // Two materials that touch through a hole in a third one, 1/100 of a tet wide.
  TetMesh mesh = grid_mesh({7, 7, 8}, [](int x, int y, int z) {
    const bool hole = x == 3 && y == 3;
    return Tag((z == 3 || z == 4) && !hole ? 3 : z < 4 ? 1 : 2);
  });
  for (Vec3& p : mesh.points)
    if (std::abs(p.x() - 3.5) < 1 && std::abs(p.y() - 3.5) < 1 && p.z() == 4)
      p = Vec3(3.5 + 0.01 * (p.x() - 3.5), 3.5 + 0.01 * (p.y() - 3.5), 4);
  ASSERT_TRUE(check_mesh(mesh).empty());
  ASSERT_LT(mesh_statistics(mesh).min_solid_angle, 0.001);
  const TetMesh after = improve(mesh, ImproveOptions());
  EXPECT_TRUE(check_mesh(after).empty());
  for (const std::string& d : topology_differences(topology(mesh), topology(after))) ADD_FAILURE() << d;
  const MeshStatistics is = mesh_statistics(after);
  EXPECT_GT(is.min_dihedral, 8);  // would be 1 without improvement
  EXPECT_GT(is.min_solid_angle, 0.03);
  EXPECT_EQ(interface_groups(find_interfaces(after)).size(), 6u);  // 1|2 is still among them
}

TEST(Improve, OnlyBelowLeavesTheRestAlone) {
  const TetMesh mesh = crooked(5);
  ImproveOptions options;
  options.only_below = 0.05;
  const TetMesh after = improve(mesh, options);
  const MeshStatistics was = mesh_statistics(mesh, 0.05), is = mesh_statistics(after, 0.05);
  EXPECT_GT(was.below_count, 0u);
  EXPECT_EQ(is.below_count, 0u);
  // Most points have not moved.
  std::set<std::array<double, 3>> places;
  for (const Vec3& p : mesh.points) places.insert({p.x(), p.y(), p.z()});
  std::size_t kept = 0;
  for (const Vec3& p : after.points) kept += places.count({p.x(), p.y(), p.z()});
  EXPECT_GT(kept, after.points.size() * 6 / 10);
}

TEST(Improve, AHigherOnlyBelowDoesMore) {
  const TetMesh mesh = crooked(5);
  std::size_t left = mesh.tets.size();
  for (const double bound : {0.05, 0.1, 0.3}) {
    ImproveOptions options;
    options.only_below = bound;
    const std::size_t below = mesh_statistics(improve(mesh, options), 0.3).below_count;
    EXPECT_LT(below, left) << bound;
    left = below;
  }
}

TEST(Improve, ObjectivesAimAtWhatTheySay) {
  const TetMesh mesh = crooked(6);
  ImproveOptions options;
  options.objective = ShapeObjective::solid_angle;
  const MeshStatistics angle = mesh_statistics(improve(mesh, options));
  options.objective = ShapeObjective::dihedral;
  const MeshStatistics dihedral = mesh_statistics(improve(mesh, options));
  EXPECT_GT(dihedral.min_dihedral, 12);
  EXPECT_LT(dihedral.max_dihedral, 168);
  EXPECT_GT(angle.min_solid_angle, 0.1);
  EXPECT_NE(angle.min_solid_angle, dihedral.min_solid_angle);
}

TEST(Improve, SixThreadsGiveTheBytesOfOne) {
  const TetMesh mesh = crooked(7);
  const auto improved = [&](unsigned threads) {
    const ThreadLimit limit(threads);
    return improve(mesh, ImproveOptions());
  };
  const TetMesh one = improved(1), six = improved(6);
  EXPECT_EQ(one.points, six.points);
  EXPECT_EQ(one.tets, six.tets);
  EXPECT_TRUE(check_mesh(six).empty());
  EXPECT_EQ(mesh_statistics(six).below_count, 0u);
}

// A tet inverted by moving one point is repaired.
TEST(Improve, PutsInvertedTetsRight) {
  TetMesh mesh = grid_mesh(5);
  for (Vec3& p : mesh.points)
    if (p == Vec3(2, 2, 2)) p = Vec3(3.2, 2.1, 2.3);
  ASSERT_FALSE(check_mesh(mesh).empty());
  const TetMesh after = improve(mesh, ImproveOptions());
  for (const MeshFinding& f : check_mesh(after)) ADD_FAILURE() << mesh_finding_line(f);
}

TEST(Improve, RefusesAndCancels) {
  EXPECT_THROW(improve(TetMesh(), ImproveOptions()), InputError);
  Progress progress;
  progress.cancel();
  EXPECT_THROW(improve(grid_mesh(3), ImproveOptions(), nullptr, &progress), Interrupted);
}

// A coarse surface mesh filled with random points, as produced by other programs. Half of the tets are
// slivers.
TEST(Improvement, MendsMeshesWithRandomInteriors) {
  const TetMesh mesh = random_interior(3, 170, 0.25);
  EXPECT_GT(mesh_statistics(mesh, 0.1).below_percent, 35);
  for (const bool free_count : {false, true}) {
    ImproveOptions options;
    options.free_count = free_count;
    const TetMesh after = improve(mesh, options);
    EXPECT_LE(mesh_statistics(after, 0.1).below_percent, 0.5);
    if (!free_count) {
      EXPECT_NEAR(static_cast<double>(after.tets.size()), static_cast<double>(mesh.tets.size()),
                  0.05 * static_cast<double>(mesh.tets.size()));
    }
    for (const MeshFinding& f : check_mesh(after)) ADD_FAILURE() << mesh_finding_line(f);
    for (const std::string& d : topology_differences(topology(mesh), topology(after))) ADD_FAILURE() << d;
  }
}

/// A cube with nine points on each face, filled with tets from its centre that are divided at random points
/// in them until there are `count`: the larger of two random tets is divided each time.
TetMesh divided_at_random(std::size_t count, std::uint64_t seed) {
  TetMesh mesh;
  std::map<std::array<int, 3>, Index> numbers;
  const auto number = [&](const std::array<int, 3>& at) {
    const auto [found, added] = numbers.try_emplace(at, static_cast<Index>(mesh.points.size()));
    if (added) mesh.points.emplace_back(at[0], at[1], at[2]);
    return found->second;
  };
  const Index centre = number({0, 0, 0});
  const auto volume = [&](const Tet& t) {
    const Vec3& a = mesh.points[t[0]];
    return (mesh.points[t[1]] - a).cross(mesh.points[t[2]] - a).dot(mesh.points[t[3]] - a);
  };
  const auto add = [&](Tet t) {
    if (volume(t) < 0) std::swap(t[2], t[3]);
    mesh.tets.push_back(t);
  };
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const int side : {-1, 1})
      for (int i = -1; i < 1; ++i)
        for (int j = -1; j < 1; ++j) {
          const auto corner = [&](int u, int v) {
            std::array<int, 3> at{};
            at[axis] = side, at[(axis + 1) % 3] = u, at[(axis + 2) % 3] = v;
            return number(at);
          };
          const Index a = corner(i, j), b = corner(i + 1, j), c = corner(i + 1, j + 1), d = corner(i, j + 1);
          add({centre, a, b, c});
          add({centre, a, c, d});
        }
  Random random(seed);
  while (mesh.tets.size() < count) {
    const auto any = [&] { return random.below(static_cast<std::uint32_t>(mesh.tets.size())); };
    std::uint32_t chosen = any();
    if (const std::uint32_t other = any(); volume(mesh.tets[other]) > volume(mesh.tets[chosen]))
      chosen = other;
    const Tet tet = mesh.tets[chosen];
    Vec3 place = Vec3::Zero();
    double sum = 0;
    for (const Index p : tet) {
      const double weight = 0.05 + random.uniform();
      place += weight * mesh.points[p];
      sum += weight;
    }
    const auto inner = static_cast<Index>(mesh.points.size());
    mesh.points.emplace_back(place / sum);
    for (std::size_t k = 0; k < 4; ++k) {
      Tet part = tet;
      part[k] = inner;
      if (k == 0)
        mesh.tets[chosen] = part;
      else
        mesh.tets.push_back(part);
    }
  }
  mesh.materials.assign(mesh.tets.size(), 1);
  return mesh;
}

TEST(Improvement, FreeCountLeavesHardlyAPoorTetInRandomInteriors) {
  for (const std::uint64_t seed : {1, 2}) {
    const TetMesh mesh = divided_at_random(1000, seed);
    EXPECT_GT(mesh_statistics(mesh, 0.1).below_percent, 60) << seed;
    ImproveOptions options;
    options.free_count = true;
    const TetMesh after = improve(mesh, options);
    EXPECT_LE(mesh_statistics(after, 0.1).below_percent, 0.2) << seed;
    for (const MeshFinding& f : check_mesh(after)) ADD_FAILURE() << mesh_finding_line(f);
    EXPECT_NEAR(mesh_statistics(after).volume, 8, 0.05);
  }
}

}  // namespace
}  // namespace tetwright::improvement_test
