// SPDX-License-Identifier: Apache-2.0
#include "mesher/complex/sheet_borders.h"

#include <map>
#include <optional>

#include "common/features/edge_uses.h"

namespace tetwright {

namespace {

/// A free edge, as the sheet's triangle traverses it.
struct BorderEdge {
  Index from, to;
  Index face;
  Vec3 out;  ///< unit, in the triangle's plane
  Index from_out = no_index, to_out = no_index;
};

}  // namespace

SheetBorders continue_sheets(const LabelledComplex& complex, double length) {
  SheetBorders borders;
  borders.points = complex.points;
  std::vector<Triangle> triangles;
  for (const LabelledComplex::SheetFace& f : complex.sheets) triangles.push_back(f.ids);
  const auto sheets = triangles.size();
  for (const LabelledComplex::Face& f : complex.faces) triangles.push_back(f.ids);
  const std::vector<EdgeUse> uses = edge_uses(triangles, {});
  const auto at = [&](Index p) -> const Vec3& { return complex.points[p]; };
  const auto normal_of = [&](const Triangle& t) { return (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0])); };
  std::vector<BorderEdge> edges;
  for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
    while (j < uses.size() && uses[j].key == uses[i].key) ++j;
    if (j - i != 1 || uses[i].triangle >= sheets) continue;
    auto [from, to] = ends_of(uses[i].key);
    if (!uses[i].ascending) std::swap(from, to);
    const Vec3 out = (at(to) - at(from)).cross(normal_of(triangles[uses[i].triangle])).normalized();
    if (out.allFinite()) edges.push_back({from, to, uses[i].triangle, out});
  }
  const auto add = [&](Index p, const Vec3& out) {
    borders.points.push_back(at(p) + length * out);
    return static_cast<Index>(borders.points.size() - 1);
  };
  const auto add_triangle = [&](Index a, Index b, Index c, Index face) {
    borders.triangles.push_back({a, b, c});
    borders.faces.push_back(face);
  };
  std::map<std::pair<std::uint32_t, Index>, std::size_t> leaving;  // by component and point
  for (std::size_t e = 0; e < edges.size(); ++e) {
    BorderEdge& edge = edges[e];
    edge.from_out = add(edge.from, edge.out);
    edge.to_out = add(edge.to, edge.out);
    add_triangle(edge.to, edge.from, edge.from_out, edge.face);
    add_triangle(edge.to, edge.from_out, edge.to_out, edge.face);
    leaving[{complex.sheets[edge.face].component, edge.from}] = e;
  }
  // Fill the gaps between strips at convex corners.
  for (const BorderEdge& edge : edges) {
    const auto next = leaving.find({complex.sheets[edge.face].component, edge.to});
    if (next == leaving.end()) continue;
    const BorderEdge& other = edges[next->second];
    const Vec3 normal = normal_of(triangles[edge.face]) + normal_of(triangles[other.face]);
    const Vec3 middle = (edge.out + other.out).normalized();
    if (!middle.allFinite() || !(edge.out.cross(middle).dot(normal) > 0)) continue;
    const Index tip = add(edge.to, middle);
    add_triangle(edge.to, edge.to_out, tip, edge.face);
    add_triangle(edge.to, tip, other.from_out, other.face);
  }
  return borders;
}

}  // namespace tetwright
