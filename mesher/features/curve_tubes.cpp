// SPDX-License-Identifier: Apache-2.0
#include "mesher/features/curve_tubes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "common/geometry/predicates.h"
#include "mesher/features/branching_curves.h"
#include "mesher/features/near_tets.h"
#include "mesher/features/strip_finder.h"
#include "mesher/features/tube_surface.h"
#include "mesher/features/untangling.h"
#include "mesher/tuning/cut_tuning.h"
#include "tetwright/mesh_quality.h"

namespace tetwright {

namespace {

using Tubes = CutTuning::Tubes;

class CurveTubes {
 public:
  CurveTubes(TetMesh& mesh, const LabelledComplex& complex, const StripFinder& finder,
             const FeatureSurface& surface, double cell, SheetParts* parts, Progress* progress)
      : mesh_(mesh),
        surface_(surface),
        cell_(cell),
        parts_(parts),
        progress_(progress),
        curves_(complex, finder.branching_edges(), finder.curve_ends()),
        radii_(std::begin(Tubes::radii), std::end(Tubes::radii)) {
    // Borders of sheets may be near.
    if (parts) std::sort(radii_.begin(), radii_.end());
    locate_points();
    near_.emplace(mesh, surface, parts, is_near_);
    divide_curves();
    tubes_.emplace(mesh, *near_, curves_, finder, nearest_, cell);
  }

  void run() {
    for (std::vector<Index> poor = grow_tubes(); !poor.empty(); poor = grow_tubes())
      if (!try_others(poor)) return;
    replace();
  }

 private:
  const Vec3& at(Index p) const { return mesh_.points[p]; }
  const BranchingCurves::Vertex& vertex(Index v) const { return curves_.vertices()[v]; }

  void locate_points() {
    is_near_.assign(mesh_.points.size(), 0);
    locations_.resize(mesh_.points.size());
    for (Index p = 0; p < mesh_.points.size(); ++p)
      if (const auto found = curves_.locate(at(p), Tubes::reach * cell_)) {
        is_near_[p] = 1;
        locations_[p] = *found;
      }
  }

  /// The longest edges along each curve, by cell.
  std::vector<std::vector<double>> longest_edges() const {
    std::vector<std::vector<double>> longest(curves_.size());
    for (Index c = 0; c < curves_.size(); ++c)
      longest[c].assign(static_cast<std::size_t>(curves_.length(c) / cell_) + 1, cell_);
    for (Index n = 0; n < near_->size(); ++n)
      for (const auto& [i, j] : tet_edges) {
        const Index a = near_->points_of(n)[i], b = near_->points_of(n)[j];
        for (const Index p : {a, b})
          if (is_near_[p] && locations_[p].distance < Tubes::sized_reach * cell_) {
            double& known = longest[locations_[p].curve][bin(locations_[p], longest[locations_[p].curve])];
            known = std::max(known, (at(a) - at(b)).norm());
          }
      }
    return longest;
  }

  /// Places the vertices of the chains so far apart that no edge of the mesh passes over two of them.
  void divide_curves() {
    const std::vector<std::vector<double>> longest = longest_edges();
    const auto size_at = [&](const BranchingCurves::Location& location) {
      const std::vector<double>& all = longest[location.curve];
      const std::size_t k = bin(location, all);
      return std::max({all[k], all[k > 0 ? k - 1 : 0], all[std::min(k + 1, all.size() - 1)]});
    };
    // A vertex at the rim of each ball around a branching point.
    const auto spacing = [&](Index curve, double along) {
      const double size = size_at({curve, along, 0}), rim = Tubes::node_radius * radii_[0] * size;
      const std::array<bool, 2> branches = curves_.branches(curve);
      const bool is_in_ball =
          (branches[0] && along < rim) || (branches[1] && curves_.length(curve) - along < rim);
      return is_in_ball ? rim : Tubes::spacing * size;
    };
    curves_.divide(spacing, Tubes::spacing_step * cell_);
    is_given_up_.assign(curves_.vertices().size(), 0);
    nearest_.assign(mesh_.points.size(), no_index);
    size_.assign(mesh_.points.size(), 0);
    for (Index p = 0; p < mesh_.points.size(); ++p) {
      if (!is_near_[p]) continue;
      nearest_[p] = curves_.nearest_vertex(locations_[p]);
      size_[p] = size_at(locations_[p]);
      for (const Index end : curves_.ends(locations_[p].curve)) {
        if (vertex(end).next.size() < 3) continue;
        const double distance = (vertex(end).position - at(p)).norm() / Tubes::node_radius;
        if (distance < Tubes::node_share * size_[p]) nearest_[p] = end;
        locations_[p].distance = std::min(locations_[p].distance, distance);
      }
    }
    trial_.assign(curves_.vertices().size(), 0);
  }
  std::size_t bin(const BranchingCurves::Location& location, const std::vector<double>& bins) const {
    return std::min(bins.size() - 1, static_cast<std::size_t>(location.along / cell_));
  }

