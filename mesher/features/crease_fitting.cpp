// SPDX-License-Identifier: Apache-2.0
#include "mesher/features/crease_fitting.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>

#include "common/geometry/predicates.h"
#include "common/parallel/parallel_sort.h"
#include "mesher/cut/backtracking_displacement.h"
#include "mesher/cut/undo_intersections.h"
#include "mesher/features/crease_labels.h"
#include "mesher/features/joint_fitting.h"
#include "mesher/features/patch_specks.h"
#include "mesher/tuning/cut_tuning.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

using Fitting = CutTuning::Fitting;

using Kind = FeatureLabel::Kind;

/// Moves the points of a mesh to the targets that their labels determine.
class Fitter {
 public:
  Fitter(TetMesh& mesh, const FeatureSurface& surface, const CreaseLabels& labels, const MaterialField& field,
         double cell)
      : mesh_(mesh), surface_(surface), labels_(labels), field_(field), cell_(cell) {
    if (surface.is_surrounded())
      for (const Index p : labels.points())
        if (const unsigned planes = surface.border_planes(mesh.points[p])) planes_[p] = planes;
  }

  void run() {
    if (surface_.has_junctions()) {
      unfold_junctions();
      find_points_beside_gaps();
    }
    const bool meets_others = surface_.has_junctions() || surface_.is_surrounded();
    std::vector<double> floors(std::begin(Fitting::pass_floors), std::end(Fitting::pass_floors));
    const double last = floors.back();
    if (meets_others) floors.insert(floors.end(), Fitting::junction_passes, last);
    for (const double floor : floors) {
      if (!move(floor)) return;
      if (meets_others) move_one_by_one(floor);
      make_room(remaining_moves(floor));
    }
    move(last);
    if (!meets_others) return;
    move_one_by_one(last);
    move_jointly(mesh_, surface_, labels_, remaining_moves(last), cell_);
  }

 private:
  /// The target position of vertex p if it were at `at`.
  std::optional<Vec3> place_of(Index p, const Vec3& at) const {
    const auto held = planes_.find(p);
    return feature_target(surface_, labels_.of(p), at, cell_, held == planes_.end() ? 0 : held->second);
  }

  /// The two neighbours of each point along a junction of the mesh; no entry for ends and branches.
  std::map<Index, std::array<Index, 2>> junction_neighbours() const {
    std::map<Index, std::array<Index, 2>> neighbours;
    for (const auto& [p, others] : labels_.junction_neighbours())
      if (others.size() == 2 && labels_.of(p).kind == Kind::crease) neighbours[p] = {others[0], others[1]};
    return neighbours;
  }

  /// Finds other targets for points of junctions that would change their order along the curve or come close
  /// to each other: half way between those of their neighbours. The mesh's junctions are as jagged as cells,
  /// so that nearest points on the curve need not be in order.
  void unfold_junctions() {
    const std::map<Index, std::array<Index, 2>> neighbours = junction_neighbours();
    std::map<Index, Vec3> targets;
    const auto target_of = [&](Index p) {
      if (const auto known = targets.find(p); known != targets.end()) return known->second;
      return place_of(p, mesh_.points[p]).value_or(mesh_.points[p]);
    };
    for (const auto& [p, ends] : neighbours)
      for (const Index q : {p, ends[0], ends[1]}) targets.try_emplace(q, target_of(q));
    for (int round = 0; round < Fitting::unfolding_rounds; ++round) {
      bool any = false;
      for (const auto& [p, ends] : neighbours) {
        const Vec3 &from = targets.at(ends[0]), &to = targets.at(ends[1]), &at = targets.at(p);
        const double min_distance = Fitting::min_junction_share * (to - from).norm();
        if ((at - from).dot(to - from) > min_distance * (to - from).norm() &&
            (to - at).dot(to - from) > min_distance * (to - from).norm())
          continue;
        const auto middle = on_curve_of(p, (from + to) / 2);
        if (!middle) continue;
        any = true;
        targets.at(p) = *middle;
        unfolded_[p] = *middle;
      }
      if (!any) return;
    }
  }

  /// The nearest point of all curves between the patches of a point of a junction: beside a corner the
  /// nearest curve may have been another one.
  std::optional<Vec3> on_curve_of(Index p, const Vec3& at) const {
    const PatchSet& own = labels_.of(p).patches;
    const auto place = surface_.nearest_crease(
        at, Fitting::target_reach * cell_, [&](const FeatureSurface::PatchPair& pair) {
          return own.contains(pair[0]) && own.contains(pair[1]) &&
                 surface_.sheet_of(pair[0]) != surface_.sheet_of(pair[1]);
        });
    if (!place) return {};
    return place->point;
  }

