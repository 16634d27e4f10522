// SPDX-License-Identifier: Apache-2.0
#include "mesher/features/strip_collapse.h"

#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>

#include "common/geometry/predicates.h"
#include "mesher/features/strip_finder.h"
#include "mesher/features/untangling.h"
#include "mesher/tuning/cut_tuning.h"
#include "tetwright/mesh_quality.h"

namespace tetwright {

namespace {

using Strips = CutTuning::Strips;
using Labelling = CutTuning::Labelling;

class StripCollapse {
 public:
  StripCollapse(TetMesh& mesh, const FeatureSurface& surface, const StripFinder& finder, double cell,
                SheetParts* parts, Progress* progress)
      : mesh_(mesh), surface_(surface), finder_(finder), cell_(cell), parts_(parts), progress_(progress) {}

  /// How far the collapse goes.
  enum class Effort : std::uint8_t {
    across,    ///< edges across strips only
    all,       ///< all edges of their faces: what is left of strips has all its points on the curve
    make_room  ///< all edges, and points around an edge make room for the collapse
  };

  /// \return whether anything was collapsed
  bool run(Effort effort) {
    const std::vector<Triangle> strip = finder_.faces(mesh_);
    const std::vector<std::array<Index, 2>> ends = finder_.edges(mesh_, !strip.empty());
    if (strip.empty() && ends.empty()) return false;
    std::set<Index> points = points_of(strip);
    for (const std::array<Index, 2>& e : ends) points.insert(e.begin(), e.end());
    gather(points);
    makes_room_ = effort == Effort::make_room;
    if (makes_room_) {
      for (const auto& [p, tets] : at_)
        for (const Index t : tets) points.insert(tets_[t].begin(), tets_[t].end());
      points.erase(beyond_);
      gather(points);
    }
    bool any = false;
    for (const auto& [u, v] : edges_of(strip, ends, effort != Effort::across)) {
      if (progress_) progress_->throw_if_stopped();
      any |= collapse(current(u), current(v));
    }
    if (any || split_) finish();
    return any;
  }

 private:
  using Regions = std::set<MaterialOrOutside>;

  const Vec3& at(Index p) const { return mesh_.points[p]; }
  bool is_real(const Tet& t) const { return t[3] != beyond_; }
  /// The part or material of a tet; nothing outside, also where the outside is meshed.
  MaterialOrOutside label(Index t) const {
    if (!is_real(tets_[t]) || material_of_[t] == outside_tag) return {};
    return parts_ ? MaterialTag{part_of_[t]} : material_of_[t];
  }
  static bool has(const Tet& t, Index p) { return std::find(t.begin(), t.end(), p) != t.end(); }

  static std::set<Index> points_of(const std::vector<Triangle>& faces) {
    std::set<Index> points;
    for (const Triangle& f : faces) points.insert(f.begin(), f.end());
    return points;
  }

  /// Collects the tets at some points, and the regions there. Boundary faces become tets with a common point
  /// beyond the boundary, so that the mesh has no border.
  void gather(const std::set<Index>& points) {
    tets_ = mesh_.tets;
    material_of_ = mesh_.materials;
    if (parts_) part_of_ = parts_->of_tets;
    at_.clear();
    for (const Index p : points) at_[p];
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
    material_of_.resize(tets_.size());
    if (parts_) part_of_.resize(tets_.size());
    removed_.assign(tets_.size(), 0);
    regions_.clear();
    for (const auto& [p, tets] : at_) {
      Regions& own = regions_[p];
      for (const Index t : tets) own.insert(label(t));
    }
  }