  /// Whether a near tet may be part of a tube: all points near a curve, with a region of the curve, and at
  /// the boundary only where the curve is near it.
  bool may_be_inside(Index near) const {
    const RegionIndex region = surface_.region_of(near_->label(near).material);
    for (const Index p : near_->points_of(near)) {
      if (!is_near_[p] || locations_[p].distance > Tubes::max_growth * size_[p]) return false;
      const Index v = nearest_[p];
      if (is_given_up_[v]) return false;
      if (near_->is_on_boundary(p) && tubes_->steps_to_boundary(v) > Tubes::max_steps_to_boundary)
        return false;
      const auto has = [&](Index w) {
        return std::binary_search(vertex(w).regions.begin(), vertex(w).regions.end(), region);
      };
      if (!has(v) && std::none_of(vertex(v).next.begin(), vertex(v).next.end(), has)) return false;
    }
    return true;
  }

  void fill_tubes() {
    const auto is_in_radius = [&](Index p) {
      return is_near_[p] && locations_[p].distance < radii_[trial_[nearest_[p]]] * size_[p];
    };
    is_inside_.assign(near_->size(), 0);
    for (Index n = 0; n < near_->size(); ++n) {
      const Tet& t = near_->points_of(n);
      is_inside_[n] = std::any_of(t.begin(), t.end(), is_in_radius) && may_be_inside(n);
    }
  }

  /// Lets tubes grow until they can be meshed. \return the faces where that fails
  std::vector<Index> grow_tubes() {
    fill_tubes();
    std::vector<Index> poor;
    for (int round = 0; round < Tubes::max_rounds; ++round) {
      if (progress_) progress_->throw_if_stopped();
      tubes_->find(is_inside_);
      poor = poor_faces();
      if (!poor.empty()) {
        untangle_faces(poor);
        poor = poor_faces();
      }
      if (poor.empty() || !grow(poor)) break;
    }
    return poor;
  }

  /// Faces with tets that are not positive, those at points where bands of labels touch that should not or
  /// the outer faces touch themselves, and all of a vertex that a region of the curve does not reach.
  std::vector<Index> poor_faces() const {
    const std::vector<TubeSurface::Face>& faces = tubes_->faces();
    std::set<Index> poor;
    std::map<Index, std::set<RegionIndex>> reached;
    for (Index f = 0; f < faces.size(); ++f) {
      if (!is_good(faces[f])) poor.insert(f);
      const RegionIndex region = surface_.region_of(near_->label(faces[f].inner).material);
      for (const Index p : faces[f].ids) reached[tubes_->image(p)].insert(region);
    }
    for (const Index p : tubes_->points())
      if (!is_clean(p) || lacks_region(tubes_->image(p), reached))
        poor.insert(tubes_->faces_at(p).begin(), tubes_->faces_at(p).end());
    return {poor.begin(), poor.end()};
  }
  bool is_good(const TubeSurface::Face& f) const { return tubes_->shape(f) > Tubes::min_solid_angle; }
  /// Where a tube ends without the curve, strips go on.
  bool is_clean(Index p) const {
    const std::vector<Index>& next = vertex(tubes_->image(p)).next;
    return std::any_of(next.begin(), next.end(), [&](Index w) { return is_given_up_[w] != 0; }) ||
           tubes_->has_clean_bands(p);
  }
  bool lacks_region(Index v, const std::map<Index, std::set<RegionIndex>>& reached) const {
    const std::set<RegionIndex>& own = reached.at(v);
    return std::any_of(vertex(v).regions.begin(), vertex(v).regions.end(),
                       [&](RegionIndex r) { return r != outside_region && !own.contains(r); });
  }

  /// Adds the tets outside poor faces, or outside all faces at points where bands are not as they should be.
  /// \return whether there are any
  bool grow(const std::vector<Index>& poor) {
    const std::vector<TubeSurface::Face>& faces = tubes_->faces();
    std::set<Index> outer;
    for (const Index f : poor) {
      if (!is_good(faces[f])) {
        outer.insert(faces[f].outer);
        continue;
      }
      for (const Index p : faces[f].ids)
        if (!is_clean(p))
          for (const Index g : tubes_->faces_at(p)) outer.insert(faces[g].outer);
    }
    bool any = false;
    for (const Index n : outer) {
      if (n == NearTets::far || is_inside_[n] || !may_be_inside(n)) continue;
      is_inside_[n] = 1;
      any = true;
    }
    return any;
  }