  /// Moves points towards their targets; false if all have arrived.
  bool move(double floor) {
    std::vector<PointMove> moves = remaining_moves(floor);
    if (!moves.empty())
      displace_with_backtracking(mesh_.points, mesh_.tets, moves,
                                 floor * CutTuning::Shapes::tangent_of_bad_tet);
    return !moves.empty();
  }

  /// Moves points on their own. In simultaneous moves one point that cannot arrive holds back all those that
  /// share tets with it, and their neighbours in turn.
  void move_one_by_one(double floor) {
    const std::vector<PointMove> moves = remaining_moves(floor);
    if (moves.empty()) return;
    std::vector<Index> number(mesh_.points.size(), no_index);
    for (std::size_t m = 0; m < moves.size(); ++m) number[moves[m].point] = static_cast<Index>(m);
    std::vector<std::vector<Index>> stars(moves.size());
    for (Index t = 0; t < mesh_.tets.size(); ++t)
      for (const Index p : mesh_.tets[t])
        if (number[p] != no_index) stars[number[p]].push_back(t);
    const double min_tangent = floor * CutTuning::Shapes::tangent_of_bad_tet;
    std::vector<double> before;
    for (std::size_t m = 0; m < moves.size(); ++m) {
      Vec3& at = mesh_.points[moves[m].point];
      before.clear();
      for (const Index t : stars[m]) before.push_back(tangent_of(mesh_.tets[t]));
      const auto is_valid = [&] {
        for (std::size_t i = 0; i < stars[m].size(); ++i)
          if (tangent_of(mesh_.tets[stars[m][i]]) < std::min(min_tangent, before[i])) return false;
        return true;
      };
      at = moves[m].from + moves[m].step;
      for (int halvings = 1; !is_valid(); ++halvings) {
        const bool gives_up = halvings > Fitting::max_own_halvings;
        at = moves[m].from + (gives_up ? 0 : std::ldexp(1, -halvings)) * moves[m].step;
        if (gives_up) break;
      }
    }
  }

  /// True for vertices of thickened walls in passes that would spoil their tets.
  bool must_stay(Index p, double floor) const {
    const WallChanges* walls = field_.wall_changes();
    if (!walls || floor >= Fitting::wall_floor || labels_.of(p).kind != Kind::patch) return false;
    const Vec3 at = field_.frame().to_grid(mesh_.points[p]);
    if (!walls->contains(at)) return false;
    // Around bodies with smaller cells all distances are exact, and few walls are thickened.
    const auto cell = surface_.cell_of(surface_.sheet_of(*labels_.of(p).patches.begin()));
    return !cell || walls->parallel_thickness(at) * field_.frame().cell_size < Fitting::thick_wall * *cell;
  }

  std::vector<PointMove> remaining_moves(double floor) {
    const std::vector<Index>& points = labels_.points();
    targets_.resize(points.size());
    const auto collect = [&](std::size_t begin, std::size_t end, std::vector<PointMove>& out) {
      for (std::size_t i = begin; i < end; ++i) {
        if (must_stay(points[i], floor)) continue;
        const Vec3& at = mesh_.points[points[i]];
        const std::optional<Vec3>& target = target_of(i);
        if (target && (*target - at).norm() > Fitting::arrived * cell_)
          out.push_back({points[i], at, *target - at});
      }
    };
    return parallel_collect<PointMove>(0, points.size(), CutGrains::searches, collect);
  }
  /// The target of a point of the labels' list. Searched for again only if the point has moved.
  const std::optional<Vec3>& target_of(std::size_t i) {
    const Index p = labels_.points()[i];
    Target& known = targets_[i];
    if (known.is_known && known.at == mesh_.points[p]) return known.position;
    known.is_known = true;
    known.at = mesh_.points[p];
    const auto unfolded = planes_.contains(p) ? unfolded_.end() : unfolded_.find(p);
    known.position = unfolded == unfolded_.end() ? place_of(p, known.at) : unfolded->second;
    return known.position;
  }

  double tangent_of(const Tet& t) const {
    return min_solid_angle_tangent(mesh_.points[t[0]], mesh_.points[t[1]], mesh_.points[t[2]],
                                   mesh_.points[t[3]]);
  }

