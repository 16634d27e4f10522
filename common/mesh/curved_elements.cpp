// SPDX-License-Identifier: Apache-2.0
#include "tetwright/mesh_quality.h"

#include <algorithm>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <vector>

#include "common/geometry/projection_tree.h"

namespace tetwright {

namespace {

constexpr double min_jacobian = 0.1;

/// Maximum displacement of a midside node, relative to the length of its edge; beyond it the node might
/// follow another sheet.
constexpr double max_move = 0.25;

/// Fractions of the displacement onto the surface that are tried.
constexpr std::array<double, 4> shares{1, 0.5, 0.25, 0};

using Edge = std::array<Index, 2>;

/// Patches at an edge, with the number of triangles of each.
using PatchesAtEdge = std::map<InterfacePatch, int>;

std::map<Edge, PatchesAtEdge> patches_at_edges(const TetMesh& mesh) {
  std::map<Edge, PatchesAtEdge> edges;
  for (const InterfaceTriangle& t : mesh.interfaces)
    for (std::size_t k = 0; k < 3; ++k)
      ++edges[ascending_edge(t.ids[k], t.ids[(k + 1) % 3])][{t.pair(), t.patch}];
  return edges;
}

/// Whether both triangles at an edge belong to one patch.
bool is_smooth(const PatchesAtEdge& at) { return at.size() == 1 && at.begin()->second == 2; }

bool has_sheet(const PatchesAtEdge& at) {
  return std::any_of(at.begin(), at.end(), [](const auto& patch) {
    const MaterialPair& pair = patch.first.first;
    return pair.first == pair.second;
  });
}

}  // namespace

SurfaceToFollow follow(const ReferenceSurface& reference) {
  SurfaceToFollow surface;
  surface.onto_patch = [&reference](const Vec3& p, const InterfacePatch& patch, double max_distance) {
    const auto& [pair, number] = patch;
    if (pair.first == pair.second)
      return std::optional<Vec3>();  // a sheet, which the reference does not have
    return reference.has_patches() ? reference.onto_patch(p, pair.first, pair.second, number, max_distance)
                                   : reference.project(p, pair.first, pair.second, max_distance);
  };
  if (reference.has_patches())
    surface.onto_crease = [&reference](const Vec3& p, double max_distance) {
      return reference.onto_crease(p, max_distance);
    };
  return surface;
}

SurfaceToFollow follow_interfaces(const TetMesh& mesh) {
  // A kind is the number of a patch, or `crease`.
  constexpr ProjectionTree::Kind crease{0, 0, 0};
  auto numbers = std::make_shared<std::map<InterfacePatch, std::uint32_t>>();
  std::vector<ProjectionTree::Item> items;
  for (const InterfaceTriangle& t : mesh.interfaces) {
    const auto number = numbers->try_emplace({t.pair(), t.patch}, numbers->size() + 1).first->second;
    items.push_back({t.ids, {number, 0, 0}});
  }
  for (const auto& [edge, at] : patches_at_edges(mesh))
    if (!is_smooth(at)) items.push_back({{edge[0], edge[1], edge[1]}, crease});
  const auto tree = std::make_shared<ProjectionTree>(mesh.points, std::move(items));
  SurfaceToFollow surface;
  surface.onto_patch = [tree, numbers](const Vec3& p, const InterfacePatch& patch,
                                       double max_distance) -> std::optional<Vec3> {
    const auto number = numbers->find(patch);
    if (number == numbers->end()) return {};
    return tree->nearest(p, {number->second, 0, 0}, max_distance);
  };
  surface.onto_crease = [tree, crease](const Vec3& p, double max_distance) {
    return tree->nearest(p, crease, max_distance);
  };
  surface.onto_sheet_curve = surface.onto_crease;
  return surface;
}

void follow_sheets(SurfaceToFollow& surface, const TetMesh& mesh) {
  TetMesh sheets;
  sheets.interfaces = sheets_of(mesh);
  if (sheets.interfaces.empty()) return;
  sheets.points = mesh.points;
  const SurfaceToFollow own = follow_interfaces(sheets);
  surface.onto_patch = [others = surface.onto_patch, sheet = own.onto_patch](
                           const Vec3& p, const InterfacePatch& patch, double max_distance) {
    return (patch.first.first == patch.first.second ? sheet : others)(p, patch, max_distance);
  };
  surface.onto_sheet_curve = own.onto_sheet_curve;
}

double min_scaled_jacobian(const std::array<Vec3, 4>& corners, const std::array<Vec3, 6>& midside) {
  // Bezier control points: the corners, and 2 m - (a + b) / 2 for each edge ab with midside node m.
  std::array<std::array<Vec3, 4>, 4> bezier;
  for (std::size_t i = 0; i < 4; ++i) bezier[i][i] = corners[i];
  for (std::size_t e = 0; e < 6; ++e) {
    const auto& [a, b] = tet_midside_edges[e];
    bezier[a][b] = bezier[b][a] = 2 * midside[e] - 0.5 * (corners[a] + corners[b]);
  }
  // The derivatives along the three edges from corner 0 are linear functions; compute their values at the
  // corners.
  const auto derivative = [&](std::size_t direction, std::size_t at) {
    return Vec3(2 * (bezier[at][direction + 1] - bezier[at][0]));
  };
  // The determinant has degree 3. Its coefficient for a multiset of three corners is the mean over all
  // assignments of the corners to the three derivatives.
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i; j < 4; ++j)
      for (std::size_t k = j; k < 4; ++k) {
        std::array<std::size_t, 3> at{i, j, k};
        double sum = 0;
        int ways = 0;
        do {
          sum += derivative(0, at[0]).dot(derivative(1, at[1]).cross(derivative(2, at[2])));
          ++ways;
        } while (std::next_permutation(at.begin(), at.end()));
        smallest = std::min(smallest, sum / ways);
      }
  const double straight =
      (corners[1] - corners[0]).dot((corners[2] - corners[0]).cross(corners[3] - corners[0]));
  return smallest / straight;
}