  /// Moves points of faces with poor tets, and those around them, so that all tets are positive (untangle()).
  void untangle_faces(const std::vector<Index>& poor) {
    const std::vector<TubeSurface::Face>& faces = tubes_->faces();
    new_at_.clear();
    for (const TubeSurface::Face& f : faces)
      if (tubes_->shape(f) > TubeSurface::not_simplicial)
        tubes_->tets_of(f, [&](const Tet& t) {
          for (const Index p : t)
            if (p < tubes_->first_vertex()) new_at_[p].push_back(t);
        });
    std::set<Index> waiting;
    for (const Index f : poor)
      if (const double shape = tubes_->shape(faces[f]);
          shape > TubeSurface::not_simplicial && shape != Tubes::shape_in_sheet && !is_good(faces[f]))
        waiting.insert(f);
    while (!waiting.empty()) {
      if (progress_) progress_->throw_if_stopped();
      const std::set<Index> group = take_group(waiting);
      if (group.size() <= Tubes::max_group) untangle_points(group);
    }
  }
  /// Takes faces that are joined by common points out of a set. \return their points
  std::set<Index> take_group(std::set<Index>& waiting) const {
    std::set<Index> points;
    std::vector<Index> stack{*waiting.begin()};
    waiting.erase(waiting.begin());
    while (!stack.empty()) {
      const Index f = stack.back();
      stack.pop_back();
      for (const Index p : tubes_->faces()[f].ids) {
        if (!points.insert(p).second) continue;
        for (const Index g : tubes_->faces_at(p))
          if (waiting.erase(g)) stack.push_back(g);
      }
    }
    return points;
  }
  /// Visits the tets at a point as they will be.
  template <class Visit>
  void for_tets_at(Index p, const Visit& visit) const {
    if (const auto own = new_at_.find(p); own != new_at_.end())
      for (const Tet& t : own->second) visit(t);
    if (near_->has(p))
      for (const Index n : near_->at(p))
        if (!is_inside_[n]) visit(near_->points_of(n));
  }

  void untangle_points(const std::set<Index>& group) {
    std::set<Index> moving;
    for (const Index p : group) for_tets_at(p, [&](const Tet& t) { moving.insert(t.begin(), t.end()); });
    // All tets at a near point are known; vertices of chains stay.
    std::erase_if(moving, [&](Index p) { return p >= tubes_->first_vertex() || !is_near_[p]; });
    std::set<Tet> patch;
    for (const Index p : moving) for_tets_at(p, [&](const Tet& t) { patch.insert(t); });
    const Vec3 origin = at(*group.begin());
    std::map<Index, Index> local;
    std::vector<Vec3> points;
    std::vector<PointFreedom> freedom;
    std::vector<Tet> tets;
    for (const Tet& t : patch) {
      Tet ids;
      for (std::size_t k = 0; k < 4; ++k) {
        const auto [known, is_new] = local.try_emplace(t[k], static_cast<Index>(points.size()));
        ids[k] = known->second;
        if (!is_new) continue;
        points.push_back((tubes_->position(t[k]) - origin) / cell_);
        freedom.push_back(moving.contains(t[k]) ? freedom_of(t[k]) : PointFreedom{0});
      }
      tets.push_back(ids);
    }
    if (!untangle(points, tets, freedom)) return;
    std::map<Index, Vec3> before;
    bool is_valid = true;
    for (const Index p : moving) {
      const Index k = local.at(p);
      if (freedom[k].dimensions == 0) continue;
      before[p] = at(p);
      mesh_.points[p] = origin + cell_ * points[k];
      if (freedom[k].dimensions < 3) {
        const auto place = surface_.nearest(at(p), *near_->sheet_at(p), cell_);
        is_valid &= place.has_value();
        if (place) mesh_.points[p] = place->point;
      }
    }
    is_valid &= std::all_of(patch.begin(), patch.end(), [&](const Tet& t) {
      const Vec3 &a = tubes_->position(t[0]), &b = tubes_->position(t[1]), &c = tubes_->position(t[2]),
                 &d = tubes_->position(t[3]);
      return orient3d(a, b, c, d) > 0 && min_solid_angle(a, b, c, d) > Tubes::min_solid_angle;
    });
    for (const auto& [p, position] : before)
      if (is_valid)
        moved_from_.try_emplace(p, position);
      else
        mesh_.points[p] = position;
  }
  /// Points inside a region are free, those on one sheet stay on it, others stay.
  PointFreedom freedom_of(Index p) const {
    if (!near_->are_any_divided(near_->labels_at(p))) return {};
    PointFreedom own{0};
    const auto sheet = near_->sheet_at(p);
    const auto place = sheet ? surface_.nearest(at(p), *sheet, cell_) : std::nullopt;
    if (!place || place->normal.isZero()) return own;
    own.dimensions = 2;
    own.directions[0] = place->normal.unitOrthogonal();
    own.directions[1] = place->normal.cross(own.directions[0]);
    return own;
  }

