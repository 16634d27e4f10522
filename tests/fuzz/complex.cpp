// SPDX-License-Identifier: Apache-2.0

// Fuzzes surfaces that meet: the bytes of the input choose bodies, sheets and partitions with corners on a
// coarse grid, so that they touch, coincide and cross in all ways, and options. The result is an input for
// the mesher whose complex is consistent, or an InputError or UsageError.
#include <array>
#include <cmath>
#include <map>
#include <string>

#include "mesher/complex/contact_zone.h"
#include "mesher/complex/labelled_complex.h"
#include "mesher/complex/sheet_zone.h"
#include "tests/fuzz/bytes.h"
#include "tests/fuzz/targets.h"
#include "tests/mesher/complex/random_bodies.h"
#include "tests/mesher/test_surfaces.h"
#include "tetwright/error.h"
#include "tetwright/mesher_input.h"

namespace tetwright::fuzz {
namespace {

constexpr std::array tolerances{1e-5, 1e-9, 1e-3, 0.02, 0.3, 5.0};

/// A point of a grid of 5 x 5 x 5.
Vec3 grid_point(Bytes& bytes) {
  const std::uint32_t k = bytes.below(125);
  return Vec3(k % 5, k / 5 % 5, k / 25);
}

TriangleMesh triangle_soup(Bytes& bytes) {
  TriangleMesh soup;
  const std::uint32_t points = 3 + bytes.below(10), triangles = 1 + bytes.below(24);
  for (std::uint32_t k = 0; k < points; ++k) soup.points.push_back(grid_point(bytes));
  for (std::uint32_t k = 0; k < triangles; ++k)
    soup.triangles.push_back({bytes.below(points), bytes.below(points), bytes.below(points)});
  return soup;
}

TriangleMesh rectangle(Bytes& bytes) {
  TriangleMesh mesh;
  const Vec3 a = grid_point(bytes), b = grid_point(bytes), c = grid_point(bytes);
  mesh.points = {a, b, b + c - a, c};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

/// Moves some points by about the tolerance, as rounding and gaps do.
void shake(TriangleMesh& mesh, double step, Bytes& bytes) {
  for (Vec3& p : mesh.points)
    for (int axis = 0; axis < 3; ++axis) p[axis] += 0.5 * step * (static_cast<double>(bytes.below(7)) - 3);
}

TriangleMesh choose_surface(Bytes& bytes, double tolerance) {
  TriangleMesh mesh;
  switch (bytes.below(6)) {
    case 0:
      mesh = triangle_soup(bytes);
      break;
    case 1:
      mesh = make_sphere(0.5 * (1 + bytes.below(4)), grid_point(bytes), 1);
      break;
    case 2:
      mesh = make_prism(0.5 * (1 + bytes.below(4)), 1 + bytes.below(3), grid_point(bytes),
                        static_cast<int>(3 + bytes.below(6)));
      break;
    case 3: {  // two boxes in one file
      const Vec3 a = grid_point(bytes), b = grid_point(bytes);
      mesh = joined(make_box(a, a + Vec3(1, 2, 1)), make_box(b, b + Vec3(2, 1, 1 + bytes.below(2))));
      break;
    }
    default: {
      const Vec3 at = grid_point(bytes);
      mesh = make_box(at, at + Vec3::Ones() + grid_point(bytes));
    }
  }
  const std::uint32_t changes = bytes.below(64);
  if ((changes & 3) == 1) mesh = turned(std::move(mesh), 0.1 * (1 + bytes.below(60)), Vec3(1, 2, 3));
  if ((changes & 12) == 4) shake(mesh, tolerance, bytes);
  if ((changes & 48) == 16) mesh = turned_over(std::move(mesh));
  if ((changes & 48) == 32 && mesh.triangles.size() > 1)
    mesh.triangles.erase(mesh.triangles.begin() + bytes.below(8) % mesh.triangles.size());
  if ((changes & 48) == 48) {  // an inner wall
    const Index n = static_cast<Index>(mesh.points.size());
    mesh.triangles.push_back({bytes.below(n), bytes.below(n), bytes.below(n)});
    mesh.triangles.push_back({bytes.below(n), bytes.below(n), bytes.below(n)});
  }
  return mesh;
}

/// True if the triangles traverse each edge as often one way as the other.
bool is_closed(const std::vector<Triangle>& triangles) {
  std::map<std::array<Index, 2>, int> balance;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = t[k], b = t[(k + 1) % 3];
      balance[ascending_edge(a, b)] += a < b ? 1 : -1;
    }
  for (const auto& [edge, sum] : balance)
    if (sum != 0) return false;
  return true;
}

void check_input(const MesherInput& input) {
  for (const MesherInput::Body& body : input.bodies) {
    const RepairedSurface& s = body.surface;
    for (const Triangle& t : s.triangles)
      for (const Index p : t) TETWRIGHT_CHECK(p < s.points.size());
    for (const Vec3& p : s.points) TETWRIGHT_CHECK(p.allFinite());
    TETWRIGHT_CHECK(s.groups.empty() || s.groups.size() == s.triangles.size());
    TETWRIGHT_CHECK(s.closed < s.triangles.size() || is_closed(s.triangles));
    TETWRIGHT_CHECK(std::isfinite(s.volume) && std::isfinite(s.area));
  }
}

void check_complex(const MesherInput& input, Bytes& bytes) {
  const LabelledComplex& complex = *input.complex;
  std::vector<std::vector<Triangle>> boundaries(input.bodies.size() + 1);
  for (Index f = 0; f < complex.faces.size(); ++f) {
    const LabelledComplex::Face& face = complex.faces[f];
    TETWRIGHT_CHECK(face.behind != face.front);
    TETWRIGHT_CHECK(std::max(face.behind, face.front) <= input.bodies.size());
    for (const Index p : face.ids) TETWRIGHT_CHECK(p < complex.points.size());
    const auto& [a, b, c] = face.ids;
    TETWRIGHT_CHECK(a != b && b != c && c != a);
    boundaries[face.behind].push_back(face.ids);
    boundaries[face.front].push_back({a, c, b});
    for (const LabelledComplex::Source& s : complex.sources(f)) TETWRIGHT_CHECK(s.body < input.bodies.size());
  }
  for (const std::vector<Triangle>& boundary : boundaries) TETWRIGHT_CHECK(is_closed(boundary));
  for (const LabelledComplex::SheetFace& face : complex.sheets) {
    TETWRIGHT_CHECK(face.region != outside_region && face.region <= input.bodies.size());
    TETWRIGHT_CHECK(face.sheet < input.sheets.size() && face.component < complex.sheet_components);
    for (const Index p : face.ids) TETWRIGHT_CHECK(p < complex.points.size());
  }
  const GridFrame frame = make_grid_frame(input.low, input.high,
                                          (input.high - input.low).maxCoeff() / (4 + bytes.below(12)), false);
  const ContactZone zone(complex, frame);
  std::vector<SheetZone> sheets;
  if (!complex.sheets.empty()) sheets.emplace_back(complex, frame);
  std::vector<SheetZone::Near> near;
  for (int k = 0; k < 40; ++k) {
    const Vec3 share((k * 7 % 40 + 0.5) / 40, (k * 11 % 40 + 0.25) / 40, (k + 0.75) / 40);
    const Vec3 point = frame.to_grid(input.low + share.cwiseProduct(input.high - input.low));
    for (const SheetZone& s : sheets) s.find(point, near);
    if (!zone.contains(point)) continue;
    const ContactZone::Nearest at = zone.nearest(point);
    TETWRIGHT_CHECK(at.region <= input.bodies.size() && at.across <= input.bodies.size());
    TETWRIGHT_CHECK(std::isfinite(at.distance.value) && at.distance.gradient.allFinite());
    if (const auto narrow = zone.narrow(point, at)) TETWRIGHT_CHECK(std::isfinite(narrow->thickness));
    zone.distance(point, at.region);
  }
}

}  // namespace

void run_complex(std::string_view input_bytes) {
  Bytes bytes(input_bytes);
  ContactOptions contact;
  contact.tolerance = tolerances[bytes.below(tolerances.size())];
  contact.overlap = static_cast<OverlapRule>(bytes.below(4));
  const auto nested = static_cast<NestedRule>(bytes.below(4));
  RegionOptions regions;
  regions.rule = bytes.below(8) == 1 ? RegionRule::outer : RegionRule::cells;
  std::vector<MaterialSurface> surfaces;
  const std::uint32_t bodies = 1 + bytes.below(4);
  for (std::uint32_t b = 0; b < bodies; ++b) {
    std::string name = "body" + std::to_string(bytes.below(16) == 1 ? 0 : b);
    surfaces.push_back({std::move(name), static_cast<MaterialTag>(b + 1),
                        choose_surface(bytes, *contact.tolerance), "fuzz"});
  }
  SheetOptions sheets;
  for (std::uint32_t k = bytes.below(4); k-- > 0;) {
    const bool divides = bytes.below(2) == 1;
    sheets.surfaces.push_back(
        {"sheet" + std::to_string(k),
         bytes.below(8) == 1 ? choose_surface(bytes, *contact.tolerance) : rectangle(bytes), "fuzz",
         divides});
  }
  sheets.extend = 0.5 * bytes.below(4);
  if (bytes.below(8) == 1) regions.seeds.push_back({"seed", grid_point(bytes) + Vec3(0.4, 0.3, 0.2)});
  try {
    const MesherInput input =
        make_mesher_input(std::move(surfaces), {}, nested, contact, regions, nullptr, sheets);
    check_input(input);
    if (input.complex) check_complex(input, bytes);
  } catch (const InputError&) {
  } catch (const UsageError&) {
  }
}

}  // namespace tetwright::fuzz
