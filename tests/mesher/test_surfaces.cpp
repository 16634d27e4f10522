// SPDX-License-Identifier: Apache-2.0
#include "tests/mesher/test_surfaces.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <string>

#include "common/geometry/predicates.h"
#include "tetwright/mesh_quality.h"

namespace tetwright {

namespace {

using Face = std::array<Index, 3>;
using Edge = std::array<Index, 2>;

template <std::size_t N>
std::array<Index, N> sorted(std::array<Index, N> ids) {
  std::sort(ids.begin(), ids.end());
  return ids;
}

/// Union-find over 0...n-1.
struct Sets {
  explicit Sets(std::size_t n) : parent(n) { std::iota(parent.begin(), parent.end(), std::size_t{0}); }
  std::size_t root(std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) { parent[root(a)] = root(b); }
  std::vector<std::size_t> parent;
};

std::map<Face, std::vector<std::size_t>> face_tets(const std::vector<Tet>& tets) {
  std::map<Face, std::vector<std::size_t>> faces;
  for (std::size_t t = 0; t < tets.size(); ++t)
    for (const auto& f : tet_faces)
      faces[sorted(Face{tets[t][f[0]], tets[t][f[1]], tets[t][f[2]]})].push_back(t);
  return faces;
}

}  // namespace

TriangleMesh make_sphere(double radius, const Vec3& centre, int subdivisions) {
  TriangleMesh mesh;
  mesh.points = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int s = 0; s < subdivisions; ++s) {
    std::map<Edge, Index> middles;
    const auto middle = [&](Index a, Index b) {
      const auto [it, fresh] =
          middles.try_emplace(sorted(Edge{a, b}), static_cast<Index>(mesh.points.size()));
      if (fresh) mesh.points.push_back((mesh.points[a] + mesh.points[b]).normalized());
      return it->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const Index ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
  }
  for (Vec3& p : mesh.points) p = centre + radius * p;
  return mesh;
}

TriangleMesh make_torus(double ring_radius, double tube_radius, int around, int across) {
  TriangleMesh mesh;
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const double u = 2 * std::numbers::pi * i / around, v = 2 * std::numbers::pi * j / across;
      const double r = ring_radius + tube_radius * std::cos(v);
      mesh.points.emplace_back(r * std::cos(u), r * std::sin(u), tube_radius * std::sin(v));
    }
  const auto at = [&](int i, int j) { return static_cast<Index>((i % around) * across + j % across); };
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

TriangleMesh make_box(const Vec3& low, const Vec3& high) {
  TriangleMesh mesh;
  for (int k = 0; k < 8; ++k)
    mesh.points.emplace_back(k & 1 ? high.x() : low.x(), k & 2 ? high.y() : low.y(),
                             k & 4 ? high.z() : low.z());
  mesh.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  return mesh;
}

TriangleMesh make_moebius_strip(int around) {
  TriangleMesh mesh;
  for (int i = 0; i < around; ++i) {
    const double u = 2 * std::numbers::pi * i / around;
    for (const double side : {-0.3, 0.3}) {
      const double r = 1 + side * std::cos(u / 2);
      mesh.points.emplace_back(r * std::cos(u), r * std::sin(u), side * std::sin(u / 2));
    }
  }
  // After a full turn the two sides are swapped.
  const auto at = [&](int i, int side) { return static_cast<Index>(i < around ? 2 * i + side : 1 - side); };
  for (int i = 0; i < around; ++i) {
    mesh.triangles.push_back({at(i, 0), at(i + 1, 0), at(i + 1, 1)});
    mesh.triangles.push_back({at(i, 0), at(i + 1, 1), at(i, 1)});
  }
  return mesh;
}

TriangleMesh make_klein_bottle(int around, int across) {
  TriangleMesh mesh;
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const double u = 2 * std::numbers::pi * i / around, v = 2 * std::numbers::pi * (j + 0.5) / across;
      const double x = std::sin(v), y = std::sin(2 * v);
      const double r = 2 + std::cos(u / 2) * x - std::sin(u / 2) * y;
      mesh.points.emplace_back(r * std::cos(u), r * std::sin(u), std::sin(u / 2) * x + std::cos(u / 2) * y);
    }
  // A full turn rotates the figure eight by half a turn: (x, y) becomes (-x, -y), v becomes -v.
  const auto at = [&](int i, int j) {
    j %= across;
    return static_cast<Index>(i < around ? i * across + j : across - 1 - j);
  };
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

TriangleMesh punctured(TriangleMesh mesh, int step) {
  std::erase_if(mesh.triangles, [&, i = 0](const Triangle&) mutable { return ++i % step == 0; });
  return mesh;
}

TriangleMesh partly_turned_over(TriangleMesh mesh, std::size_t step) {
  for (std::size_t t = 0; t < mesh.triangles.size(); t += step)
    std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
  return mesh;
}

TriangleMesh turned_over(TriangleMesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[0], t[1]);
  return mesh;
}

TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh mesh = a;
  const auto shift = static_cast<Index>(a.points.size());
  mesh.points.insert(mesh.points.end(), b.points.begin(), b.points.end());
  for (const auto& [i, j, k] : b.triangles) mesh.triangles.push_back({i + shift, j + shift, k + shift});
  return mesh;
}

double enclosed_volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    sum += mesh.points[a].dot(mesh.points[b].cross(mesh.points[c])) / 6;
  return sum;
}

double volume(const std::vector<Vec3>& points, const std::vector<Tet>& tets) {
  double sum = 0;
  for (const auto& [a, b, c, d] : tets) sum += tet_volume(points[a], points[b], points[c], points[d]);
  return sum;
}

std::vector<InterfaceTriangle> without_patches(std::vector<InterfaceTriangle> interfaces) {
  for (InterfaceTriangle& t : interfaces) t.patch = 0;
  return interfaces;
}

std::string broken_promise(const std::vector<Vec3>& points, const std::vector<Tet>& tets) {
  std::vector<char> used(points.size(), 0);
  for (const Tet& t : tets) {
    if (orient3d(points[t[0]], points[t[1]], points[t[2]], points[t[3]]) <= 0) return "a tet is not positive";
    for (Index v : t) used[v] = 1;
  }
  if (std::count(used.begin(), used.end(), 0)) return "a point is unused";

  // Corners of tets at one point are connected across faces; corners of boundary triangles across edges.
  Sets stars(4 * tets.size());
  std::map<Edge, std::vector<std::size_t>> boundary_edges;
  std::vector<Face> boundary;
  const auto corner = [&](std::size_t t, Index v) {
    return 4 * t + static_cast<std::size_t>(std::find(tets[t].begin(), tets[t].end(), v) - tets[t].begin());
  };
  for (const auto& [face, owners] : face_tets(tets)) {
    if (owners.size() > 2) return "a face is in more than two tets";
    if (owners.size() == 2) {
      for (Index v : face) stars.join(corner(owners[0], v), corner(owners[1], v));
    } else {
      for (int k = 0; k < 3; ++k)
        boundary_edges[sorted(Edge{face[k], face[(k + 1) % 3]})].push_back(boundary.size());
      boundary.push_back(face);
    }
  }
  Sets fans(3 * boundary.size());
  const auto boundary_corner = [&](std::size_t f, Index v) {
    return 3 * f + static_cast<std::size_t>(std::find(boundary[f].begin(), boundary[f].end(), v) -
                                            boundary[f].begin());
  };
  for (const auto& [edge, owners] : boundary_edges) {
    if (owners.size() != 2) return "a boundary edge is not in two triangles";
    for (Index v : edge) fans.join(boundary_corner(owners[0], v), boundary_corner(owners[1], v));
  }
  std::map<Index, std::size_t> star_of, fan_of;
  for (std::size_t t = 0; t < tets.size(); ++t)
    for (std::size_t k = 0; k < 4; ++k)
      if (star_of.try_emplace(tets[t][k], stars.root(4 * t + k)).first->second != stars.root(4 * t + k))
        return "the star of a point is in pieces";
  for (std::size_t f = 0; f < boundary.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k)
      if (fan_of.try_emplace(boundary[f][k], fans.root(3 * f + k)).first->second != fans.root(3 * f + k))
        return "the boundary touches itself in a point";
  return "";
}

SolidTopology solid_topology(const std::vector<Vec3>& points, const std::vector<Tet>& tets) {
  SolidTopology result;
  Sets solid(points.size()), surface(points.size());
  std::set<Edge> edges, surface_edges;
  std::set<Index> surface_points;
  int surface_faces = 0;
  const auto faces = face_tets(tets);
  for (const Tet& t : tets) {
    for (const auto& e : tet_edges) edges.insert(sorted(Edge{t[e[0]], t[e[1]]}));
    for (std::size_t k = 1; k < 4; ++k) solid.join(t[0], t[k]);
  }
  for (const auto& [face, owners] : faces) {
    if (owners.size() != 1) continue;
    ++surface_faces;
    for (int k = 0; k < 3; ++k) {
      surface_edges.insert(sorted(Edge{face[k], face[(k + 1) % 3]}));
      surface_points.insert(face[k]);
      surface.join(face[0], face[k]);
    }
  }
  for (std::size_t i = 0; i < points.size(); ++i) result.components += solid.root(i) == i;
  for (Index v : surface_points) result.boundary_components += surface.root(v) == v;
  result.euler = static_cast<int>(points.size()) - static_cast<int>(edges.size()) +
                 static_cast<int>(faces.size()) - static_cast<int>(tets.size());
  result.boundary_euler =
      static_cast<int>(surface_points.size()) - static_cast<int>(surface_edges.size()) + surface_faces;
  return result;
}

}  // namespace tetwright
