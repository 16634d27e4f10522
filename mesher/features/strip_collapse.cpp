// SPDX-License-Identifier: Apache-2.0
#include "mesher/features/strip_collapse.h"

#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>

#include "common/features/edge_uses.h"
#include "common/geometry/predicates.h"
#include "common/geometry/projection_tree.h"
#include "mesher/tuning/cut_tuning.h"
#include "tetwright/mesh_quality.h"

namespace tetwright {

namespace {

using Strips = CutTuning::Strips;
using Labelling = CutTuning::Labelling;

/// Edges of the complex at which four or more sheets meet: faces of as many pairs of regions, or sheets
/// inside a region.
ProjectionTree branching_curves(const LabelledComplex& complex) {
  std::vector<Triangle> triangles;
  for (const LabelledComplex::Face& f : complex.faces) triangles.push_back(f.ids);
  for (const LabelledComplex::SheetFace& f : complex.sheets) triangles.push_back(f.ids);
  const std::vector<EdgeUse> uses = edge_uses(triangles, {});
  std::vector<Vec3> points;
  std::vector<ProjectionTree::Item> segments;
  for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
    std::set<std::pair<RegionIndex, RegionIndex>> pairs;
    std::size_t inner = 0;
    for (; j < uses.size() && uses[j].key == uses[i].key; ++j) {
      if (uses[j].triangle >= complex.faces.size()) {
        ++inner;
        continue;
      }
      const LabelledComplex::Face& f = complex.faces[uses[j].triangle];
      pairs.insert(std::minmax(f.behind, f.front));
    }
    if (pairs.size() + inner < Strips::min_sheets) continue;
    const auto first = static_cast<Index>(points.size());
    for (const Index p : ends_of(uses[i].key)) points.push_back(complex.points[p]);
    segments.push_back({{first, first + 1, first + 1}, {}});
  }
  return {std::move(points), std::move(segments)};
}

class StripCollapse {
 public:
  StripCollapse(TetMesh& mesh, const FeatureSurface& surface, const ProjectionTree& curves, double cell,
                SheetParts* parts)
      : mesh_(mesh), surface_(surface), curves_(curves), cell_(cell), parts_(parts) {}

  /// \param all whether edges that do not cross their strip are collapsed, too: what is left of strips has
  ///   all its points on the curve
  /// \return whether anything was collapsed
  bool run(bool all) {
    const std::vector<Triangle> strip = strip_faces();
    if (strip.empty()) return false;
    gather(strip);
    bool any = false;
    for (const auto& [u, v] : edges_of(strip, all)) any |= collapse(current(u), current(v));
    if (any) finish();
    return any;
  }

 private:
  using Regions = std::set<MaterialOrOutside>;

  const Vec3& at(Index p) const { return mesh_.points[p]; }
  bool is_real(const Tet& t) const { return t[3] != beyond_; }
  MaterialOrOutside label(Index t) const {
    if (!is_real(tets_[t])) return {};
    return parts_ ? MaterialTag{parts_->of_tets[t]} : mesh_.materials[t];
  }
  static bool has(const Tet& t, Index p) { return std::find(t.begin(), t.end(), p) != t.end(); }

  /// Faces near a branching curve between regions that have no sheet near them.
  std::vector<Triangle> strip_faces() const {
    std::vector<Triangle> found;
    for (const InterfaceTriangle& f : mesh_.interfaces) {
      const Vec3 middle = (at(f.ids[0]) + at(f.ids[1]) + at(f.ids[2])) / 3;
      if (!curves_.any_within(middle, Strips::curve_reach * cell_)) continue;
      const auto sheet = surface_.sheet_of(f);
      if (!sheet || !surface_.nearest(middle, *sheet, Strips::sheet_reach * cell_)) found.push_back(f.ids);
    }
    if (!parts_) return found;
    const SheetedField& field = *parts_->field;
    const SheetBranches& branches = field.base().sheets()->branches();
    for (const PartFace& f : part_faces(mesh_, *parts_)) {
      const SheetedField::Part &a = field.part(parts_->of_tets[f.first]),
                               &b = field.part(parts_->of_tets[f.second]);
      if (a.region != b.region) continue;
      const auto side = [](const SheetedField::Part& part) {
        return [&part](std::uint32_t component) -> std::optional<bool> {
          const SheetSides::Side* own = part.sides.of(component);
          return own ? std::optional(own->in_front) : std::nullopt;
        };
      };
      const Vec3 middle = (at(f.ids[0]) + at(f.ids[1]) + at(f.ids[2])) / 3;
      if (branches.face_across(field.voxels().to_grid(middle), Strips::curve_reach, side(a), side(b)))
        found.push_back(f.ids);
    }
    return found;
  }

