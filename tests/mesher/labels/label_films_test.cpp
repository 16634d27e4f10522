// SPDX-License-Identifier: Apache-2.0
#include "mesher/labels/label_films.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "tests/mesher/label_volumes.h"
#include "tests/mesher/test_surfaces.h"
#include "tetwright/resources.h"

namespace tetwright::label_films_test {
namespace {

constexpr double layer = 0.25;

/// The interface of two labels lies at x = 11.5, the border at -0.5 and 23.5.
class LabelFilms : public testing::Test {
 protected:
  LabelFilms() {
    use(make_labels({24, 24, 24}, [](int x, int, int) { return x < 12 ? 1 : 2; }));
  }
  void use(LabelInput labels) {
    field_ = LabelField::make(labels, label_frame(labels, 1, false), false, nullptr);
  }
  tetwright::LabelFilms all_films(std::vector<TriangleMesh> surfaces, double min_film = 0.95 * layer) {
    std::vector<MaterialSurface> named;
    for (TriangleMesh& s : surfaces)
      named.push_back({.name = "body_" + std::to_string(named.size()),
                       .tag = static_cast<MaterialTag>(named.size() + 1),
                       .surface = std::move(s),
                       .file = "body.off"});
    const MesherInput input = make_mesher_input(std::move(named));
    std::vector<SurfacePatches> patches;
    for (const MesherInput::Body& b : input.bodies)
      patches.push_back(find_patches(b.surface.points, b.surface.triangles, {}, {}, "body.off"));
    return find_films(input, patches, *field_, {layer, min_film, false}, nullptr);
  }
  std::vector<RefinementRegion> films(std::vector<TriangleMesh> surfaces, double min_film = 0.95 * layer) {
    return all_films(std::move(surfaces), min_film).finer;
  }
  std::vector<RefinementRegion> films_of(const TriangleMesh& surface) { return films({surface}); }
  static TriangleMesh box_at(double x) { return make_box(Vec3(x, 6, 6), Vec3(18, 16, 17)); }
  static TriangleMesh turned(TriangleMesh mesh, double degrees, const Vec3& around) {
    const Eigen::AngleAxisd turn(degrees * M_PI / 180, Vec3::UnitZ());
    for (Vec3& p : mesh.points) p = around + turn * (p - around);
    return mesh;
  }

