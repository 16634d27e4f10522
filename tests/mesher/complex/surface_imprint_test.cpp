// SPDX-License-Identifier: Apache-2.0
#include "mesher/complex/surface_imprint.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <random>
#include <string>
#include <thread>

#include "common/geometry/self_intersection.h"
#include "mesher/complex/labelled_complex.h"
#include "mesher/complex/triangle_subdivision.h"
#include "tests/mesher/complex/random_bodies.h"
#include "tests/mesher/test_surfaces.h"
#include "tetwright/resources.h"

namespace tetwright {
namespace {

double area(const std::vector<Vec3>& points, const Triangle& t) {
  return (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]).norm() / 2;
}

/// Volume of each region, from the faces around it.
std::vector<double> volumes(const LabelledComplex& complex, std::size_t bodies) {
  std::vector<double> out(bodies + 1, 0);
  for (const LabelledComplex::Face& f : complex.faces) {
    const Vec3 &a = complex.points[f.ids[0]], &b = complex.points[f.ids[1]], &c = complex.points[f.ids[2]];
    const double volume = a.dot(b.cross(c)) / 6;
    out[f.behind] += volume;
    out[f.front] -= volume;
  }
  return out;
}

ComplexResult complex_of(const std::vector<TriangleMesh>& surfaces, double tolerance = 1e-5) {
  const SurfaceSoup soup = soup_of(surfaces);
  const ImprintedSurfaces imprinted = imprint_surfaces(soup, tolerance, nullptr);
  EXPECT_TRUE(imprinted.any);
  EXPECT_FALSE(imprinted.unresolved);
  ComplexResult found = build_complex(imprinted, soup, surfaces.size(), tolerance);
  EXPECT_FALSE(found.inconsistent);
  return found;
}

TEST(TriangleSubdivision, DividesAlongSegments) {
  TriangleSubdivision division({0, 1, 2}, {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)});
  division.add_on_edge(0, 0.5, 3, Vec3(2, 0, 0));
  division.add_on_edge(1, 0.25, 4, Vec3(3, 1, 0));
  division.add_inside(5, Vec3(1, 1, 0));
  division.add_inside(6, Vec3(0.5, 2, 0));
  EXPECT_TRUE(division.constrain(3, 6));
  EXPECT_TRUE(division.constrain(4, 6));
  EXPECT_FALSE(division.constrain(5, 4));  // crosses the first segment
  EXPECT_FALSE(division.constrain(0, 7));
  const std::vector<Vec3> points{{0, 0, 0}, {4, 0, 0}, {0, 4, 0},  {2, 0, 0},
                                 {3, 1, 0}, {1, 1, 0}, {0.5, 2, 0}};
  double sum = 0;
  bool first = false, second = false;
  for (const Triangle& t : division.triangles()) {
    EXPECT_GT((points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]).z(), 0);
    sum += area(points, t);
    for (int k = 0; k < 3; ++k) {
      const auto e = ascending_edge(t[k], t[(k + 1) % 3]);
      first |= e == std::array<Index, 2>{3, 6};
      second |= e == std::array<Index, 2>{4, 6};
    }
  }
  EXPECT_DOUBLE_EQ(sum, 8);
  EXPECT_TRUE(first);
  EXPECT_TRUE(second);
}

TEST(TriangleSubdivision, CoversTheTriangleOnceForRandomPoints) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int round = 0; round < 20; ++round) {
    std::vector<Vec3> points{{0, 0, 0}, {1, 0.1, 0.2}, {0.2, 1, -0.3}};
    TriangleSubdivision division({0, 1, 2}, {points[0], points[1], points[2]});
    for (Index n = 3; n < 60; ++n) {
      double s = unit(random), t = unit(random);
      if (s + t > 1) s = 1 - s, t = 1 - t;
      points.push_back(points[0] + s * (points[1] - points[0]) + t * (points[2] - points[0]));
      division.add_inside(n, points.back());
    }
    for (int k = 0; k < 30; ++k)
      division.constrain(static_cast<Index>(random() % 60), static_cast<Index>(random() % 60));
    const std::vector<Triangle> parts = division.triangles();
    EXPECT_EQ(parts.size(), 2 * 57 + 1U);
    double sum = 0;
    for (const Triangle& t : parts) sum += area(points, t);
    EXPECT_NEAR(sum, area(points, {0, 1, 2}), 1e-12);
  }
}

