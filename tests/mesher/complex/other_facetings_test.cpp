// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "common/geometry/self_intersection.h"
#include "mesher/complex/labelled_complex.h"
#include "mesher/complex/surface_imprint.h"
#include "tests/mesher/complex/random_bodies.h"
#include "tests/mesher/test_surfaces.h"
#include "tetwright/resources.h"

namespace tetwright {
namespace {

constexpr double radius = 0.5, half_height = 0.4, pin_low = -0.8, pin_high = 0.7;

/// A pin in a hole of the same nominal radius.
struct Faceting {
  int hole_facets, hole_layers, pin_facets, pin_layers;
  double pin_phase;  ///< by which the pin is turned, degrees
};

/// A surface of revolution around z through closed rings of facets, oriented outwards.
/// \param profile radii and heights; the axis beside or above it on the left. Begins and ends on the axis, or
///   closes itself
TriangleMesh revolved(const std::vector<std::array<double, 2>>& profile, int facets, double phase = 0) {
  TriangleMesh mesh;
  std::vector<std::vector<Index>> rings;
  for (const auto& [r, z] : profile) {
    rings.emplace_back();
    for (int k = 0; k < facets; ++k) {
      if (r > 0 || k == 0) {
        const double angle = phase * std::numbers::pi / 180 + 2 * std::numbers::pi * k / facets;
        mesh.points.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
      }
      rings.back().push_back(static_cast<Index>(mesh.points.size() - 1));
    }
  }
  const bool open = profile.front()[0] == 0;
  const auto n = static_cast<std::size_t>(facets);
  for (std::size_t i = 0; i + (open ? 1 : 0) < rings.size(); ++i) {
    const std::vector<Index>&low = rings[i], &high = rings[(i + 1) % rings.size()];
    for (std::size_t k = 0; k < n; ++k) {
      const Triangle first{low[k], low[(k + 1) % n], high[(k + 1) % n]},
          second{low[k], high[(k + 1) % n], high[k]};
      if (first[0] != first[1]) mesh.triangles.push_back(first);
      if (second[1] != second[2]) mesh.triangles.push_back(second);
    }
  }
  return mesh;
}

std::vector<std::array<double, 2>> divided(std::array<double, 2> from, std::array<double, 2> to, int parts) {
  std::vector<std::array<double, 2>> out;
  for (int k = 0; k < parts; ++k) {
    const double t = static_cast<double>(k) / parts;
    out.push_back({from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])});
  }
  return out;
}

std::vector<TriangleMesh> bodies_of(const Faceting& f) {
  std::vector<std::array<double, 2>> ring =
      divided({radius, half_height}, {radius, -half_height}, f.hole_layers);
  ring.push_back({radius, -half_height});
  ring.push_back({1, -half_height});
  ring.push_back({1, half_height});
  std::vector<std::array<double, 2>> pin{{0, pin_low}};
  for (const auto& p : divided({radius, pin_low}, {radius, pin_high}, f.pin_layers)) pin.push_back(p);
  pin.push_back({radius, pin_high});
  pin.push_back({0, pin_high});
  return {revolved(ring, f.hole_facets), revolved(pin, f.pin_facets, f.pin_phase)};
}

double polygon_area(int facets) {
  return facets / 2.0 * radius * radius * std::sin(2 * std::numbers::pi / facets);
}

/// Half more than the largest distance between the facets, which is below the larger sagitta.
double tolerance_of(const Faceting& f) {
  return 1.5 * radius * (1 - std::cos(std::numbers::pi / std::min(f.hole_facets, f.pin_facets)));
}

double volume_of(const LabelledComplex& complex, RegionIndex region) {
  double out = 0;
  for (const LabelledComplex::Face& f : complex.faces) {
    const auto& [a, b, c] = f.ids;
    const double volume = complex.points[a].dot(complex.points[b].cross(complex.points[c])) / 6;
    out += (f.behind == region ? volume : 0) - (f.front == region ? volume : 0);
  }
  return out;
}

int contact_euler(const LabelledComplex& complex) {
  std::set<Index> points;
  std::set<std::array<Index, 2>> edges;
  int faces = 0;
  for (Index f = 0; f < complex.faces.size(); ++f) {
    if (!complex.is_contact(f)) continue;
    ++faces;
    const Triangle& t = complex.faces[f].ids;
    for (std::size_t k = 0; k < 3; ++k) {
      points.insert(t[k]);
      edges.insert(ascending_edge(t[k], t[(k + 1) % 3]));
    }
  }
  return static_cast<int>(points.size()) - static_cast<int>(edges.size()) + faces;
}

class PinFacetings : public testing::TestWithParam<Faceting> {};

