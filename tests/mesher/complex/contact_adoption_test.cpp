// SPDX-License-Identifier: Apache-2.0
#include "mesher/complex/contact_adoption.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "common/geometry/self_intersection.h"
#include "mesher/complex/labelled_complex.h"
#include "tests/mesher/complex/complex_measures.h"
#include "tests/mesher/complex/random_bodies.h"
#include "tests/mesher/test_surfaces.h"
#include "tetwright/mesher_input.h"

namespace tetwright {
namespace {

constexpr double tube_radius = 1, outer_radius = 1.25, half_length = 1.5, full_turn = 2 * std::numbers::pi;

/// A lens on the inside of a tube, with an elliptic rim at which both of its sides meet at a small angle.
struct Lens {
  int tube_facets, tube_layers, segments, rings;
  double width, length, height;  ///< half axes of its rim, largest thickness
  double shift, twist;           ///< around the tube, of the rim in itself; radians
};

TriangleMesh tube_of(const Lens& lens) {
  TriangleMesh mesh;
  const auto n = static_cast<Index>(lens.tube_facets), layers = static_cast<Index>(lens.tube_layers);
  // Rings along the inside upwards, then along the outside downwards.
  std::vector<std::array<double, 2>> profile;
  for (Index i = 0; i <= layers; ++i) profile.push_back({tube_radius, half_length * (2.0 * i / layers - 1)});
  profile.push_back({outer_radius, half_length});
  profile.push_back({outer_radius, -half_length});
  const auto rings = static_cast<Index>(profile.size());
  for (const auto& [r, z] : profile)
    for (Index k = 0; k < n; ++k)
      mesh.points.emplace_back(r * std::cos(full_turn * k / n), r * std::sin(full_turn * k / n), z);
  for (Index i = 0; i < rings; ++i)
    for (Index k = 0; k < n; ++k) {
      const Index a = i * n + k, b = i * n + (k + 1) % n, up = (i + 1) % rings * n;
      const Index c = up + (k + 1) % n, d = up + k;
      mesh.triangles.push_back({a, c, b});
      mesh.triangles.push_back({a, d, c});
    }
  return mesh;
}

TriangleMesh mesh_of(const Lens& lens) {
  TriangleMesh mesh;
  const auto n = static_cast<Index>(lens.segments), rings = static_cast<Index>(lens.rings);
  const auto add = [&](double rho, double phi, bool top) {
    const double u = rho * lens.width * std::cos(phi), v = rho * lens.length * std::sin(phi);
    const double angle = (u * std::cos(lens.twist) - v * std::sin(lens.twist)) / tube_radius + lens.shift;
    const double z = u * std::sin(lens.twist) + v * std::cos(lens.twist);
    const double r = tube_radius - (top ? lens.height * (1 - rho * rho) : 0);
    mesh.points.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
  };
  // The rim, then the inner rings of both sides, then their centres.
  for (Index i = 0; i < rings; ++i)
    for (int side = 0; side < (i == 0 ? 1 : 2); ++side)
      for (Index k = 0; k < n; ++k) add(1 - static_cast<double>(i) / rings, full_turn * k / n, side == 1);
  add(0, 0, false);
  add(0, 0, true);
  for (Index side = 0; side < 2; ++side) {
    const auto at = [&](Index i, Index k) { return i == 0 ? k % n : n + ((i - 1) * 2 + side) * n + k % n; };
    const auto put = [&](Index a, Index b, Index c) {
      if (side == 1) std::swap(b, c);
      mesh.triangles.push_back({a, b, c});
    };
    for (Index k = 0; k < n; ++k) {
      for (Index i = 0; i + 1 < rings; ++i) {
        put(at(i, k), at(i, k + 1), at(i + 1, k + 1));
        put(at(i, k), at(i + 1, k + 1), at(i + 1, k));
      }
      put(at(rings - 1, k), at(rings - 1, k + 1), static_cast<Index>(mesh.points.size() - 2 + side));
    }
  }
  return mesh;
}

/// Largest distance between the facets of the wall and those of the lens.
double misfit_of(const Lens& lens, const TriangleMesh& mesh) {
  double out = tube_radius * (1 - std::cos(std::numbers::pi / lens.tube_facets));
  for (std::size_t t = 0; t < mesh.triangles.size() / 2; ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    for (const Vec3& p :
         {Vec3((mesh.points[a] + mesh.points[b]) / 2), Vec3((mesh.points[b] + mesh.points[c]) / 2),
          Vec3((mesh.points[c] + mesh.points[a]) / 2)})
      out = std::max(out, tube_radius - p.head<2>().norm());
  }
  return out;
}

class Lenses : public testing::TestWithParam<Lens> {};

TEST_P(Lenses, ShareOneSheetWithTheWall) {
  const Lens& lens = GetParam();
  const TriangleMesh tube = tube_of(lens), own = mesh_of(lens);
  const double misfit = misfit_of(lens, own), tolerance = 1.5 * misfit;
  const SurfaceSoup soup = soup_of({tube, own});
  const std::optional<ImprintedSurfaces> imprinted = imprint_adopted(soup, 2, tolerance, nullptr);
  ASSERT_TRUE(imprinted);
  const ComplexResult found = build_complex(*imprinted, soup, 2, tolerance);
  ASSERT_FALSE(found.inconsistent);
  EXPECT_TRUE(found.overlaps.empty());
  ASSERT_EQ(found.contacts.size(), 1U);
  // One disc.
  EXPECT_EQ(found.contacts[0].pieces, 1U);
  EXPECT_EQ(contact_euler(found.complex), 1);
  const double area = std::numbers::pi * lens.width * lens.length;
  EXPECT_NEAR(found.contacts[0].area, area, 0.03 * area);
  // The wall keeps its facets; the lens gets them.
  EXPECT_NEAR(volume_of(found.complex, 1), enclosed_volume(tube), 0.02 * misfit * area);
  const double volume = volume_of(found.complex, 2);
  EXPECT_LE(std::abs(volume - enclosed_volume(own)), misfit * area);
  std::vector<Triangle> triangles;
  for (const LabelledComplex::Face& face : found.complex.faces) triangles.push_back(face.ids);
  EXPECT_TRUE(self_intersections(found.complex.points, triangles).empty());
  // Each triangle knows one of its own body.
  for (std::size_t i = 0; i < imprinted->triangles.size(); ++i)
    ASSERT_LT(imprinted->source[i], soup.triangles.size());
}

INSTANTIATE_TEST_SUITE_P(Walls, Lenses,
                         testing::Values(Lens{48, 12, 40, 8, 0.6, 0.8, 0.15, 0, 0},
                                         Lens{48, 12, 40, 8, 0.6, 0.8, 0.15, 0.03, 0.4},
                                         Lens{64, 9, 36, 6, 0.5, 0.9, 0.2, 0.01, 0.2},
                                         Lens{40, 20, 48, 8, 0.7, 0.7, 0.25, 0.05, 0},
                                         Lens{72, 15, 30, 5, 0.4, 0.6, 0.12, 0.02, 1.1},
                                         Lens{32, 7, 56, 6, 0.6, 0.6, 0.3, 0.07, 0.7}));

/// The imprint alone leaves surfaces that cross at the rim.
TEST(ContactAdoption, JoinsBodiesIfTheToleranceIsGiven) {
  const Lens lens{48, 12, 40, 8, 0.6, 0.8, 0.15, 0, 0};
  const TriangleMesh tube = tube_of(lens), own = mesh_of(lens);
  ContactOptions contact;
  contact.tolerance = 1.5 * misfit_of(lens, own);
  const MesherInput input = make_mesher_input({{"tube", 1, tube, "tube.off"}, {"lens", 2, own, "lens.off"}},
                                              {}, NestedRule::automatic, contact);
  EXPECT_TRUE(input.complex);
  EXPECT_TRUE(input.findings.empty());
  ASSERT_EQ(input.contacts.size(), 1U);
  EXPECT_EQ(input.contacts[0].pieces, 1U);
}

TEST(ContactAdoption, LeavesBodiesApartAsTheyAre) {
  const SurfaceSoup soup = soup_of({make_box({0, 0, 0}, {1, 1, 1}), make_box({1.1, 0, 0}, {2, 1, 1})});
  const AdoptedContacts adopted = adopt_contacts(soup, 2, 0.01, nullptr);
  EXPECT_FALSE(adopted.any);
  EXPECT_EQ(adopted.soup.triangles, soup.triangles);
  EXPECT_EQ(adopted.soup.points, soup.points);
  EXPECT_FALSE(imprint_adopted(soup, 2, 0.01, nullptr));
}

TEST(ContactAdoption, LeavesSheetsAlone) {
  const SurfaceSoup soup = soup_of({make_box({0, 0, 0}, {1, 1, 1}), make_box({1.001, 0, 0}, {2, 1, 1})});
  EXPECT_TRUE(adopt_contacts(soup, 2, 0.01, nullptr).any);
  EXPECT_FALSE(adopt_contacts(soup, 1, 0.01, nullptr).any);
}

TEST(ContactAdoption, BoxesShareOneFace) {
  const SurfaceSoup soup =
      soup_of({make_box({0, 0, 0}, {1, 1, 1}), make_box({1.001, 0.2, 0.3}, {2, 0.7, 0.9})});
  const AdoptedContacts adopted = adopt_contacts(soup, 2, 0.01, nullptr);
  ASSERT_TRUE(adopted.any);
  std::set<Triangle> first;
  double shared = 0, volume = 0;
  for (std::size_t t = 0; t < adopted.soup.triangles.size(); ++t) {
    const Triangle& ids = adopted.soup.triangles[t];
    EXPECT_EQ(soup.surface[adopted.source[t]], adopted.soup.surface[t]);
    const Vec3 &a = adopted.soup.points[ids[0]], &b = adopted.soup.points[ids[1]],
               &c = adopted.soup.points[ids[2]];
    Triangle sorted = ids;
    std::sort(sorted.begin(), sorted.end());
    if (adopted.soup.surface[t] == 0)
      first.insert(sorted);
    else if (volume += a.dot(b.cross(c)) / 6; first.contains(sorted))
      shared += (b - a).cross(c - a).norm() / 2;
  }
  EXPECT_NEAR(shared, 0.3, 1e-9);
  EXPECT_NEAR(volume, 0.3, 1e-9);
}

}  // namespace
}  // namespace tetwright