TEST(SurfaceImprint, LeavesBodiesApartAsTheyAre) {
  const SurfaceSoup soup = soup_of({make_box({0, 0, 0}, {1, 1, 1}), make_box({1.1, 0, 0}, {2, 1, 1})});
  const ImprintedSurfaces imprinted = imprint_surfaces(soup, 1e-5, nullptr);
  EXPECT_FALSE(imprinted.any);
  EXPECT_EQ(imprinted.triangles, soup.triangles);
  EXPECT_EQ(imprinted.points, soup.points);
}

TEST(SurfaceImprint, CrossingBoxesHaveExactVolumesAndNoIntersectionLeft) {
  for (const double angle : {0.0, 0.3, 1.1}) {
    const Vec3 axis(0.3, -0.5, 0.8);
    const ComplexResult found =
        complex_of({turned(make_box({0, 0, 0}, {1, 1, 1}), angle, axis),
                    turned(make_box({0.5, 0.25, -0.5}, {2, 0.75, 0.5}), angle, axis)});
    const std::vector<double> v = volumes(found.complex, 2);
    EXPECT_NEAR(v[1], 1 - 0.125, 1e-9);
    EXPECT_NEAR(v[2], 0.75, 1e-9);
    ASSERT_EQ(found.overlaps.size(), 1U);
    EXPECT_NEAR(found.overlaps[0].volume, 0.125, 1e-9);
    std::vector<Triangle> triangles;
    for (const LabelledComplex::Face& f : found.complex.faces) triangles.push_back(f.ids);
    EXPECT_TRUE(self_intersections(found.complex.points, triangles).empty());
  }
}

TEST(SurfaceImprint, TouchingBoxesOfOtherTessellationsShareOneSheet) {
  for (const double gap : {0.0, 1e-6, -1e-6, 5e-6}) {
    TriangleMesh low = make_box({0, 0, 0}, {1, 1, 1});
    TriangleMesh high = make_box({0.2, 0.3, 1 + gap}, {0.9, 0.8, 2});
    const ComplexResult found = complex_of({turned(low, 0.7, {1, 2, 3}), turned(high, 0.7, {1, 2, 3})});
    ASSERT_EQ(found.contacts.size(), 1U);
    EXPECT_EQ(found.contacts[0].pieces, 1U);
    EXPECT_NEAR(found.contacts[0].area, 0.35, 1e-5);
    EXPECT_NEAR(found.contacts[0].largest_gap, std::max(0.0, gap), 1e-9);
    EXPECT_NEAR(found.contacts[0].largest_overlap, std::max(0.0, -gap), 1e-9);
    EXPECT_TRUE(found.overlaps.empty());
    // Each body's own surface stays closed.
    for (std::size_t b = 0; b < 2; ++b) {
      TriangleMesh own{found.complex.points, found.body_triangles[b]};
      EXPECT_NEAR(enclosed_volume(own), b == 0 ? 1 : 0.35 * (1 - gap), 1e-5);
    }
  }
}

TEST(SurfaceImprint, NestedBodiesDoNotCross) {
  const ComplexResult found =
      complex_of({make_box({0, 0, 0}, {2, 2, 2}), make_box({0.5, 0.5, 0}, {1.5, 1.5, 1})});
  EXPECT_TRUE(found.overlaps.empty());
  const std::vector<double> v = volumes(found.complex, 2);
  EXPECT_NEAR(v[1], 7, 1e-9);
  EXPECT_NEAR(v[2], 1, 1e-9);
}

TEST(SurfaceImprint, BodyGivenTwiceIsLost) {
  const ComplexResult found = complex_of({make_box({0, 0, 0}, {1, 1, 1}), make_box({0, 0, 0}, {1, 1, 1})});
  EXPECT_EQ(found.lost, (std::vector<char>{1, 0}));
}