  /// Moves the neighbours of points that have not arrived so that the worst tet at each neighbour improves.
  void make_room(const std::vector<PointMove>& waiting) {
    std::vector<std::uint8_t> role(mesh_.points.size(), 0);  // 1: waits, 2: adjacent to a waiting point
    for (const PointMove& m : waiting) role[m.point] = 1;
    const auto tets_with = [&](std::uint8_t wanted) {
      return parallel_collect<Index>(0, mesh_.tets.size(), CutGrains::tets,
                                     [&](std::size_t begin, std::size_t end, std::vector<Index>& out) {
                                       for (std::size_t t = begin; t < end; ++t)
                                         if (std::any_of(mesh_.tets[t].begin(), mesh_.tets[t].end(),
                                                         [&](Index p) { return role[p] == wanted; }))
                                           out.push_back(static_cast<Index>(t));
                                     });
    };
    std::vector<Index> beside;
    // Near junctions many points wait for each other, since the curve goes where the regions meet.
    const int last_role = surface_.has_junctions() || surface_.is_surrounded() ? 1 : 0;
    for (const Index t : tets_with(1))
      for (const Index p : mesh_.tets[t])
        if (role[p] <= last_role && is_movable(p)) {
          role[p] = 2;
          beside.push_back(p);
        }
    std::sort(beside.begin(), beside.end());
    std::vector<Index> number(mesh_.points.size(), no_index);
    for (std::size_t i = 0; i < beside.size(); ++i) number[beside[i]] = static_cast<Index>(i);
    std::vector<std::vector<Index>> stars(beside.size());
    for (const Index t : tets_with(2))
      for (const Index p : mesh_.tets[t])
        if (number[p] != no_index) stars[number[p]].push_back(t);
    for (int sweep = 0; sweep < Fitting::room_sweeps; ++sweep)
      for (std::size_t i = 0; i < beside.size(); ++i) find_better_place(beside[i], stars[i]);
  }

  /// Marks the points of faces that have a point at a closed gap.
  void find_points_beside_gaps() {
    const std::vector<std::uint8_t> at_gap = labels_.points_at_gaps();
    beside_gap_.assign(mesh_.points.size(), 0);
    for (const InterfaceTriangle& t : mesh_.interfaces)
      if (std::any_of(t.ids.begin(), t.ids.end(), [&](Index p) { return at_gap[p] != 0; }))
        for (const Index p : t.ids) beside_gap_[p] = 1;
  }

  bool is_movable(Index p) const {
    // Where a gap ends faces are close to each other across the outside, where no tet keeps them apart.
    if (!beside_gap_.empty() && beside_gap_[p]) return false;
    const Kind kind = labels_.of(p).kind;
    return kind == Kind::patch || kind == Kind::crease || !labels_.on_boundary(p) || labels_.is_loose(p);
  }

  void find_better_place(Index p, const std::vector<Index>& star) {
    Vec3& at = mesh_.points[p];
    const auto worst_at = [&](const Vec3& place, Index* worst_tet) {
      at = place;
      double worst = std::numeric_limits<double>::infinity();
      for (const Index t : star)
        if (const double tangent = tangent_of(mesh_.tets[t]); tangent < worst) {
          worst = tangent;
          if (worst_tet) *worst_tet = t;
        }
      return worst;
    };
    const Vec3 from = at;
    Index worst_tet = star.front();
    double best = worst_at(from, &worst_tet);
    if (best >= CutTuning::Shapes::tangent_of_bad_tet) return;
    Vec3 centre = Vec3::Zero();
    double edges = 0, count = 0;
    for (const Index t : star)
      for (const Index q : mesh_.tets[t]) {
        if (q == p) continue;
        centre += mesh_.points[q];
        edges += (mesh_.points[q] - from).norm();
        ++count;
      }
    const double edge = edges / count;
    // Away from the face of the worst tet that the point is too close to, or to the middle.
    const Tet& t = mesh_.tets[worst_tet];
    const auto slot = static_cast<std::size_t>(std::find(t.begin(), t.end(), p) - t.begin());
    const auto& face = tet_faces[slot];
    const Vec3& a = mesh_.points[t[face[0]]];
    const Vec3 out = (mesh_.points[t[face[1]]] - a).cross(mesh_.points[t[face[2]]] - a);
    Vec3 best_place = from;
    for (const Vec3& direction : {Vec3(-out.normalized()), Vec3((centre / count - from).normalized())}) {
      if (!direction.allFinite()) continue;
      for (const double step : Fitting::room_steps) {
        Vec3 place = from + step * edge * direction;
        if (labels_.on_boundary(p) && !labels_.is_loose(p)) {
          const auto on = place_of(p, place);
          if (!on) continue;
          place = *on;
        }
        if (const double worst = worst_at(place, nullptr); worst > best) {
          best = worst;
          best_place = place;
        }
      }
    }
    at = best_place;
  }