  std::shared_ptr<const LabelField> field_;
};

TEST_F(LabelFilms, CellsFitIntoThem) {
  for (int hundredths = 24; hundredths < 97; ++hundredths) {
    const double gap = hundredths / 100.0;
    const std::vector<RefinementRegion> found = films_of(box_at(11.5 + gap));
    // All over the face, and over the interface opposite.
    std::size_t on_face = 0, opposite = 0;
    for (const RefinementRegion& r : found) {
      EXPECT_LE(std::ldexp(1, -r.halvings), std::max(gap, layer) + 0.02) << gap;
      EXPECT_GT(std::ldexp(2, -r.halvings), gap - 0.02) << gap;
      on_face += std::abs(r.place.x() - 11.5 - gap) < 1e-9;
      opposite += std::abs(r.place.x() - 11.5) < 0.05;
    }
    // Points are half a cell apart or nearer, and one is kept in each cell of a quarter.
    EXPECT_GT(on_face + opposite, 10u * 11 * 4) << gap;
  }
  EXPECT_TRUE(films_of(box_at(11.5 + 1.05)).empty());
}

TEST_F(LabelFilms, CreasesWhereThinnerOnesEnd) {
  const std::vector<RefinementRegion> found = films_of(box_at(11.6));
  EXPECT_GE(found.size(), 2u * (10 + 11) * 2);
  for (const RefinementRegion& r : found) {
    EXPECT_EQ(r.halvings, 2);
    EXPECT_NEAR(r.place.x(), 11.6, 1e-9);
    const double off = std::min({std::abs(r.place.y() - 6), std::abs(r.place.y() - 16),
                                 std::abs(r.place.z() - 6), std::abs(r.place.z() - 17)});
    EXPECT_LT(off, 1e-9);
  }
}

TEST_F(LabelFilms, WedgesAreNone) {
  const auto tip = [](double degrees) {
    return turned(make_box(Vec3(12.2, 6, 6), Vec3(18, 12, 17)), degrees, Vec3(12.2, 6, 6));
  };
  EXPECT_FALSE(films_of(tip(10)).empty());
  EXPECT_TRUE(films_of(tip(45)).empty());
  // A box across the interface.
  EXPECT_TRUE(films_of(make_box(Vec3(7.3, 6, 6), Vec3(18, 16, 17))).empty());
}

TEST_F(LabelFilms, AtTheBorder) {
  const std::vector<RefinementRegion> found = films_of(make_box(Vec3(16, 6, 6), Vec3(23.1, 16, 17)));
  EXPECT_FALSE(found.empty());
  for (const RefinementRegion& r : found) EXPECT_EQ(r.halvings, 2);
  EXPECT_TRUE(films_of(make_box(Vec3(16, 6, 6), Vec3(23.5, 16, 17))).empty());
  // The border cannot turn towards the body, as interfaces do.
  const auto too_thin = [&](double x, const std::vector<TriangleMesh>& others = {}) {
    std::vector<TriangleMesh> surfaces{make_box(Vec3(16, 6, 6), Vec3(x, 16, 17))};
    surfaces.insert(surfaces.end(), others.begin(), others.end());
    std::vector<Vec3> points;
    for (const RefinementRegion& r : all_films(surfaces).on_bodies)
      if (r.halvings == tetwright::LabelFilms::too_many_halvings) points.push_back(r.place);
    return points;
  };
  EXPECT_TRUE(too_thin(23.1).empty());
  EXPECT_GT(too_thin(23.4).size(), 100u);
  for (const Vec3& p : too_thin(23.4)) EXPECT_NEAR(p.x(), 23.4, 1e-9);
  EXPECT_TRUE(too_thin(23.495).empty());
  EXPECT_TRUE(too_thin(23.4, {make_box(Vec3(23.4, 4, 4), Vec3(25, 18, 19))}).empty());
  for (const RefinementRegion& r : all_films({box_at(11.6)}).on_bodies)
    EXPECT_NE(r.halvings, tetwright::LabelFilms::too_many_halvings);
  // The outside is not meshed, but the gap to a label is.
  use(make_labels({24, 24, 24}, [](int x, int, int) { return x < 12 ? 1 : 0; }));
  EXPECT_TRUE(films_of(make_box(Vec3(16, 6, 6), Vec3(23.1, 16, 17))).empty());
  EXPECT_TRUE(too_thin(23.4).empty());
  EXPECT_FALSE(films_of(box_at(12)).empty());
}

TEST_F(LabelFilms, NoneInsideOtherBodies) {
  const TriangleMesh box = box_at(12), around = make_box(Vec3(8, 4, 4), Vec3(20, 19, 19));
  EXPECT_FALSE(films({box}).empty());
  EXPECT_TRUE(films({around, box}).empty());
}

TEST_F(LabelFilms, ThinnerOnesIfAsked) {
  const std::vector<RefinementRegion> found = films({box_at(11.6)}, 0.02);
  EXPECT_GT(found.size(), 10u * 11 * 4);
}

TEST_F(LabelFilms, NarrowTrianglesHaveFewPoints) {
  // A strip of needles along the interface.
  TriangleMesh prism = make_box(Vec3(12, 4, 4), Vec3(14, 4.05, 20));
  EXPECT_LT(films_of(prism).size(), 2000u);
}

TEST_F(LabelFilms, AnyAxesAndThreads) {
  Eigen::Matrix3d mirrored = Eigen::Vector3d(-1, 1, 1).asDiagonal();
  const auto labels = [&](const Eigen::Matrix3d& axes, const Vec3& origin) {
    return make_labels(
        {24, 24, 24}, [](int x, int, int) { return x < 12 ? 1 : 2; }, axes, origin);
  };
  use(labels(mirrored, Vec3(23, 0, 0)));
  // The interface is at 11.5 from the other side.
  EXPECT_FALSE(films_of(make_box(Vec3(5, 6, 6), Vec3(11, 16, 17))).empty());
  EXPECT_TRUE(films_of(make_box(Vec3(5, 6, 6), Vec3(10.4, 16, 17))).empty());
  const auto with = [&](unsigned threads) {
    const ThreadLimit limit(threads);
    std::vector<Vec3> places;
    for (const RefinementRegion& r : films_of(make_sphere(6, Vec3(6, 12, 12), 5))) places.push_back(r.place);
    return places;
  };
  EXPECT_FALSE(with(1).empty());
  EXPECT_EQ(with(1), with(8));
}

}  // namespace
}  // namespace tetwright::label_films_test
