// SPDX-License-Identifier: Apache-2.0
#include "tests/mesher/complex/exact_regions.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Nef_polyhedron_3.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polyhedron_3.h>

#include <cmath>
#include <map>
#include <numeric>
#include <optional>

namespace tetwright {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Nef = CGAL::Nef_polyhedron_3<Kernel>;

Nef solid_of(const TriangleMesh& mesh) {
  std::vector<Kernel::Point_3> points;
  for (const Vec3& p : mesh.points) points.emplace_back(p.x(), p.y(), p.z());
  std::vector<std::vector<std::size_t>> triangles;
  for (const auto& [a, b, c] : mesh.triangles) triangles.push_back({a, b, c});
  CGAL::Polyhedron_3<Kernel> surface;
  CGAL::Polygon_mesh_processing::polygon_soup_to_polygon_mesh(points, triangles, surface);
  return Nef(surface);
}

/// Numbers the marked vertices of a set and joins those that are connected.
class Components {
 public:
  explicit Components(const Nef& set) {
    for (auto v = set.vertices_begin(); v != set.vertices_end(); ++v)
      if (v->mark()) number_.emplace(&*v, number_.size());
    root_.resize(number_.size());
    std::iota(root_.begin(), root_.end(), 0);
  }
  template <class Vertex>
  std::size_t find(const Vertex& v) {
    return find_root(number_.at(&*v));
  }
  std::size_t find_root(std::size_t k) {
    while (root_[k] != k) k = root_[k] = root_[root_[k]];
    return k;
  }
  void unite(std::size_t a, std::size_t b) { root_[a] = b; }
  int points() const { return static_cast<int>(root_.size()); }
  int count() const {
    int count = 0;
    for (std::size_t k = 0; k < root_.size(); ++k) count += root_[k] == k;
    return count;
  }

 private:
  std::map<const void*, std::size_t> number_;
  std::vector<std::size_t> root_;
};

/// Calls `visit(circulator)` for each cycle of edges around a face.
template <class Face, class Visit>
void for_each_cycle(const Face& f, const Visit& visit) {
  for (auto cycle = f->facet_cycles_begin(); cycle != f->facet_cycles_end(); ++cycle)
    if (cycle.is_shalfedge())
      visit(Nef::SHalfedge_around_facet_const_circulator(Nef::SHalfedge_const_handle(cycle)));
}

SetShape shape_of(const Nef& set) {
  Components components(set);
  SetShape shape;
  shape.euler = components.points();
  for (auto e = set.halfedges_begin(); e != set.halfedges_end(); ++e) {
    if (e->is_twin() || !e->mark()) continue;
    --shape.euler;
    components.unite(components.find(e->source()), components.find(e->twin()->source()));
  }
  for (auto f = set.halffacets_begin(); f != set.halffacets_end(); ++f) {
    if (f->is_twin() || !f->mark()) continue;
    shape.euler += 2;  // a sphere, less a disc for each cycle
    std::optional<std::size_t> first;
    const auto join = [&](const Nef::Vertex_const_handle& v) {
      if (!first) first = components.find(v);
      components.unite(components.find(v), components.find_root(*first));
    };
    for_each_cycle(f, [&](auto at) {
      --shape.euler;
      const auto end = at;
      CGAL_For_all(at, end) join(at->source()->source());
    });
    // Points in which another part of the set touches the face.
    for (auto cycle = f->facet_cycles_begin(); cycle != f->facet_cycles_end(); ++cycle)
      if (cycle.is_shalfloop()) {
        --shape.euler;
        join(Nef::SHalfloop_const_handle(cycle)->incident_sface()->center_vertex());
      }
  }
  shape.components = components.count();
  return shape;
}

double volume_of(const Nef& solid) {
  Kernel::FT sum = 0;
  for (auto f = solid.halffacets_begin(); f != solid.halffacets_end(); ++f) {
    if (!f->incident_volume()->mark()) continue;
    Kernel::Vector_3 area = CGAL::NULL_VECTOR;
    std::optional<Kernel::Vector_3> on_plane;
    for_each_cycle(f, [&](auto at) {
      const auto end = at;
      CGAL_For_all(at, end) {
        const Kernel::Vector_3 p = at->source()->source()->point() - CGAL::ORIGIN,
                               q = at->next()->source()->source()->point() - CGAL::ORIGIN;
        area = area + CGAL::cross_product(p, q);
        if (!on_plane) on_plane = p;
      }
    });
    sum += area * *on_plane;
  }
  return std::abs(CGAL::to_double(sum)) / 6;
}

}  // namespace

AssemblyShape exact_regions(const std::vector<TriangleMesh>& bodies) {
  std::vector<Nef> regions;
  for (const TriangleMesh& body : bodies) {
    const Nef solid = solid_of(body);
    for (Nef& earlier : regions) earlier = (earlier - solid).closure();
    regions.push_back(solid);
  }
  AssemblyShape shape;
  for (const Nef& region : regions) shape.regions.push_back({shape_of(region), volume_of(region)});
  for (std::size_t b = 0; b < regions.size(); ++b)
    for (std::size_t a = 0; a < b; ++a)
      if (const Nef both = regions[a] * regions[b]; !both.is_empty()) shape.contacts[{a, b}] = shape_of(both);
  return shape;
}

}  // namespace tetwright