/// Balls and boxes at random: volumes add up to those of the bodies, whatever they have in common.
TEST(SurfaceImprint, RandomBodiesKeepTheirVolumes) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int round = 0; round < 25; ++round) {
    std::vector<TriangleMesh> bodies;
    for (int b = 0; b < 3; ++b) {
      const Vec3 at(unit(random), unit(random), unit(random)), axis(unit(random), unit(random), unit(random));
      TriangleMesh mesh = random() % 2 == 0 ? make_sphere(0.8, at, 3) : make_box(at, at + Vec3(1, 0.7, 0.9));
      bodies.push_back(turned(std::move(mesh), unit(random), axis));
    }
    const SurfaceSoup soup = soup_of(bodies);
    const ImprintedSurfaces imprinted = imprint_surfaces(soup, 1e-6, nullptr);
    EXPECT_FALSE(imprinted.unresolved) << "round " << round;
    const ComplexResult found = build_complex(imprinted, soup, 3, 1e-6);
    EXPECT_FALSE(found.inconsistent) << "round " << round;
    EXPECT_NEAR(volumes(found.complex, 3)[3], enclosed_volume(bodies[2]), 1e-4) << "round " << round;
    for (std::size_t b = 0; b < 3; ++b)
      EXPECT_NEAR(enclosed_volume({found.complex.points, found.body_triangles[b]}),
                  enclosed_volume(bodies[b]), 1e-4)
          << "round " << round;
  }
}

TEST(SurfaceImprint, DoesNotDependOnTheNumberOfThreads) {
  const SurfaceSoup soup = soup_of({make_sphere(1, {0, 0, 0}, 4), make_sphere(1, {0.7, 0.1, 0.2}, 4)});
  std::vector<ImprintedSurfaces> all;
  for (const unsigned threads : {1U, 2U, 3U}) {
    const ThreadLimit limit(threads);
    all.push_back(imprint_surfaces(soup, 1e-5, nullptr));
  }
  for (const ImprintedSurfaces& other : all) {
    EXPECT_EQ(other.points, all[0].points);
    EXPECT_EQ(other.triangles, all[0].triangles);
    EXPECT_EQ(other.source, all[0].source);
  }
}

/// Triangles at random in the unit cube, each a surface of its own.
SurfaceSoup random_triangles(Index count) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  SurfaceSoup soup;
  for (Index t = 0; t < count; ++t) {
    for (int k = 0; k < 3; ++k) {
      const double x = unit(random), y = unit(random), z = unit(random);
      soup.points.emplace_back(x, y, z);
    }
    soup.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    soup.surface.push_back(t);
  }
  return soup;
}

TEST(SurfaceImprint, OfCrossingTrianglesLeavesNoCrossing) {
  const ImprintedSurfaces imprinted = imprint_surfaces(random_triangles(40), 1e-7, nullptr);
  EXPECT_FALSE(imprinted.unresolved);
  EXPECT_TRUE(self_intersections(imprinted.points, imprinted.triangles).empty());
}

TEST(SurfaceImprint, StopsSoonWhenCancelled) {
  const SurfaceSoup soup = random_triangles(6000);
  Progress progress;
  std::atomic<bool> begun = false;
  std::thread canceller([&] {
    while (!begun) std::this_thread::yield();
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    progress.cancel();
  });
  begun = true;
  const auto start = Progress::Clock::now();
  EXPECT_THROW(imprint_surfaces(soup, 1e-7, &progress), Interrupted);
  EXPECT_LT(std::chrono::duration<double>(Progress::Clock::now() - start).count(), 4);
  canceller.join();
}

TEST(SurfaceImprint, EndsAtItsBoundAndSaysWhere) {
  const SurfaceSoup soup = random_triangles(40);
  const ImprintedSurfaces imprinted = imprint_surfaces(soup, 1e-7, nullptr, {.points = 10, .per_pair = 0});
  EXPECT_TRUE(imprinted.too_many_points);
  ASSERT_TRUE(imprinted.unresolved);
  EXPECT_LT((*imprinted.unresolved - Vec3::Constant(0.5)).cwiseAbs().maxCoeff(), 0.51);
}

TEST(SurfaceImprint, SaysHowMuchMemoryItNeeds) {
  const SurfaceSoup soup = random_triangles(300);
  const MemoryLimit limit(1e6);
  try {
    imprint_surfaces(soup, 1e-7, nullptr);
    FAIL() << "it must be refused";
  } catch (const OutputError& error) {
    EXPECT_NE(std::string(error.what()).find("--memory-limit"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace tetwright
