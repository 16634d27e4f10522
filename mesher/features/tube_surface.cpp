// SPDX-License-Identifier: Apache-2.0
#include "mesher/features/tube_surface.h"

#include <cmath>
#include <map>
#include <set>

#include "common/geometry/predicates.h"
#include "mesher/tuning/cut_tuning.h"
#include "tetwright/mesh_quality.h"

namespace tetwright {

using Tubes = CutTuning::Tubes;

TubeSurface::TubeSurface(const TetMesh& mesh, const NearTets& near, const BranchingCurves& curves,
                         const StripFinder& finder, const std::vector<Index>& nearest, double cell)
    : mesh_(mesh), near_(near), curves_(curves), finder_(finder), nearest_(nearest), cell_(cell) {
  faces_at_.resize(mesh.points.size());
  is_on_border_.assign(mesh.points.size(), 0);
  image_.assign(mesh.points.size(), no_index);
  find_ways_to_boundary();
}

void TubeSurface::find_ways_to_boundary() {
  to_boundary_.assign(curves_.vertices().size(), no_index);
  std::vector<Index> front;
  for (Index v = 0; v < curves_.vertices().size(); ++v)
    if (vertex(v).is_on_boundary()) to_boundary_[v] = v, front.push_back(v);
  steps_to_boundary_.assign(curves_.vertices().size(), Tubes::max_steps_to_boundary + 1);
  for (const Index v : front) steps_to_boundary_[v] = 0;
  for (int steps = 1; steps <= Tubes::max_steps_to_boundary; ++steps) {
    std::vector<Index> next;
    for (const Index v : front)
      for (const Index w : vertex(v).next)
        if (to_boundary_[w] == no_index)
          to_boundary_[w] = v, steps_to_boundary_[w] = steps, next.push_back(w);
    front = std::move(next);
  }
}

void TubeSurface::find(const std::vector<std::uint8_t>& is_inside) {
  faces_.clear();
  for (const Index p : points_) {
    faces_at_[p].clear();
    is_on_border_[p] = 0;
  }
  for (Index n = 0; n < near_.size(); ++n) {
    if (!is_inside[n]) continue;
    for (Index k = 0; k < 4; ++k) {
      const Index other = near_.neighbour(n, k);
      if (other == NearTets::none || (other != NearTets::far && is_inside[other])) continue;
      for (const Index p : near_.face_of(n, k)) faces_at_[p].push_back(static_cast<Index>(faces_.size()));
      faces_.push_back({near_.face_of(n, k), n, other});
    }
  }
  points_.clear();
  std::vector<std::array<Index, 2>> edges;
  for (const Face& f : faces_)
    for (std::size_t k = 0; k < 3; ++k) {
      points_.push_back(f.ids[k]);
      edges.push_back(ascending_edge(f.ids[k], f.ids[(k + 1) % 3]));
    }
  std::sort(points_.begin(), points_.end());
  points_.erase(std::unique(points_.begin(), points_.end()), points_.end());
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i < edges.size();) {
    const std::size_t first = i;
    while (i < edges.size() && edges[i] == edges[first]) ++i;
    if (i - first == 1)
      for (const Index p : edges[first]) is_on_border_[p] = 1;
  }
  map_points();
  improve_map();
}

bool TubeSurface::are_joined(Index v, Index w) const {
  return v == w || std::binary_search(vertex(v).next.begin(), vertex(v).next.end(), w);
}

/// The next vertex on a shortest way along the chains, or the vertex itself if the other is far away.
Index TubeSurface::step(Index from, Index to) const {
  std::map<Index, Index> back{{to, to}};
  std::vector<Index> front{to};
  for (int steps = 0; steps < Tubes::max_steps && !front.empty(); ++steps) {
    std::vector<Index> next;
    for (const Index v : front)
      for (const Index w : vertex(v).next)
        if (back.try_emplace(w, v).second) next.push_back(w);
    if (const auto found = back.find(from); found != back.end()) return found->second;
    front = std::move(next);
  }
  return from;
}

/// Maps each outer point to the nearest vertex of the chains, those on the border of the tube to one on the
/// boundary, and then points of one edge closer to each other until they go to a vertex or an edge.
void TubeSurface::map_points() {
  for (const Index p : points_) {
    Index v = nearest_[p];
    while (is_on_border_[p] && to_boundary_[v] != no_index && !vertex(v).is_on_boundary())
      v = to_boundary_[v];
    image_[p] = v;
  }
  for (int pass = 0; pass < Tubes::max_passes; ++pass) {
    std::map<Index, Index> moved;
    for (const Face& f : faces_)
      for (std::size_t k = 0; k < 3; ++k) {
        const Index a = f.ids[k], b = f.ids[(k + 1) % 3];
        if (are_joined(image_[a], image_[b])) continue;
        for (const auto& [p, q] : {std::pair(a, b), std::pair(b, a)}) {
          const Index next = step(image_[p], image_[q]);
          if (next == image_[p] || !may_go_to(p, next)) continue;
          const auto [known, is_new] = moved.try_emplace(p, next);
          if (!is_new) known->second = std::min(known->second, next);
        }
      }
    if (moved.empty()) return;
    for (const auto& [p, v] : moved) image_[p] = v;
  }
}

