// SPDX-License-Identifier: Apache-2.0
#include "tetwright/embedding.h"

#include <gtest/gtest.h>

#include <variant>

#include "common/geometry/point_triangle.h"
#include "common/geometry/predicates.h"
#include "common/random.h"
#include "common/samples/samples.h"
#include "tests/common/small_meshes.h"
#include "tests/simplify/meshes.h"
#include "tetwright/error.h"
#include "tetwright/resources.h"

namespace tetwright::embedding_test {
namespace {

TetMesh jittered(std::uint64_t seed) {
  TetMesh mesh = grid_mesh(4);
  jitter(mesh, seed);
  return mesh;
}

/// A mesh of which two in five tets are slivers.
TetMesh slivers() { return std::get<TetMesh>(make_sample("random-interior-small")); }

Vec3 in_box(Random& random, const Vec3& low, const Vec3& high) {
  return low + (high - low).cwiseProduct(Vec3(random.uniform(), random.uniform(), random.uniform()));
}

Vec3 carried(const TetMesh& mesh, const Embedding& embedding, std::size_t p) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < 4; ++i) sum += embedding.weights[p][i] * mesh.points[embedding.nodes[p][i]];
  return sum;
}

std::array<Vec3, 4> corners(const TetMesh& mesh, std::size_t t) {
  const Tet& v = mesh.tets[t];
  return {mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]], mesh.points[v[3]]};
}

bool contains(const std::array<Vec3, 4>& c, const Vec3& p) {
  return orient3d(p, c[1], c[2], c[3]) >= 0 && orient3d(c[0], p, c[2], c[3]) >= 0 &&
         orient3d(c[0], c[1], p, c[3]) >= 0 && orient3d(c[0], c[1], c[2], p) >= 0;
}

/// First tet that contains the point, or no_index.
Index first_containing(const TetMesh& mesh, const Vec3& p) {
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    if (contains(corners(mesh, t), p)) return static_cast<Index>(t);
  return no_index;
}

/// Distance from the faces of all tets.
double distance_of(const TetMesh& mesh, const Vec3& p) {
  double squared = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const auto c = corners(mesh, t);
    for (const auto& f : tet_faces)
      squared = std::min(squared, squared_distance(p, c[f[0]], c[f[1]], c[f[2]]));
  }
  return std::sqrt(squared);
}

void expect_weights(const Embedding& embedding) {
  for (const auto& w : embedding.weights) {
    double sum = 0;
    for (const double x : w) {
      EXPECT_GE(x, 0);
      EXPECT_LE(x, 1);
      sum += x;
    }
    EXPECT_NEAR(sum, 1, 1e-15);
  }
}

/// Points in all tets, many of them near faces.
std::vector<Vec3> points_within(const TetMesh& mesh, std::uint64_t seed) {
  Random random(seed);
  std::vector<Vec3> points;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    std::array<double, 4> w;
    double sum = 0;
    for (double& x : w) sum += x = std::pow(random.uniform(), 6);
    Vec3 p = Vec3::Zero();
    for (std::size_t i = 0; i < 4; ++i) p += w[i] / sum * corners(mesh, t)[i];
    points.push_back(p);
  }
  return points;
}

TEST(Embedding, ReproducesLinearFieldsWithin) {
  for (const TetMesh& mesh : {jittered(1), jittered(2), slivers()}) {
    const std::vector<Vec3> points = points_within(mesh, 3);
    const Embedding embedding = embed_points(mesh, points);
    ASSERT_EQ(embedding.tets.size(), points.size());
    expect_weights(embedding);
    const auto field = [](const Vec3& p) { return 3 * p.x() - 5 * p.y() + 7 * p.z() + 2; };
    for (std::size_t p = 0; p < points.size(); ++p) {
      EXPECT_LE(embedding.distances[p], 1e-15);  // rounding may put a point just outside the mesh
      EXPECT_EQ(embedding.nodes[p], mesh.tets[embedding.tets[p]]);
      EXPECT_LE((carried(mesh, embedding, p) - points[p]).norm(), 4e-15);
      double sum = 0;
      for (std::size_t i = 0; i < 4; ++i)
        sum += embedding.weights[p][i] * field(mesh.points[embedding.nodes[p][i]]);
      EXPECT_NEAR(sum, field(points[p]), 1e-12);
    }
  }
}

TEST(Embedding, FindsTheFirstTetThatContainsThePoint) {
  const TetMesh mesh = grid_mesh(3);
  std::vector<Vec3> points;
  for (int x = 0; x <= 12; ++x)
    for (int y = 0; y <= 12; ++y)
      for (int z = 0; z <= 12; ++z) points.emplace_back(x / 4., y / 4., z / 4.);
  const Embedding embedding = embed_points(mesh, points);
  for (std::size_t p = 0; p < points.size(); ++p) {
    EXPECT_EQ(embedding.tets[p], first_containing(mesh, points[p])) << points[p].transpose();
    EXPECT_EQ(embedding.distances[p], 0);
    EXPECT_EQ(carried(mesh, embedding, p), points[p]);
  }
}