CurvingReport curve_midside_nodes(const TetMesh& mesh, const SurfaceToFollow& surface, MidsideNodes& nodes) {
  CurvingReport report;
  std::vector<Vec3> target(nodes.points);
  std::vector<std::uint8_t> share(nodes.points.size(), shares.size() - 1);
  for (const auto& [edge, at] : patches_at_edges(mesh)) {
    const auto place = std::lower_bound(nodes.edges.begin(), nodes.edges.end(), edge);
    if (place == nodes.edges.end() || *place != edge) continue;
    const auto node = static_cast<std::size_t>(place - nodes.edges.begin());
    ++report.edges;
    const Vec3& middle = nodes.points[node];
    const double reach = max_move * (mesh.points[edge[1]] - mesh.points[edge[0]]).norm();
    const auto& onto_curve = has_sheet(at) ? surface.onto_sheet_curve : surface.onto_crease;
    const std::optional<Vec3> onto = is_smooth(at) ? surface.onto_patch(middle, at.begin()->first, reach)
                                     : onto_curve  ? onto_curve(middle, reach)
                                                   : std::nullopt;
    if (!onto || (*onto - middle).norm() > reach) continue;
    target[node] = *onto;
    share[node] = 0;
  }
  const std::vector<Vec3> middle = nodes.points;
  const auto set = [&](std::size_t node) {
    const double s = shares[share[node]];
    nodes.points[node] = s == 1 ? target[node] : Vec3(middle[node] + s * (target[node] - middle[node]));
  };
  for (std::size_t node = 0; node < share.size(); ++node) set(node);

  const auto is_valid = [&](std::size_t t) {
    std::array<Vec3, 4> corners;
    std::array<Vec3, 6> midside;
    for (std::size_t k = 0; k < 4; ++k) corners[k] = mesh.points[mesh.tets[t][k]];
    for (std::size_t e = 0; e < 6; ++e) midside[e] = nodes.points[nodes.of_tets[t][e]];
    return min_scaled_jacobian(corners, midside) >= min_jacobian;
  };
  const auto is_curved = [&](std::size_t t) {
    return std::any_of(nodes.of_tets[t].begin(), nodes.of_tets[t].end(),
                       [&](Index node) { return shares[share[node]] > 0; });
  };
  // All nodes of invalid tets step back in the same round, so the result does not depend on the order of
  // tets. Each round moves at least one node, each node at most three times.
  for (bool moved = true; moved;) {
    std::set<Index> back;
    for (std::size_t t = 0; t < mesh.tets.size(); ++t)
      if (is_curved(t) && !is_valid(t))
        for (const Index node : nodes.of_tets[t])
          if (shares[share[node]] > 0) back.insert(node);
    for (const Index node : back) {
      ++share[node];
      set(node);
    }
    moved = !back.empty();
  }
  for (const auto& [edge, at] : patches_at_edges(mesh)) {
    const auto place = std::lower_bound(nodes.edges.begin(), nodes.edges.end(), edge);
    if (place == nodes.edges.end() || *place != edge) continue;
    const double s = shares[share[static_cast<std::size_t>(place - nodes.edges.begin())]];
    ++(s == 1 ? report.on_surface : s > 0 ? report.part_way : report.straight);
  }
  return report;
}

}  // namespace tetwright