  /// Collects the tets at the strips' points. Boundary faces become tets with a common point beyond the
  /// boundary, so that the mesh has no border.
  void gather(const std::vector<Triangle>& strip) {
    beyond_ = static_cast<Index>(mesh_.points.size());
    tets_ = mesh_.tets;
    for (const Triangle& f : strip)
      for (const Index p : f) at_[p];
    const auto list = [&](Index t) {
      for (const Index p : tets_[t])
        if (const auto known = at_.find(p); known != at_.end()) known->second.push_back(t);
    };
    for (Index t = 0; t < mesh_.tets.size(); ++t) list(t);
    for (const InterfaceTriangle& f : mesh_.interfaces) {
      if (f.other || std::none_of(f.ids.begin(), f.ids.end(), [&](Index p) { return at_.contains(p); }))
        continue;
      tets_.push_back({f.ids[0], f.ids[1], f.ids[2], beyond_});
      list(static_cast<Index>(tets_.size() - 1));
    }
    removed_.assign(tets_.size(), 0);
    for (const auto& [p, tets] : at_) {
      Regions& own = regions_[p];
      for (const Index t : tets) own.insert(label(t));
    }
  }

  /// The edges of the strips' faces, or only those that join its sides, or an inner point to one; shortest
  /// first.
  std::vector<std::array<Index, 2>> edges_of(const std::vector<Triangle>& strip, bool all) {
    std::set<std::pair<double, std::array<Index, 2>>> edges;
    for (const Triangle& f : strip)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::array<Index, 2> e = ascending_edge(f[k], f[(k + 1) % 3]);
        if (all || crosses_strip(regions_[e[0]], regions_[e[1]]))
          edges.insert({(at(e[0]) - at(e[1])).norm(), e});
      }
    std::vector<std::array<Index, 2>> sorted;
    sorted.reserve(edges.size());
    for (const auto& [length, e] : edges) sorted.push_back(e);
    return sorted;
  }

  static bool contains(const Regions& all, const Regions& some) {
    return std::includes(all.begin(), all.end(), some.begin(), some.end());
  }
  /// Points on one side of a strip have equal regions, those at its ends more.
  static bool crosses_strip(const Regions& a, const Regions& b) {
    if (a.size() == 2 || b.size() == 2) return a != b;
    return !contains(a, b) && !contains(b, a);
  }

  /// The point that a collapsed point has become.
  Index current(Index p) const {
    for (auto next = moved_to_.find(p); next != moved_to_.end(); next = moved_to_.find(p)) p = next->second;
    return p;
  }