  TetMesh& mesh_;
  const FeatureSurface& surface_;
  const CreaseLabels& labels_;
  const MaterialField& field_;
  double cell_;
  struct Target {
    bool is_known = false;
    Vec3 at = Vec3::Zero();  ///< where the point was then
    std::optional<Vec3> position;
  };
  std::vector<Target> targets_;           ///< by index in the list of labelled points
  std::map<Index, Vec3> unfolded_;        ///< targets of unfold_junctions()
  std::map<Index, unsigned> planes_;      ///< of the border of a volume in which points stay, bits
  std::vector<std::uint8_t> beside_gap_;  ///< by point; empty without junctions
};

/// The patch of a face: the one common to its vertices. If several or none are common, the closest and best
/// aligned patch.
FeatureSurface::Patch patch_of(const TetMesh& mesh, const InterfaceTriangle& t, const CreaseLabels& labels,
                               const FeatureSurface& surface, double cell) {
  const std::optional<std::size_t> sheet = labels.sheet_of(t);
  if (!sheet) return surface.no_patch();
  PatchSet candidates;
  bool first = true;
  for (const Index p : t.ids) {
    const PatchSet own = labels.patches_on(p, *sheet);
    if (labels.of(p).kind == Kind::none && own.size() == 0) continue;
    candidates = first ? own : candidates.common(own);
    first = false;
  }
  if (candidates.size() == 1) return *candidates.begin();
  if (candidates.size() == 0)
    for (const Index p : t.ids)
      for (const FeatureSurface::Patch patch : labels.patches_on(p, *sheet)) candidates.insert(patch);
  const Vec3 &a = mesh.points[t.ids[0]], &b = mesh.points[t.ids[1]], &c = mesh.points[t.ids[2]];
  const Vec3 centre = (a + b + c) / 3, normal = (b - a).cross(c - a).normalized();
  if (candidates.size() == 0) {
    const double reach = Fitting::target_reach * cell;
    // Faces across a closed gap belong to the patch that the gap divides, not to its sides.
    if (!t.other && surface.is_given_up(centre, *sheet))
      if (const auto place = surface.nearest(centre, *sheet, reach, &normal, Fitting::alike))
        return place->patch;
    const auto place = surface.nearest(centre, *sheet, reach, t.other ? nullptr : &normal);
    return place ? place->patch : surface.no_patch();
  }
  FeatureSurface::Patch best = *candidates.begin();
  double best_fit = -std::numeric_limits<double>::infinity();
  for (const FeatureSurface::Patch patch : candidates) {
    const auto place = surface.nearest_of_patch(centre, patch, Fitting::target_reach * cell);
    if (!place) continue;
    const double alike = normal.dot(place->normal) - (place->point - centre).norm() / cell;
    if (alike > best_fit) {
      best_fit = alike;
      best = patch;
    }
  }
  return best;
}

}  // namespace

void fit_creases(TetMesh& mesh, const FeatureSurface& surface, const MaterialField& field, double cell) {
  const CreaseLabels labels(mesh, surface, cell);
  const std::vector<Vec3> before = mesh.points;
  Fitter(mesh, surface, labels, field, cell).run();
  std::vector<std::uint8_t> boundary(mesh.points.size(), 0);
  for (const Index p : labels.points()) boundary[p] = 1;
  std::vector<InterfaceTriangle> inner;
  std::copy_if(mesh.interfaces.begin(), mesh.interfaces.end(), std::back_inserter(inner),
               [](const InterfaceTriangle& t) { return t.other == t.material; });
  mesh.interfaces = find_interfaces(mesh, &boundary);
  const auto first_inner = static_cast<std::ptrdiff_t>(mesh.interfaces.size());
  mesh.interfaces.insert(mesh.interfaces.end(), inner.begin(), inner.end());
  std::vector<Triangle> faces;
  faces.reserve(mesh.interfaces.size());
  for (const InterfaceTriangle& t : mesh.interfaces) faces.push_back(t.ids);
  undo_intersections(mesh.points, mesh.tets, faces, before);
  parallel_for(0, mesh.interfaces.size(), CutGrains::searches, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      mesh.interfaces[i].patch = patch_of(mesh, mesh.interfaces[i], labels, surface, cell);
  });
  if (surface.gives_up_creases()) join_specks(mesh, surface, cell);
  // Beyond the borders of sheets there is nothing.
  mesh.interfaces.erase(std::remove_if(mesh.interfaces.begin() + first_inner, mesh.interfaces.end(),
                                       [&](const InterfaceTriangle& t) {
                                         return t.patch == surface.no_patch() ||
                                                surface.is_continued(t.patch);
                                       }),
                        mesh.interfaces.end());
}

}  // namespace tetwright