  /// Chooses the next radius around poor faces; after the last, the mesh stays as it is near these. Each
  /// vertex has as many tries as there are radii, so that this ends.
  /// \return false if nothing changes
  bool try_others(const std::vector<Index>& poor) {
    for (const auto& [p, position] : moved_from_) mesh_.points[p] = position;
    moved_from_.clear();
    std::set<Index> vertices;
    for (const Index f : poor)
      for (const Index p : tubes_->faces()[f].ids) vertices.insert({tubes_->image(p), nearest_[p]});
    bool any = false;
    const auto give_up = [&](Index v) {
      any |= !is_given_up_[v];
      is_given_up_[v] = 1;
    };
    for (const Index v : vertices) {
      if (trial_[v] + 1 < radii_.size()) continue;
      give_up(v);
      for (const Index w : vertex(v).next) give_up(w);
    }
    for (int step = 0; step < Tubes::steps_of_change; ++step)
      for (const Index v : std::vector<Index>(vertices.begin(), vertices.end()))
        vertices.insert(vertex(v).next.begin(), vertex(v).next.end());
    for (const Index v : vertices)
      if (trial_[v] + 1 < radii_.size()) {
        ++trial_[v];
        any = true;
      }
    return any;
  }

  /// Replaces the tets of the tubes.
  void replace() {
    std::vector<Tet> tets;
    std::vector<MaterialTag> materials;
    std::vector<RegionIndex> parts;
    std::vector<std::uint8_t> is_removed(mesh_.tets.size(), 0);
    for (Index n = 0; n < near_->size(); ++n) is_removed[near_->in_mesh(n)] = is_inside_[n];
    for (Index t = 0; t < mesh_.tets.size(); ++t) {
      if (is_removed[t]) continue;
      tets.push_back(mesh_.tets[t]);
      materials.push_back(mesh_.materials[t]);
      if (parts_) parts.push_back(parts_->of_tets[t]);
    }
    for (const TubeSurface::Face& f : tubes_->faces())
      tubes_->tets_of(f, [&](const Tet& t) {
        tets.push_back(t);
        materials.push_back(mesh_.materials[near_->in_mesh(f.inner)]);
        if (parts_) parts.push_back(parts_->of_tets[near_->in_mesh(f.inner)]);
      });
    std::vector<Vec3> points = mesh_.points;
    for (const BranchingCurves::Vertex& v : curves_.vertices()) points.push_back(v.position);
    std::vector<Index> number(points.size(), no_index);
    for (const Tet& t : tets)
      for (const Index p : t) number[p] = 0;
    mesh_.points.clear();
    for (Index p = 0; p < points.size(); ++p) {
      if (number[p] == no_index) continue;
      number[p] = static_cast<Index>(mesh_.points.size());
      mesh_.points.push_back(points[p]);
    }
    for (Tet& t : tets)
      for (Index& p : t) p = number[p];
    mesh_.tets = std::move(tets);
    mesh_.materials = std::move(materials);
    if (parts_) parts_->of_tets = std::move(parts);
    mesh_.interfaces = find_interfaces(mesh_);
  }

  TetMesh& mesh_;
  const FeatureSurface& surface_;
  double cell_;
  SheetParts* parts_;
  Progress* progress_;
  BranchingCurves curves_;
  std::vector<double> radii_;          ///< in the order in which they are tried, as Tubes::radii
  std::vector<std::uint8_t> is_near_;  ///< by point
  std::vector<BranchingCurves::Location> locations_;  ///< by point, if near
  std::vector<Index> nearest_;                        ///< by point, vertex of the chains
  std::vector<double> size_;                          ///< by point, the longest edges around the curve there
  std::optional<NearTets> near_;
  std::optional<TubeSurface> tubes_;
  std::vector<std::uint8_t> is_inside_;       ///< by near tet: part of a tube
  std::map<Index, std::vector<Tet>> new_at_;  ///< tets of the tubes at outer points
  std::map<Index, Vec3> moved_from_;          ///< previous positions of points that made room
  std::vector<std::uint8_t> is_given_up_;     ///< by vertex of the chains
  std::vector<std::size_t> trial_;            ///< by vertex of the chains, the radius that is tried
};

}  // namespace

StripReport remesh_curve_tubes(TetMesh& mesh, const LabelledComplex& complex, const FeatureSurface& surface,
                               double cell, SheetParts* parts, Progress* progress) {
  const StripFinder finder(complex, surface, cell, parts);
  if (finder.branching_edges().empty()) return {};
  CurveTubes(mesh, complex, finder, surface, cell, parts, progress).run();
  const std::vector<Triangle> left = finder.faces(mesh);
  if (left.empty()) return {};
  const Triangle& first = left.front();
  return {left.size(), (mesh.points[first[0]] + mesh.points[first[1]] + mesh.points[first[2]]) / 3};
}

}  // namespace tetwright