  struct Link {
    std::set<Index> points;
    std::set<std::array<Index, 2>> edges;
    std::set<Triangle> triangles;
  };
  Link link_of(Index p) const {
    Link link;
    for (const Index t : at_.at(p)) {
      if (removed_[t]) continue;
      Triangle face;
      std::copy_if(tets_[t].begin(), tets_[t].end(), face.begin(), [&](Index q) { return q != p; });
      std::sort(face.begin(), face.end());
      link.triangles.insert(face);
      for (std::size_t k = 0; k < 3; ++k) {
        link.points.insert(face[k]);
        link.edges.insert(ascending_edge(face[k], face[(k + 1) % 3]));
      }
    }
    return link;
  }
  template <class T>
  static std::set<T> common(const std::set<T>& a, const std::set<T>& b) {
    std::set<T> both;
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::inserter(both, both.end()));
    return both;
  }
  /// The link condition in a manifold without border: the links of both points meet in that of the edge.
  bool may_join(Index u, Index v) const {
    Link edge;
    for (const Index t : at_.at(u)) {
      if (removed_[t] || !has(tets_[t], v)) continue;
      std::array<Index, 2> opposite;
      std::copy_if(tets_[t].begin(), tets_[t].end(), opposite.begin(),
                   [&](Index q) { return q != u && q != v; });
      edge.edges.insert(ascending_edge(opposite[0], opposite[1]));
      edge.points.insert(opposite.begin(), opposite.end());
    }
    if (edge.edges.empty()) return false;
    const Link a = link_of(u), b = link_of(v);
    return common(a.points, b.points) == edge.points && common(a.edges, b.edges) == edge.edges &&
           common(a.triangles, b.triangles).empty();
  }

  /// The worst shape of the tets that stay if both points move to `place`.
  double worst_shape(Index u, Index v, const Vec3& place) const {
    double worst = HUGE_VAL;
    for (const Index p : {u, v})
      for (const Index t : at_.at(p)) {
        const Tet& ids = tets_[t];
        if (removed_[t] || !is_real(ids) || (has(ids, u) && has(ids, v))) continue;
        std::array<Vec3, 4> c;
        for (std::size_t k = 0; k < 4; ++k) c[k] = ids[k] == u || ids[k] == v ? place : at(ids[k]);
        if (!(orient3d(c[0], c[1], c[2], c[3]) > 0)) return 0;
        worst = std::min(worst, min_solid_angle(c[0], c[1], c[2], c[3]));
      }
    return worst;
  }

  std::optional<Vec3> on_curve(const Vec3& p) const {
    const auto hit =
        curves_.nearest_of(p, Strips::curve_reach * cell_, [](const ProjectionTree::Item&) { return true; });
    if (!hit) return {};
    return hit->point;
  }

  /// Where the point that two become may lie.
  std::vector<Vec3> candidates(Index u, Index v) const {
    const Regions &a = regions_.at(u), &b = regions_.at(v);
    const Vec3 middle = (at(u) + at(v)) / 2;
    const bool u_outside = a.contains(std::nullopt), v_outside = b.contains(std::nullopt);
    std::vector<Vec3> places;
    if (u_outside || v_outside) {
      // Points of the boundary stay on it; the end of the curve is a corner.
      if (const auto near = on_curve(at(u_outside ? u : v)))
        if (const auto end = surface_.onto_corner(*near, Strips::curve_reach * cell_);
            end && curves_.any_within(*end, Labelling::same_curve * cell_))
          places.push_back(*end);
      if (u_outside && v_outside) places.push_back(middle);
      if (u_outside) places.push_back(at(u));
      if (v_outside) places.push_back(at(v));
      return places;
    }
    if (contains(a, b) && contains(b, a)) return {at(u), at(v), middle};
    if (contains(a, b)) return {at(u), middle};
    if (contains(b, a)) return {at(v), middle};
    if (const auto near = on_curve(middle)) places.push_back(*near);
    places.insert(places.end(), {middle, at(u), at(v)});
    return places;
  }

  bool collapse(Index u, Index v) {
    if (u == v || !may_join(u, v)) return false;
    double best = Strips::min_solid_angle;
    std::optional<Vec3> place;
    for (const Vec3& p : candidates(u, v))
      if (const double worst = worst_shape(u, v, p); worst > best) best = worst, place = p;
    if (!place) return false;
    std::vector<Index>& kept = at_[u];
    for (const Index t : at_[v]) {
      if (removed_[t]) continue;
      if (has(tets_[t], u)) {
        removed_[t] = 1;
        continue;
      }
      std::replace(tets_[t].begin(), tets_[t].end(), v, u);
      kept.push_back(t);
    }
    std::erase_if(kept, [&](Index t) { return removed_[t] != 0; });
    mesh_.points[u] = *place;
    regions_[u].insert(regions_[v].begin(), regions_[v].end());
    moved_to_[v] = u;
    return true;
  }

  /// Takes over the remaining tets and drops unused points.
  void finish() {
    std::size_t count = 0;
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
      if (removed_[t]) continue;
      mesh_.tets[count] = tets_[t];
      if (parts_) parts_->of_tets[count] = parts_->of_tets[t];
      mesh_.materials[count++] = mesh_.materials[t];
    }
    if (parts_) parts_->of_tets.resize(count);
    mesh_.tets.resize(count);
    mesh_.materials.resize(count);
    std::vector<Index> number(mesh_.points.size(), no_index);
    for (const Tet& t : mesh_.tets)
      for (const Index p : t) number[p] = 0;
    Index used = 0;
    for (Index p = 0; p < number.size(); ++p) {
      if (number[p] == no_index) continue;
      mesh_.points[used] = mesh_.points[p];
      number[p] = used++;
    }
    mesh_.points.resize(used);
    for (Tet& t : mesh_.tets)
      for (Index& p : t) p = number[p];
    mesh_.interfaces = find_interfaces(mesh_);
  }

  TetMesh& mesh_;
  const FeatureSurface& surface_;
  const ProjectionTree& curves_;
  double cell_;
  SheetParts* parts_;
  Index beyond_ = no_index;
  std::vector<Tet> tets_;                   ///< those of the mesh, then those of the boundary's faces
  std::vector<char> removed_;               ///< by tet
  std::map<Index, std::vector<Index>> at_;  ///< tets at each point of a strip
  std::map<Index, Regions> regions_;        ///< at each point of a strip
  std::unordered_map<Index, Index> moved_to_;
};

}  // namespace

void collapse_strips(TetMesh& mesh, const LabelledComplex& complex, const FeatureSurface& surface,
                     double cell, SheetParts* parts) {
  const ProjectionTree curves = branching_curves(complex);
  if (curves.empty()) return;
  bool all = false;
  for (int round = 0; round < Strips::max_rounds; ++round) {
    if (StripCollapse(mesh, surface, curves, cell, parts).run(all)) continue;
    if (all) return;
    all = true;
  }
}

}  // namespace tetwright
