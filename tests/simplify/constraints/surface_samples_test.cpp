// SPDX-License-Identifier: Apache-2.0
#include "simplify/constraints/surface_samples.h"

#include <cmath>
#include <limits>
#include <map>

#include "simplify/operations/collapse.h"
#include "simplify/operations/smoothing.h"
#include "tests/simplify/workbench.h"
#include "tetwright/mesh_quality.h"

namespace tetwright::surface_samples_test {
namespace {

using Tag = std::optional<MaterialTag>;

/// The boundary of a mesh, oriented outwards; input units.
TriangleMesh boundary_of(const TetMesh& mesh) {
  TriangleMesh out;
  out.points = mesh.points;
  for (const InterfaceTriangle& t : find_interfaces(mesh))
    if (!t.other) out.triangles.push_back(t.ids);
  return out;
}

/// 4 x 4 x 4 cubes with a bump of height 1/4 in the middle of the top.
TetMesh with_bump() {
  TetMesh mesh = grid_mesh(4);
  for (Vec3& p : mesh.points)
    if (p == Vec3(2, 2, 4)) p.z() += 0.25;
  return mesh;
}

/// The record of an existing triangle.
std::uint32_t record_of(const Workbench& w, const MeshTriangle& t) {
  SurfaceGrid::Edit edit;
  edit.removed = {t};
  w.grid.find_records(edit);
  return edit.removed_records.front();
}

/// Number of samples that triangles own. Expects no sample farther from its triangle than stored.
std::size_t count_owned(const Workbench& w) {
  std::size_t count = 0;
  double largest = 0;
  for (const MeshTriangle& t : w.grid.triangles())
    w.samples->for_each(record_of(w, t), [&](const Vec3& p, float) {
      ++count;
      largest = std::max(largest, std::sqrt(squared_distance(p, t.points[0], t.points[1], t.points[2])));
    });
  EXPECT_NEAR(largest, w.samples->largest_distance(), 1e-6 * w.mesh.space().scale());
  return count;
}

TEST(RepresentedSurface, IsTheMeshsOwnWithoutAGivenOne) {
  Workbench w(grid_mesh({4, 4, 4}, [](int x, int, int) { return Tag(x < 2 ? 1 : 2); }));
  const RepresentedSurface surface(w.mesh, nullptr);
  EXPECT_EQ(surface.triangles().items().size(), 2U * 16 * 6 + 2U * 16);
  std::map<RegionId, int> across;
  for (const auto& item : surface.triangles().items()) {
    EXPECT_FALSE(RepresentedSurface::is_given(item));
    ++across[RepresentedSurface::kind_of(item).high];
  }
  EXPECT_EQ(across.at(1), 32);  // the two materials
  EXPECT_EQ(across.at(outside_id), 192);
}

TEST(RepresentedSurface, PartsFarFromTheGivenOneStandForThemselves) {
  const TetMesh mesh = grid_mesh({12, 3, 3}, [](int, int, int) { return Tag(1); });
  TriangleMesh given = boundary_of(mesh);
  std::erase_if(given.triangles, [&](const Triangle& t) { return given.points[t[0]].x() > 4; });
  Workbench w(mesh);
  const RepresentedSurface surface(w.mesh, &given);
  std::size_t own = 0;
  for (const auto& item : surface.triangles().items()) {
    own += !RepresentedSurface::is_given(item);
    if (!RepresentedSurface::is_given(item)) {
      EXPECT_GT(w.mesh.space().to_input(surface.triangles().corner(item, 0)).x(), 5);
    }
  }
  EXPECT_GT(own, 50U);
  EXPECT_LT(own, 200U);
}

TEST(SurfaceSamples, AreOwnedByTheNearestTriangle) {
  TetMesh mesh = grid_mesh(4);
  const TriangleMesh given = boundary_of(mesh);
  for (Vec3& p : mesh.points)
    for (int k = 0; k < 3; ++k)
      if (p[k] > 0 && p[k] < 4) p[k] += 0.3 * std::sin(7 * p.sum());
  Workbench w(mesh);
  w.own_samples(0.7 * w.mesh.space().scale(), &given);
  // Triangles of edge 0.7 have an area of 0.21, six samples each.
  const double expected = 6 * 96 / 0.2122;
  EXPECT_NEAR(static_cast<double>(w.samples->size()), expected, 0.05 * expected);
  EXPECT_EQ(count_owned(w), w.samples->size());
  const auto triangles = w.grid.triangles();
  const auto normal = [](const MeshTriangle& t) {
    return Vec3((t.points[1] - t.points[0]).cross(t.points[2] - t.points[0]));
  };
  for (const MeshTriangle& t : triangles)
    w.samples->for_each(record_of(w, t), [&](const Vec3& p, float) {
      const double own = squared_distance(p, t.points[0], t.points[1], t.points[2]);
      // Skip triangles around an edge of the cube, which face another way.
      for (const MeshTriangle& o : triangles)
        if (std::abs(normal(o).dot(normal(t))) > 0.8 * normal(o).norm() * normal(t).norm()) {
          EXPECT_GE(squared_distance(p, o.points[0], o.points[1], o.points[2]), own - 1e-12);
        }
    });
}

// A plate thinner than its cells are wide: the nearest triangle may be on its other side.
TEST(SurfaceSamples, AreNotOwnedThroughAWall) {
  TetMesh mesh = grid_mesh({4, 4, 1}, [](int, int, int) { return Tag(1); });
  for (Vec3& p : mesh.points) p.z() *= 0.1;
  TriangleMesh given = boundary_of(mesh);
  for (Vec3& p : given.points) p.z() -= 0.07;  // the top is nearer to the mesh's bottom
  Workbench w(mesh);
  w.own_samples(0.5 * w.mesh.space().scale(), &given);
  for (const MeshTriangle& t : w.grid.triangles()) {
    const double z = w.mesh.space().to_input((t.points[0] + t.points[1] + t.points[2]) / 3).z();
    w.samples->for_each(record_of(w, t), [&](const Vec3& p, float) {
      const double at = w.mesh.space().to_input(p).z();
      if (z < 1e-9) {
        EXPECT_LT(at, -0.06);
      }
      if (z > 0.1 - 1e-9) {
        EXPECT_NEAR(at, 0.03, 1e-9);
      }
    });
  }
}

TEST(SurfaceSamples, OfATriangleThatGoesAreHandedOn) {
  Workbench w(with_bump());
  w.own_samples(0.5 * w.mesh.space().scale());
  EXPECT_LT(w.samples->largest_distance(), 1e-9);
  make_bad(w);
  w.star(w.at(2, 2, 4.25));
  ASSERT_EQ(w.carry_out(collapse(*w.ws, w.rules)), Outcome::done);
  w.expect_sound();
  EXPECT_EQ(count_owned(w), w.samples->size());
  // The bump was a vertex, and vertices are samples.
  EXPECT_GT(w.samples->largest_distance(), 0.2 * w.mesh.space().scale());
}

TEST(SurfaceSamples, ThatWouldBeTooFarFromTheirTriangleRefuse) {
  Workbench w(with_bump());
  const double scale = w.mesh.space().scale();
  w.own_samples(0.5 * scale);
  make_bad(w);
  w.rules.deviation.max = 0.2 * scale;
  w.star(w.at(2, 2, 4.25));
  EXPECT_EQ(collapse(*w.ws, w.rules), Outcome::surface_error);
  w.rules.deviation.max = 0.26 * scale;
  w.star(w.at(2, 2, 4.25));
  EXPECT_EQ(w.carry_out(collapse(*w.ws, w.rules)), Outcome::done);
}

// The opposite direction: a triangle without samples must not leave the surface either.
TEST(SurfaceSamples, ATriangleFarFromTheSurfaceIsRefused) {
  Workbench w(grid_mesh(4));
  const double scale = w.mesh.space().scale();
  w.own_samples(20 * scale);  // few samples
  const Index p = w.at(2, 2, 4);
  SurfaceGrid::Edit edit;
  const Star& star = w.star(p);
  const Vec3 to = star.centre_position + Vec3(0, 0, 0.3) * scale;
  for (const auto& t : star.interface_triangles) {
    const Triangle ids{p, star.points[t.first], star.points[t.second]};
    const Vec3 &first = star.positions[t.first], &second = star.positions[t.second];
    edit.removed.push_back({ids, {star.centre_position, first, second}});
    edit.added.push_back({{ids, {to, first, second}}, 0, 0, outside_id});
  }
  ASSERT_TRUE(w.grid.test(edit));
  EXPECT_FALSE(w.samples->reassign_samples(edit, 0.2 * scale));
  EXPECT_TRUE(w.samples->reassign_samples(edit, 0.31 * scale));
  EXPECT_TRUE(w.samples->reassign_samples(edit, std::numeric_limits<double>::infinity()));
}

TEST(SurfaceSamples, StayWithTheirTrianglesThroughCompaction) {
  Workbench w(with_bump());
  w.own_samples(0.5 * w.mesh.space().scale());
  for (const Vec3& at : {Vec3(2, 2, 4.25), Vec3(1, 1, 4), Vec3(0, 2, 2), Vec3(2, 2, 2)}) {
    make_bad(w);
    w.star(w.at(at.x(), at.y(), at.z()));
    ASSERT_EQ(w.carry_out(collapse(*w.ws, w.rules)), Outcome::done);
  }
  using Places = std::multiset<std::array<double, 3>>;
  const auto all = [&] {
    std::map<std::array<double, 3>, Places> out;
    for (const MeshTriangle& t : w.grid.triangles()) {
      const Vec3 centre = t.points[0] + t.points[1] + t.points[2];
      Places& places =
          out[{std::round(1e9 * centre.x()), std::round(1e9 * centre.y()), std::round(1e9 * centre.z())}];
      w.samples->for_each(record_of(w, t), [&](const Vec3& p, float) {
        places.insert({p.x(), p.y(), p.z()});
      });
    }
    return out;
  };
  const auto before = all();
  SlotNumbers numbers;
  w.mesh.compact(64, 32, &numbers);
  w.grid.rebuild(w.mesh, numbers.points);
  EXPECT_EQ(count_owned(w), w.samples->size());
  EXPECT_TRUE(all() == before);
}

}  // namespace
}  // namespace tetwright::surface_samples_test