TEST(Embedding, GivesPointsOfTheMeshTheirWholeWeight) {
  const TetMesh mesh = slivers();
  const Embedding embedding = embed_points(mesh, mesh.points);
  for (std::size_t p = 0; p < mesh.points.size(); ++p) {
    EXPECT_EQ(*std::max_element(embedding.weights[p].begin(), embedding.weights[p].end()), 1);
    EXPECT_EQ(carried(mesh, embedding, p), mesh.points[p]);
  }
  const EmbeddingSummary summary = summary_of(embedding, mesh, mesh.points);
  EXPECT_EQ(summary.outside, 0u);
  EXPECT_EQ(summary.largest_distance, 0);
}

TEST(Embedding, PointsOutsideGetTheNearestPointOfATet) {
  Random random(5);
  for (const TetMesh& mesh : {jittered(4), slivers()}) {
    Vec3 low = mesh.points[0], high = low;
    for (const Vec3& p : mesh.points) low = low.cwiseMin(p), high = high.cwiseMax(p);
    const Vec3 margin = (high - low) / 2;
    std::vector<Vec3> points;
    for (int i = 0; i < 300; ++i) points.push_back(in_box(random, low - margin, high + margin));
    const Embedding embedding = embed_points(mesh, points);
    expect_weights(embedding);
    std::size_t outside = 0;
    double largest = 0;
    for (std::size_t p = 0; p < points.size(); ++p) {
      EXPECT_NEAR((carried(mesh, embedding, p) - points[p]).norm(), embedding.distances[p], 4e-15);
      if (first_containing(mesh, points[p]) != no_index) {
        EXPECT_EQ(embedding.distances[p], 0);
        continue;
      }
      ++outside;
      EXPECT_DOUBLE_EQ(embedding.distances[p], distance_of(mesh, points[p]));
      largest = std::max(largest, embedding.distances[p]);
    }
    EXPECT_GT(outside, 50u);
    const EmbeddingSummary summary = summary_of(embedding, mesh, points);
    EXPECT_EQ(summary.points, points.size());
    EXPECT_EQ(summary.outside, outside);
    EXPECT_EQ(summary.largest_distance, largest);
    EXPECT_DOUBLE_EQ(distance_of(mesh, summary.place), largest);
  }
}

TEST(Embedding, AMillionthOfTheDiagonalIsNotOutside) {
  const TetMesh mesh = one_tet();
  const std::vector<Vec3> points{{0.2, 0.2, -1e-6}, {0.2, 0.2, -2e-6}};
  const Embedding embedding = embed_points(mesh, points);
  EXPECT_DOUBLE_EQ(embedding.distances[0], 1e-6);
  EXPECT_EQ(summary_of(embedding, mesh, points).outside, 1u);  // the diagonal is 1.7
}

TEST(Embedding, SkipsFlatAndInvertedTets) {
  // The second tet is inverted, the third flat; the point (0, 0, -1) has the first one's face below it.
  TetMesh mesh = two_tets();
  std::swap(mesh.tets[1][0], mesh.tets[1][1]);
  mesh.points.emplace_back(1, 1, 0);
  mesh.tets.push_back({0, 1, 2, 5});
  mesh.materials.push_back(1);
  const std::vector<Vec3> points{{0.1, 0.1, -0.2}, {0.9, 0.9, 0}, {0.1, 0.1, 0.1}};
  const Embedding embedding = embed_points(mesh, points);
  EXPECT_EQ(embedding.tets, (std::vector<Index>{0, 0, 0}));
  EXPECT_DOUBLE_EQ(embedding.distances[0], 0.2);
  EXPECT_NEAR((carried(mesh, embedding, 0) - Vec3(0.1, 0.1, 0)).norm(), 0, 1e-15);
  EXPECT_GT(embedding.distances[1], 0.5);
  EXPECT_EQ(embedding.distances[2], 0);
  mesh.tets.erase(mesh.tets.begin());
  mesh.materials.pop_back();
  try {
    (void)embed_points(mesh, points, "m.vtu");
    ADD_FAILURE() << "no tet is positive";
  } catch (const InputError& e) {
    EXPECT_EQ(std::string(e.what()).rfind("m.vtu: none of its 2 tets has a positive volume", 0), 0u)
        << e.what();
  }
}

TEST(Embedding, DoesNotDependOnThreads) {
  const TetMesh mesh = jittered(7);
  Random random(8);
  std::vector<Vec3> points;
  for (int i = 0; i < 5000; ++i) points.push_back(in_box(random, Vec3::Constant(-1), Vec3::Constant(5)));
  const Embedding expected = embed_points(mesh, points);
  for (const unsigned threads : {1u, 2u, 5u}) {
    const ThreadLimit limit(threads);
    const Embedding embedding = embed_points(mesh, points);
    EXPECT_EQ(embedding.tets, expected.tets);
    EXPECT_EQ(embedding.weights, expected.weights);
    EXPECT_EQ(embedding.distances, expected.distances);
  }
}

TEST(Embedding, OfNoPointsIsEmpty) {
  EXPECT_TRUE(embed_points(one_tet(), {}).tets.empty());
  EXPECT_EQ(summary_of({}, one_tet(), {}).points, 0u);
}

}  // namespace
}  // namespace tetwright::embedding_test