/// Whether all points of a tet are on one sheet, so that it will be flat once they are fitted to it.
bool TubeSurface::is_in_sheet(const Tet& t) const {
  // All labels meet in the curve.
  bool is_any_inside = false;
  std::vector<NearTets::Label> common;
  const std::vector<NearTets::Label>* first = nullptr;
  for (const Index p : t) {
    if (p >= first_vertex()) {
      is_any_inside |= !vertex(p - first_vertex()).is_on_boundary();
      continue;
    }
    const std::vector<NearTets::Label>& own = near_.labels_at(p);
    if (own.size() < 2) return false;
    if (!first) {
      first = &own;
      common = own;
    } else {
      std::erase_if(common,
                    [&](const NearTets::Label& l) { return !std::binary_search(own.begin(), own.end(), l); });
    }
    if (common.size() < 2) return false;
  }
  if (is_any_inside) std::erase(common, NearTets::Label{});
  return near_.are_any_divided(common);
}

double TubeSurface::shape(const Face& f) const {
  const Index u = image(f.ids[0]), v = image(f.ids[1]), w = image(f.ids[2]);
  if (!are_joined(u, v) || !are_joined(v, w) || !are_joined(u, w) || (u != v && v != w && u != w))
    return not_simplicial;
  double worst = HUGE_VAL;
  tets_of(f, [&](const Tet& t) {
    const Vec3 &a = position(t[0]), &b = position(t[1]), &c = position(t[2]), &d = position(t[3]);
    if (orient3d(a, b, c, d) > 0) {
      worst = std::min(worst, is_in_sheet(t) ? Tubes::shape_in_sheet : min_solid_angle(a, b, c, d));
    } else {
      const double volume = std::abs((b - a).cross(c - a).dot(d - a));
      worst = std::min(worst, std::clamp(-volume / (cell_ * cell_ * cell_), not_simplicial / 2,
                                         2 * Tubes::shape_in_sheet));
    }
  });
  return worst;
}

/// The worst shape of the faces at a point, or of some of them if that is no better than another.
double TubeSurface::worst_shape_at(Index p, double other) const {
  double worst = HUGE_VAL;
  for (const Index f : faces_at_[p]) {
    worst = std::min(worst, shape(faces_[f]));
    if (worst <= other) break;
  }
  return worst;
}

/// Maps points of faces with poor tets to a neighbour of their image where that is better.
void TubeSurface::improve_map() {
  std::vector<double> shapes(faces_.size());
  for (Index f = 0; f < faces_.size(); ++f) shapes[f] = shape(faces_[f]);
  for (int pass = 0; pass < Tubes::max_passes; ++pass) {
    std::set<Index> points;
    for (Index f = 0; f < faces_.size(); ++f)
      if (shapes[f] < Tubes::good_solid_angle) points.insert(faces_[f].ids.begin(), faces_[f].ids.end());
    bool any = false;
    for (const Index p : points) {
      double best = HUGE_VAL;
      for (const Index f : faces_at_[p]) best = std::min(best, shapes[f]);
      Index& image = image_[p];
      const Index before = image;
      Index chosen = image;
      for (const Index v : vertex(before).next) {
        if (!may_go_to(p, v)) continue;
        image = v;
        if (const double own = worst_shape_at(p, best); own > best) best = own, chosen = v;
      }
      image = chosen;
      if (chosen == before) continue;
      any = true;
      for (const Index f : faces_at_[p]) shapes[f] = shape(faces_[f]);
    }
    if (!any) return;
  }
}

bool TubeSurface::has_clean_bands(Index p) const {
  const std::vector<Index>& faces = faces_at_[p];
  std::map<Index, std::vector<Index>> beside;  // faces by the other point of an edge
  for (const Index f : faces)
    for (const Index q : faces_[f].ids)
      if (q != p) beside[q].push_back(f);
  std::map<Index, std::vector<Index>> next;
  std::size_t ends = 0;
  std::set<MaterialOrOutside> materials;
  for (const Index f : faces) materials.insert(near_.label(faces_[f].inner).material);
  std::size_t changes = 0;
  std::map<std::uint32_t, int> crossed;  // sheets inside a region, by component
  for (const auto& [q, both] : beside) {
    if (both.size() > 2) return false;
    if (both.size() == 1) {
      ++ends;
      continue;
    }
    next[both[0]].push_back(both[1]);
    next[both[1]].push_back(both[0]);
    const NearTets::Label a = near_.label(faces_[both[0]].inner), b = near_.label(faces_[both[1]].inner);
    if (a == b) continue;
    if (a.material != b.material) ++changes;
    if (const std::uint32_t sheet = near_.component_between(a, b);
        a.material == b.material && sheet != no_index && ++crossed[sheet] > 2)
      return false;
    if (finder_.are_across_curve((mesh_.points[p] + mesh_.points[q]) / 2, a, b)) return false;
  }
  if (ends > 2) return false;
  std::set<Index> seen{faces.front()};
  std::vector<Index> stack{faces.front()};
  while (!stack.empty()) {
    const Index f = stack.back();
    stack.pop_back();
    for (const Index g : next[f])
      if (seen.insert(g).second) stack.push_back(g);
  }
  if (seen.size() != faces.size()) return false;
  const std::size_t expected = ends ? materials.size() - 1 : (materials.size() > 1 ? materials.size() : 0);
  return changes == expected;
}

}  // namespace tetwright
