// SPDX-License-Identifier: Apache-2.0
#include "tools/compare/surface_caps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "common/features/edge_uses.h"

namespace tetwright {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// An open edge that is closer to another open edge than this fraction of its length is one side of a crack.
constexpr double crack_share = 0.25;
/// Fractions of the diagonal: the maximum size of a piece of a cap, and the sizes below which pieces are not
/// cut further if a sampled point is on a cap, and if none is.
constexpr double cap_piece = 0.02, cut_piece = 5e-4, cap_free_piece = 5e-3;
/// Rounding of two distances of the same point: relative to the distance, and to the diagonal.
constexpr double same_distance = 1e-9, same_place = 1e-12;

using Corners = std::array<Vec3, 3>;

double area_of(const Corners& c) { return (c[1] - c[0]).cross(c[2] - c[0]).norm() / 2; }

/// Distance from the nearest item; infinite if there is none.
double distance_from(const ProjectionTree& tree, const Vec3& p) {
  const auto on = tree.nearest(p, {}, infinity);
  return on ? (*on - p).norm() : infinity;
}

/// Collects triangles for a tree.
struct TreeBuilder {
  std::vector<Vec3> points;
  std::vector<ProjectionTree::Item> items;

  void add(const Corners& corners) {
    const auto first = static_cast<Index>(points.size());
    points.insert(points.end(), corners.begin(), corners.end());
    items.push_back({{first, first + 1, first + 2}, {}});
  }
  ProjectionTree build() { return {std::move(points), std::move(items)}; }
};

}  // namespace

OpenEdges find_open_edges(const MesherInput& surfaces) {
  OpenEdges open;
  std::vector<Vec3> points;
  std::vector<ProjectionTree::Item> edges;
  for (const MesherInput::Body& body : surfaces.bodies) {
    const auto first = static_cast<Index>(points.size());
    points.insert(points.end(), body.surface.points.begin(), body.surface.points.end());
    const std::vector<EdgeUse> uses = edge_uses(body.surface.triangles, {});
    for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
      while (j < uses.size() && uses[j].key == uses[i].key) ++j;
      const auto [a, b] = ends_of(uses[i].key);
      if (j - i == 1) edges.push_back({{first + a, first + b, first + b}, {}});
    }
  }
  open.count = edges.size();
  const ProjectionTree all(points, edges);
  std::erase_if(edges, [&](const ProjectionTree::Item& e) {
    const Index a = e.corners[0], b = e.corners[1];
    const double length = (points[b] - points[a]).norm();
    return all
        .nearest_of((points[a] + points[b]) / 2, crack_share * length,
                    [&](const ProjectionTree::Item& o) {
                      return o.corners[0] != a && o.corners[1] != a && o.corners[0] != b && o.corners[1] != b;
                    })
        .has_value();
  });
  open.rims = ProjectionTree(std::move(points), std::move(edges));
  return open;
}

bool CapFinder::is_beyond_rim(const Vec3& place) const {
  const double distance = distance_from(surfaces_, place);
  return rims_.any_within(place, distance * (1 + same_distance) + same_place * diagonal_);
}

CapFinder::Parts CapFinder::split(const TetMesh& mesh) const {
  Parts parts;
  TreeBuilder kept, caps;
  std::vector<Corners> open, kept_pieces;
  for (const InterfaceTriangle& t : mesh.interfaces) {
    const Corners whole{mesh.points[t.ids[0]], mesh.points[t.ids[1]], mesh.points[t.ids[2]]};
    parts.area += area_of(whole);
    const std::size_t caps_before = caps.items.size();
    kept_pieces.clear();
    open.assign(1, whole);
    while (!open.empty()) {
      const Corners piece = open.back();
      open.pop_back();
      const Vec3 centre = (piece[0] + piece[1] + piece[2]) / 3;
      double radius = 0, longest = 0;
      std::size_t edge = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        radius = std::max(radius, (piece[k] - centre).norm());
        const double length = (piece[(k + 1) % 3] - piece[k]).norm();
        if (length <= longest) continue;
        longest = length;
        edge = k;
      }
      std::size_t beyond = is_beyond_rim(centre);
      for (const Vec3& corner : piece) beyond += is_beyond_rim(corner);
      if (beyond == 4 && longest <= cap_piece * diagonal_) {
        caps.add(piece);
        parts.cap_area += area_of(piece);
        continue;
      }
      // Both distances are 1-Lipschitz, which bounds their change within the piece.
      const bool small = longest <= (beyond > 0 ? cut_piece : cap_free_piece) * diagonal_;
      if (small || !rims_.any_within(centre, distance_from(surfaces_, centre) + 2 * radius)) {
        kept_pieces.push_back(piece);
        continue;
      }
      const Vec3 &a = piece[edge], &b = piece[(edge + 1) % 3], &opposite = piece[(edge + 2) % 3];
      const Vec3 middle = (a + b) / 2;
      open.push_back({a, middle, opposite});
      open.push_back({middle, b, opposite});
    }
    if (caps.items.size() == caps_before)
      kept.add(whole);
    else
      for (const Corners& piece : kept_pieces) kept.add(piece);
  }
  parts.kept = kept.build();
  parts.caps = caps.build();
  return parts;
}

}  // namespace tetwright