  /// The edges of the strips' faces, or only those that join its sides, or an inner point to one, and further
  /// ones; shortest first.
  std::vector<std::array<Index, 2>> edges_of(const std::vector<Triangle>& strip,
                                             const std::vector<std::array<Index, 2>>& further, bool all) {
    std::set<std::pair<double, std::array<Index, 2>>> edges;
    for (const std::array<Index, 2>& e : further) edges.insert({(at(e[0]) - at(e[1])).norm(), e});
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
  /// Corners of what the links of two points have in common but that of their edge has not, so that the
  /// points must not be joined (link condition in a manifold without border); nothing if they have no edge.
  std::optional<std::set<Index>> in_the_way(Index u, Index v) const {
    Link edge;
    for (const Index t : at_.at(u)) {
      if (removed_[t] || !has(tets_[t], v)) continue;
      std::array<Index, 2> opposite;
      std::copy_if(tets_[t].begin(), tets_[t].end(), opposite.begin(),
                   [&](Index q) { return q != u && q != v; });
      edge.edges.insert(ascending_edge(opposite[0], opposite[1]));
      edge.points.insert(opposite.begin(), opposite.end());
    }
    if (edge.edges.empty()) return {};
    const Link a = link_of(u), b = link_of(v);
    std::set<Index> found;
    for (const Index p : common(a.points, b.points))
      if (!edge.points.contains(p)) found.insert(p);
    for (const std::array<Index, 2>& e : common(a.edges, b.edges))
      if (!edge.edges.contains(e)) found.insert(e.begin(), e.end());
    for (const Triangle& f : common(a.triangles, b.triangles)) found.insert(f.begin(), f.end());
    return found;
  }

  /// Splits the longer of the edges from a point to two others, so that it is no longer joined to both.
  /// \return false if a tet would have too small a solid angle
  bool part_from(Index p, Index u, Index v) {
    const Index end = (at(u) - at(p)).squaredNorm() >= (at(v) - at(p)).squaredNorm() ? u : v;
    const Vec3 position = (at(end) + at(p)) / 2;
    std::vector<Index> around = at_.at(end);
    std::erase_if(around, [&](Index t) { return removed_[t] || !has(tets_[t], p); });
    for (const Index t : around)
      for (const Index replaced : {p, end}) {
        std::array<Vec3, 4> c;
        for (std::size_t k = 0; is_real(tets_[t]) && k < 4; ++k)
          c[k] = tets_[t][k] == replaced ? position : at(tets_[t][k]);
        if (is_real(tets_[t]) && !(orient3d(c[0], c[1], c[2], c[3]) > 0 &&
                                   min_solid_angle(c[0], c[1], c[2], c[3]) > Strips::min_solid_angle))
          return false;
      }
    const auto middle = static_cast<Index>(mesh_.points.size());
    mesh_.points.push_back(position);
    std::vector<Index>& own = at_[middle];
    for (const Index t : around) {
      const auto added = static_cast<Index>(tets_.size());
      tets_.push_back(tets_[t]);
      material_of_.push_back(material_of_[t]);
      if (parts_) part_of_.push_back(part_of_[t]);
      removed_.push_back(0);
      std::replace(tets_[t].begin(), tets_[t].end(), p, middle);
      std::replace(tets_[added].begin(), tets_[added].end(), end, middle);
      own.insert(own.end(), {t, added});
      for (const Index q : tets_[added])
        if (const auto known = at_.find(q); q != middle && known != at_.end()) {
          if (q == p) std::erase(known->second, t);
          known->second.push_back(added);
        }
    }
    split_ = true;
    Regions& regions = regions_[middle];
    for (const Index t : own) regions.insert(label(t));
    return true;
  }

  /// The worst shape of the tets that stay if both points move to a position: the smallest solid angle, or
  /// below 0 the smallest volume over the cube of the cell, if one would not be positive.
  double worst_shape(Index u, Index v, const Vec3& position) const {
    return std::min(worst_shape_at(u, u, v, position), worst_shape_at(v, u, v, position));
  }
  /// As above, but only of the tets at a point.
  double worst_shape_at(Index p, Index u, Index v, const Vec3& position) const {
    double worst = HUGE_VAL;
    for (const Index t : at_.at(p)) {
      const Tet& ids = tets_[t];
      if (removed_[t] || !is_real(ids) || (has(ids, u) && has(ids, v))) continue;
      std::array<Vec3, 4> c;
      for (std::size_t k = 0; k < 4; ++k) c[k] = ids[k] == u || ids[k] == v ? position : at(ids[k]);
      if (orient3d(c[0], c[1], c[2], c[3]) > 0)
        worst = std::min(worst, min_solid_angle(c[0], c[1], c[2], c[3]));
      else
        worst = std::min(
            worst, -std::abs((c[1] - c[0]).cross(c[2] - c[0]).dot(c[3] - c[0])) / (cell_ * cell_ * cell_));
    }
    return worst;
  }

  std::optional<Vec3> on_curve(const Vec3& p) const {
    const auto hit = finder_.curves().nearest_of(p, Strips::curve_reach * cell_,
                                                 [](const ProjectionTree::Item&) { return true; });
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
            end && finder_.curves().any_within(*end, Labelling::same_curve * cell_))
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

  bool is_inner(Index p) const { return !regions_.at(p).contains(std::nullopt); }

  /// Moves a position to where `shape` is larger, by a compass search (Kolda, Lewis and Torczon 2003, section
  /// 1), until it exceeds the limit.
  /// \param best the shape at the position; receives that of the result
  template <class Shape>
  void search(Vec3& position, double& best, const Shape& shape) const {
    for (double step = Strips::first_step; best <= Strips::min_solid_angle && step > Strips::last_step;) {
      const Vec3 from = position;
      for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
          for (int z = -1; z <= 1; ++z) {
            const Vec3 p = from + step * cell_ * Vec3(x, y, z);
            if (const double worst = shape(p); worst > best) best = worst, position = p;
          }
      if (position == from) step /= 2;
    }
  }

  /// Inner points around an edge, except its ends.
  std::set<Index> points_around(Index u, Index v) const {
    std::set<Index> around;
    for (const Index p : {u, v})
      for (const Index t : at_.at(p))
        if (!removed_[t])
          for (const Index q : tets_[t])
            if (q != u && q != v && q != beyond_ && at_.contains(q) && is_inner(q)) around.insert(q);
    return around;
  }

  /// The candidate with the best shapes; if none has tets of positive volume, what is found from there, and
  /// then, if points make room, what is found while the points around move, too. These are moved only if a
  /// position is found.
  /// \param before receives the previous positions of points that moved
  std::optional<Vec3> best_position(Index u, Index v, std::map<Index, Vec3>& before) {
    double best = -HUGE_VAL;
    Vec3 position = at(u);
    for (const Vec3& p : candidates(u, v))
      if (const double worst = worst_shape(u, v, p); worst > best) best = worst, position = p;
    const auto shape = [&](const Vec3& p) { return worst_shape(u, v, p); };
    const bool is_free = is_inner(u) && is_inner(v);
    if (is_free) search(position, best, shape);
    if (best > Strips::min_solid_angle) return position;
    if (!makes_room_) return {};

    const std::set<Index> around = points_around(u, v);
    for (const Index q : around) before.try_emplace(q, at(q));
    for (int sweep = 0; sweep < Strips::max_sweeps && best <= Strips::min_solid_angle; ++sweep) {
      for (const Index q : around) {
        Vec3 moved = at(q);
        const auto shape_at = [&](const Vec3& p) {
          if ((p - before.at(q)).norm() > Strips::max_room * cell_) return -HUGE_VAL;
          mesh_.points[q] = p;
          return worst_shape_at(q, u, v, position);
        };
        double own = shape_at(moved);
        search(moved, own, shape_at);
        mesh_.points[q] = moved;
      }
      best = worst_shape(u, v, position);
      if (is_free) search(position, best, shape);
    }
    bool valid = best > Strips::min_solid_angle;
    for (const Index q : around) valid &= worst_shape_at(q, u, v, position) > Strips::min_solid_angle;
    if (valid) return position;
    restore(before);
    return untangled(u, v, around, position, before);
  }

  /// Moves all points around an edge together so that its collapse leaves positive tets.
  /// \param position a first guess
  std::optional<Vec3> untangled(Index u, Index v, const std::set<Index>& around, const Vec3& position,
                                std::map<Index, Vec3>& before) {
    std::map<Index, Index> local;
    std::vector<Vec3> points;
    std::vector<std::uint8_t> is_locked;
    const auto number = [&](Index p) {
      if (p == v) p = u;
      const auto [known, is_new] = local.try_emplace(p, static_cast<Index>(points.size()));
      if (is_new) {
        points.push_back(((p == u ? position : at(p)) - position) / cell_);
        is_locked.push_back(p == u ? !(is_inner(u) && is_inner(v)) : !around.contains(p));
      }
      return known->second;
    };
    std::set<Index> patch;
    std::set<Index> moving = around;
    moving.insert({u, v});
    for (const Index p : moving)
      for (const Index t : at_.at(p))
        if (!removed_[t] && is_real(tets_[t]) && !(has(tets_[t], u) && has(tets_[t], v))) patch.insert(t);
    std::vector<Tet> tets;
    for (const Index t : patch) {
      Tet ids;
      std::transform(tets_[t].begin(), tets_[t].end(), ids.begin(), number);
      tets.push_back(ids);
    }
    if (!untangle(points, tets, is_locked)) return {};
    for (const Tet& t : tets)
      if (!(orient3d(points[t[0]], points[t[1]], points[t[2]], points[t[3]]) > 0)) return {};
    for (const Index q : around) {
      before.try_emplace(q, at(q));
      mesh_.points[q] = position + cell_ * points[local.at(q)];
    }
    const Vec3 result = position + cell_ * points[local.at(u)];
    bool valid = worst_shape(u, v, result) > Strips::min_solid_angle;
    for (const Index q : around) valid &= worst_shape_at(q, u, v, result) > Strips::min_solid_angle;
    if (valid) return result;
    restore(before);
    return {};
  }

  void restore(std::map<Index, Vec3>& before) {
    for (const auto& [q, p] : before) mesh_.points[q] = p;
    before.clear();
  }

  bool collapse(Index u, Index v) {
    if (u == v) return false;
    std::optional<std::set<Index>> others = in_the_way(u, v);
    if (!others) return false;
    std::map<Index, Vec3> before;
    if (!others->empty()) {
      if (others->size() > Strips::max_splits || others->contains(beyond_)) return false;
      // Where no points make room, edges are split only if there is a position; else it can only be sought
      // once the points may be joined.
      if (!makes_room_ && !best_position(u, v, before)) return false;
      for (const Index p : *others)
        if (!part_from(p, u, v)) return false;
      others = in_the_way(u, v);
      if (!others || !others->empty()) return false;
    }
    const std::optional<Vec3> position = best_position(u, v, before);
    if (!position) return false;
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
    mesh_.points[u] = *position;
    regions_[u].insert(regions_[v].begin(), regions_[v].end());
    moved_to_[v] = u;
    return true;
  }

  /// Takes over the remaining tets and drops unused points.
  void finish() {
    mesh_.tets.clear();
    mesh_.materials.clear();
    if (parts_) parts_->of_tets.clear();
    for (std::size_t t = 0; t < tets_.size(); ++t) {
      if (removed_[t] || !is_real(tets_[t])) continue;
      mesh_.tets.push_back(tets_[t]);
      mesh_.materials.push_back(material_of_[t]);
      if (parts_) parts_->of_tets.push_back(part_of_[t]);
    }
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
  const StripFinder& finder_;
  double cell_;
  SheetParts* parts_;
  Progress* progress_;
  static constexpr Index beyond_ = no_index;
  std::vector<Tet> tets_;  ///< those of the mesh, those of the boundary's faces, and those of splits
  std::vector<MaterialTag> material_of_;    ///< by tet
  std::vector<RegionIndex> part_of_;        ///< by tet, if there are parts
  std::vector<char> removed_;               ///< by tet
  std::map<Index, std::vector<Index>> at_;  ///< tets at each point of a strip
  std::map<Index, Regions> regions_;        ///< at each point of a strip
  std::unordered_map<Index, Index> moved_to_;
  bool split_ = false;
  bool makes_room_ = false;
};

}  // namespace

void collapse_strips(TetMesh& mesh, const LabelledComplex& complex, const FeatureSurface& surface,
                     double cell, SheetParts* parts, Progress* progress) {
  const StripFinder finder(complex, surface, cell, parts);
  if (finder.curves().empty()) return;
  using Effort = StripCollapse::Effort;
  for (const Effort effort : {Effort::across, Effort::all, Effort::make_room})
    for (int round = 0; round < Strips::max_rounds; ++round)
      if (!StripCollapse(mesh, surface, finder, cell, parts, progress).run(effort)) break;
}

}  // namespace tetwright
