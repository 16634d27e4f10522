// SPDX-License-Identifier: Apache-2.0

// Compares regions of the labelled complex with an exact arrangement.
#include "tests/mesher/complex/exact_regions.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "common/mesh/disjoint_sets.h"
#include "mesher/complex/labelled_complex.h"
#include "tests/mesher/complex/random_bodies.h"
#include "tests/mesher/test_surfaces.h"

namespace tetwright::exact_regions_test {
namespace {

constexpr double contact_distance = 1e-6;

/// Points, edges and triangles.
struct Simplices {
  std::set<Index> points;
  std::set<std::array<Index, 2>> edges;
  std::set<Triangle> triangles;

  void add(const Triangle& t) {
    Triangle sorted = t;
    std::sort(sorted.begin(), sorted.end());
    triangles.insert(sorted);
    for (std::size_t k = 0; k < 3; ++k) {
      points.insert(t[k]);
      edges.insert(ascending_edge(t[k], t[(k + 1) % 3]));
    }
  }
};

template <class Set>
Set common(const Set& a, const Set& b) {
  Set both;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::inserter(both, both.end()));
  return both;
}

SetShape shape_of(const Simplices& s, std::size_t all_points) {
  SetShape shape;
  shape.euler = static_cast<int>(s.points.size()) - static_cast<int>(s.edges.size()) +
                static_cast<int>(s.triangles.size());
  DisjointSets sets(all_points);
  for (const auto& [a, b] : s.edges) sets.unite(a, b);
  for (const Index p : s.points) shape.components += sets.is_root(p);
  return shape;
}

AssemblyShape regions_of(const LabelledComplex& complex, std::size_t bodies) {
  std::vector<Simplices> boundaries(bodies);
  AssemblyShape shape;
  shape.regions.resize(bodies);
  for (const LabelledComplex::Face& f : complex.faces) {
    const auto& [a, b, c] = f.ids;
    const double volume = complex.points[a].dot(complex.points[b].cross(complex.points[c])) / 6;
    for (const RegionIndex r : {f.behind, f.front}) {
      if (r == outside_region) continue;
      boundaries[r - 1u].add(f.ids);
      shape.regions[r - 1u].volume += r == f.behind ? volume : -volume;
    }
  }
  const std::size_t points = complex.points.size();
  for (std::size_t b = 0; b < bodies; ++b) {
    shape.regions[b].boundary = shape_of(boundaries[b], points);
    for (std::size_t a = 0; a < b; ++a) {
      const Simplices both{common(boundaries[a].points, boundaries[b].points),
                           common(boundaries[a].edges, boundaries[b].edges),
                           common(boundaries[a].triangles, boundaries[b].triangles)};
      if (!both.points.empty()) shape.contacts[{a, b}] = shape_of(both, points);
    }
  }
  return shape;
}

std::string text(const SetShape& s) {
  return "euler " + std::to_string(s.euler) + " components " + std::to_string(s.components);
}

std::string text(const AssemblyShape& s) {
  std::string out;
  for (const RegionShape& r : s.regions) out += text(r.boundary) + "\n";
  for (const auto& [pair, contact] : s.contacts)
    out += std::to_string(pair.first) + "|" + std::to_string(pair.second) + ": " + text(contact) + "\n";
  return out;
}

/// Compares the complex of the bodies with their exact regions, as they are and turned together: contacts of
/// turned bodies are rounded.
/// \return false if a region is so small that the tolerance swallows it, as with a turned body that is given
/// twice
bool expect_exact_regions(const std::vector<TriangleMesh>& bodies) {
  const AssemblyShape exact = exact_regions(bodies);
  for (const RegionShape& r : exact.regions)
    if (r.volume > 0 && r.volume < contact_distance) return false;
  for (const double angle : {0.0, 0.7}) {
    std::vector<TriangleMesh> all;
    for (const TriangleMesh& body : bodies) all.push_back(turned(body, angle, {1, -2, 3}));
    const SurfaceSoup soup = soup_of(all);
    const ImprintedSurfaces imprinted = imprint_surfaces(soup, contact_distance, nullptr);
    EXPECT_FALSE(imprinted.unresolved) << "angle " << angle;
    const ComplexResult found = build_complex(imprinted, soup, bodies.size(), contact_distance);
    EXPECT_FALSE(found.inconsistent) << "angle " << angle;
    const AssemblyShape shape = regions_of(found.complex, bodies.size());
    EXPECT_EQ(text(shape), text(exact)) << "angle " << angle;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      EXPECT_NEAR(shape.regions[b].volume, exact.regions[b].volume, 10 * contact_distance)
          << "angle " << angle;
      EXPECT_EQ(found.lost[b] != 0, exact.regions[b].volume == 0);
    }
  }
  return true;
}

TEST(ExactRegions, OfCrossingAndTouchingBoxes) {
  const std::vector<TriangleMesh> bodies{make_box({0, 0, 0}, {4, 4, 4}), make_box({1, 1, 3}, {2, 2, 6}),
                                         make_box({4, 0, 0}, {5, 4, 4}), make_box({1, 1, -1}, {3, 3, 5})};
  const AssemblyShape exact = exact_regions(bodies);
  EXPECT_DOUBLE_EQ(exact.regions[0].volume, 64 - 16);
  EXPECT_DOUBLE_EQ(exact.regions[1].volume, 3 - 2);
  EXPECT_EQ(text(exact.regions[0].boundary), "euler 0 components 1");  // with a hole
  EXPECT_EQ(text(exact.regions[1].boundary), "euler 2 components 1");
  EXPECT_EQ(text(exact.contacts.at({0, 2})), "euler 1 components 1");
  EXPECT_EQ(text(exact.contacts.at({0, 3})), "euler 0 components 1");  // the sides of the hole
  EXPECT_EQ(exact.contacts.count({2, 3}), 0U);
  EXPECT_TRUE(expect_exact_regions(bodies));
}

TEST(ExactRegions, OfRandomBodies) {
  const char* wanted = std::getenv("TETWRIGHT_RANDOM_ASSEMBLIES");
  const std::uint32_t count = wanted ? static_cast<std::uint32_t>(std::atoi(wanted)) : 60;
  std::uint32_t compared = 0;
  for (std::uint32_t seed = 0; seed < count; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    compared += expect_exact_regions(random_bodies(seed));
  }
  EXPECT_GE(compared, count - count / 50);
  RecordProperty("compared", static_cast<int>(compared));
}

}  // namespace
}  // namespace tetwright::exact_regions_test