TEST_P(PinFacetings, OfPinAndHoleShareOneSheet) {
  const Faceting& f = GetParam();
  const double tolerance = tolerance_of(f);
  const SurfaceSoup soup = soup_of(bodies_of(f));
  const ImprintedSurfaces imprinted = imprint_surfaces(soup, tolerance, nullptr);
  ASSERT_FALSE(imprinted.unresolved);
  const ComplexResult found = build_complex(imprinted, soup, 2, tolerance);
  ASSERT_FALSE(found.inconsistent);
  EXPECT_TRUE(found.overlaps.empty());
  ASSERT_EQ(found.contacts.size(), 1U);
  // One sheet, a cylinder's wall: no slit to the outside, and no hole.
  EXPECT_EQ(found.contacts[0].pieces, 1U);
  EXPECT_EQ(contact_euler(found.complex), 0);
  EXPECT_NEAR(found.contacts[0].area, 2 * std::numbers::pi * radius * 2 * half_height, 0.03);
  EXPECT_LE(found.contacts[0].largest_gap, tolerance);
  EXPECT_LE(found.contacts[0].largest_overlap, tolerance);
  // Each volume is between those with either faceting, but for the twist between turned facets at the rims.
  const double low = polygon_area(std::min(f.hole_facets, f.pin_facets)),
               high = polygon_area(std::max(f.hole_facets, f.pin_facets)), slack = 3e-4;
  const double pin = volume_of(found.complex, 2), block = volume_of(found.complex, 1);
  EXPECT_GE(pin, low * (pin_high - pin_low) - slack);
  EXPECT_LE(pin, high * (pin_high - pin_low) + slack);
  const double full = polygon_area(f.hole_facets) * 4 * 2 * half_height;
  EXPECT_GE(block, full - high * 2 * half_height - slack);
  EXPECT_LE(block, full - low * 2 * half_height + slack);
  // All that is left of the surfaces is apart, or shares points or an edge.
  std::vector<Triangle> triangles;
  for (const LabelledComplex::Face& face : found.complex.faces) triangles.push_back(face.ids);
  EXPECT_TRUE(self_intersections(found.complex.points, triangles).empty());
}

INSTANTIATE_TEST_SUITE_P(Pins, PinFacetings,
                         testing::Values(Faceting{32, 6, 24, 10, 0}, Faceting{24, 6, 24, 10, 3},
                                         Faceting{24, 5, 32, 9, 0}, Faceting{32, 3, 24, 16, 0.5},
                                         Faceting{32, 5, 32, 12, 1.5}, Faceting{16, 4, 24, 8, 2},
                                         Faceting{16, 7, 24, 16, 1}, Faceting{16, 7, 32, 16, 2},
                                         Faceting{16, 6, 16, 10, 2}, Faceting{24, 7, 16, 16, 1}));

/// A tolerance above the size of facets is no tolerance any more: the imprint ends nevertheless, and says so
/// or leaves bodies that are closed.
TEST(OtherFacetings, ToleranceAboveFacetsIsReportedOrHarmless) {
  const SurfaceSoup soup = soup_of(bodies_of({32, 12, 32, 24, 2}));
  for (const double tolerance : {0.05, 0.1, 0.2}) {
    SCOPED_TRACE(tolerance);
    const ImprintedSurfaces imprinted = imprint_surfaces(soup, tolerance, nullptr);
    if (imprinted.unresolved) continue;
    const ComplexResult found = build_complex(imprinted, soup, 2, tolerance);
    if (found.inconsistent || found.torn) continue;
    const double full = polygon_area(32);
    // The contact, and the faces beside it, move by at most the tolerance.
    const double contact_area = 2 * std::numbers::pi * radius * 2 * half_height;
    EXPECT_NEAR(volume_of(found.complex, 1), full * 3 * 2 * half_height, tolerance * contact_area);
    EXPECT_NEAR(volume_of(found.complex, 2), full * (pin_high - pin_low), tolerance * contact_area);
  }
}

TEST(OtherFacetings, NumbersOfThreadsDoNotChangeAnything) {
  const Faceting f{16, 7, 32, 16, 2};
  const SurfaceSoup soup = soup_of(bodies_of(f));
  std::vector<ImprintedSurfaces> all;
  for (const unsigned threads : {1U, 3U}) {
    const ThreadLimit limit(threads);
    all.push_back(imprint_surfaces(soup, tolerance_of(f), nullptr));
  }
  EXPECT_EQ(all[1].points, all[0].points);
  EXPECT_EQ(all[1].triangles, all[0].triangles);
}

}  // namespace
}  // namespace tetwright
