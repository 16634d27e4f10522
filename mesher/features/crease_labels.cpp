// SPDX-License-Identifier: Apache-2.0
#include "mesher/features/crease_labels.h"

#include <cmath>

#include "common/parallel/parallel_sort.h"
#include "mesher/tuning/cut_tuning.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

using Labelling = CutTuning::Labelling;

}  // namespace

/// The crossing of an edge and a crease.
struct CreaseLabels::Crossing {
  Index u, v;
  double share;  ///< fraction of the way from u to v
  FeatureSurface::PatchPair crease;
  PatchSet patches;  ///< patches that meet there
  FeatureLabel label() const { return {Kind::crease, patches, no_index, crease}; }
};

CreaseLabels::CreaseLabels(TetMesh& mesh, const FeatureSurface& surface, double cell)
    : mesh_(mesh), surface_(surface), cell_(cell) {
  number_boundary();
  label_points();
  if (surface_.has_junctions()) free_rims_of_gaps();
  smooth_labels();
  take_corners();
  order_corners();
  std::vector<SheetEdge> chords = find_chords();
  const std::vector<SheetEdge> over_gaps = find_chords_over_gaps();
  chords.insert(chords.end(), over_gaps.begin(), over_gaps.end());
  std::vector<SheetEdge> edges = crossing_edges();
  edges.insert(edges.end(), chords.begin(), chords.end());
  track(edges);
  split_chords(chords);
  snap_points();
  resolve_rest();
  split_chords_of_creases();  // before islands dissolve, since it leaves points in their patches
  take_kinks();
  dissolve_islands();
  if (surface_.is_surrounded()) find_loose_points();
}

void CreaseLabels::number_boundary() {
  number_.assign(mesh_.points.size(), no_index);
  for (const InterfaceTriangle& t : mesh_.interfaces)
    for (const Index p : t.ids)
      if (number_[p] == no_index) {
        number_[p] = static_cast<Index>(points_.size());
        points_.push_back(p);
      }
  labels_.resize(points_.size());
  continued_.resize(points_.size());
  triangles_at_.resize(points_.size());
  tets_at_.resize(points_.size());
  for (std::size_t t = 0; t < mesh_.interfaces.size(); ++t)
    for (const Index p : mesh_.interfaces[t].ids) triangles_at_[number_[p]].push_back(static_cast<Index>(t));
}

void CreaseLabels::label_points() {
  parallel_for(0, points_.size(), CutGrains::searches, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (surface_.has_inner_sheets()) {
        labels_[i] = label_at(static_cast<Index>(i));
        continue;
      }
      const std::vector<Index>& around = triangles_at_[i];
      // Interfaces of labels end at a body, and leave it free.
      const auto of_body = std::find_if(around.begin(), around.end(), [&](Index t) {
        return !surface_.is_beside_bodies(mesh_.interfaces[t]);
      });
      if (of_body == around.end()) continue;
      const InterfaceTriangle& first = mesh_.interfaces[*of_body];
      Vec3 normal = Vec3::Zero();
      bool one_pair = true;
      for (const Index t : around) {
        const InterfaceTriangle& face = mesh_.interfaces[t];
        if (surface_.is_beside_bodies(face)) continue;
        one_pair &= surface_.are_alike(face, first);
        const Vec3& a = mesh_.points[face.ids[0]];
        normal += (mesh_.points[face.ids[1]] - a).cross(mesh_.points[face.ids[2]] - a);
      }
      const std::optional<std::size_t> sheet = surface_.sheet_of(first);
      if (surface_.has_junctions() && (!one_pair || !sheet)) {
        const std::set<std::size_t> sheets = sheets_at(static_cast<Index>(i));
        const Vec3& p = mesh_.points[points_[i]];
        labels_[i] =
            sheets.size() == 1 ? patch_label(p, *sheets.begin(), nullptr) : junction_label(p, sheets);
      }
      if (!one_pair || !sheet) continue;
      normal.normalize();
      // Between two materials either may be the body.
      labels_[i] = patch_label(mesh_.points[points_[i]], *sheet, first.other ? nullptr : &normal);
    }
  });
}

double CreaseLabels::cell_of(const PatchSet& patches) const {
  double smallest = cell_;
  for (const FeatureSurface::Patch p : patches) smallest = std::min(smallest, cell_of(surface_.sheet_of(p)));
  return smallest;
}

/// Erases inner sheets that only their continuations bring to a point with other sheets.
/// \return the patches of these
PatchSet CreaseLabels::leave_out_continuations(const Vec3& p, std::set<std::size_t>& sheets) const {
  PatchSet continued;
  if (sheets.size() < 2 || !surface_.has_inner_sheets()) return continued;
  const auto is_on_border = [&](std::size_t sheet) {
    return surface_.nearest_crease(p, Labelling::border_reach * cell_, [&](const auto& pair) {
      return surface_.sheet_of(pair[0]) == sheet && surface_.sheet_of(pair[1]) == sheet;
    });
  };
  std::erase_if(sheets, [&](std::size_t sheet) {
    if (!surface_.is_inner(sheet)) return false;
    const auto place = surface_.nearest(p, sheet, Labelling::surface_reach * cell_of(sheet));
    if (place && (!surface_.is_continued(place->patch) || is_on_border(sheet))) return false;
    if (place) continued.insert(place->patch);
    return true;
  });
  return continued;
}

/// The label of a point of a mesh with inner sheets.
FeatureLabel CreaseLabels::label_at(Index number) {
  const Vec3& p = mesh_.points[points_[number]];
  std::set<std::size_t> sheets = sheets_at(number);
  if (sheets.empty()) return {};
  continued_[number] = leave_out_continuations(p, sheets);
  if (sheets.size() != 1) return junction_label(p, sheets);
  Vec3 normal = Vec3::Zero();
  bool is_outer = false;
  for (const Index t : triangles_at_[number]) {
    const InterfaceTriangle& face = mesh_.interfaces[t];
    if (sheet_of(face) != *sheets.begin()) continue;
    const Vec3& a = mesh_.points[face.ids[0]];
    normal += (mesh_.points[face.ids[1]] - a).cross(mesh_.points[face.ids[2]] - a);
    is_outer = !face.other;
  }
  normal.normalize();
  return patch_label(p, *sheets.begin(), is_outer ? &normal : nullptr);
}

/// The label of a point on one sheet; Kind::none if it is far from it or creases are given up there.
/// \param normal of the point's faces; null: either direction
FeatureLabel CreaseLabels::patch_label(const Vec3& p, std::size_t sheet, const Vec3* normal) const {
  if (surface_.is_given_up(p, sheet)) return {};
  const auto place = surface_.nearest(p, sheet, Labelling::surface_reach * cell_of(sheet), normal);
  if (!place) return {};
  return {Kind::patch, {place->patch}, no_index, {}};
}

std::vector<std::uint8_t> CreaseLabels::points_at_gaps() const {
  std::vector<std::uint8_t> at_gap(mesh_.points.size(), 0);
  for (const InterfaceTriangle& t : mesh_.interfaces)
    if (!surface_.sheet_of(t) && sheet_across_gap(t))
      for (const Index p : t.ids) at_gap[p] = 1;
  return at_gap;
}

/// Takes the labels from points beside a closed gap that are not on a surface: the later body fills the gap
/// up to a rim, which is on neither side of it.
void CreaseLabels::free_rims_of_gaps() {
  const std::vector<std::uint8_t> at_gap = points_at_gaps();
  for (Index i = 0; i < points_.size(); ++i) {
    if (labels_[i].kind != Kind::patch || at_gap[points_[i]]) continue;
    const std::size_t sheet = surface_.sheet_of(*labels_[i].patches.begin());
    bool is_opposite = false;
    for_neighbours(i, [&](Index p) { is_opposite |= at_gap[p] && !sheets_at(number_[p]).contains(sheet); });
    if (is_opposite) labels_[i] = {};
  }
}

void CreaseLabels::smooth_labels() {
  // A point whose neighbours all belong to other patches would be a patch of its own.
  std::vector<FeatureLabel> smoothed = labels_;
  for (Index i = 0; i < points_.size(); ++i) {
    if (labels_[i].kind != Kind::patch) continue;
    std::map<FeatureSurface::Patch, std::size_t> counts;
    bool alone = true;
    for_neighbours(i, [&](Index p) {
      const FeatureLabel& other = labels_[number_[p]];
      if (other.kind != Kind::patch) return;
      // Beside a closed gap are points of other sheets.
      if (surface_.sheet_of(*other.patches.begin()) != surface_.sheet_of(*labels_[i].patches.begin())) return;
      ++counts[*other.patches.begin()];
      alone &= !other.patches.meets(labels_[i].patches);
    });
    if (!alone || counts.empty()) continue;
    const auto commonest = std::max_element(counts.begin(), counts.end(),
                                            [](const auto& x, const auto& y) { return x.second < y.second; });
    if (surface_.nearest_of_patch(mesh_.points[points_[i]], commonest->first,
                                  cell_of(surface_.sheet_of(commonest->first))))
      smoothed[i].patches = {commonest->first};
  }
  labels_ = std::move(smoothed);
}

PatchSet CreaseLabels::on_sheet(Index number, std::size_t sheet) const {
  PatchSet own;
  for (const PatchSet* patches : {&labels_[number].patches, &continued_[number]})
    for (const FeatureSurface::Patch p : *patches)
      if (surface_.sheet_of(p) == sheet) own.insert(p);
  return own;
}

std::optional<std::size_t> CreaseLabels::sheet_across_gap(const InterfaceTriangle& face) const {
  const auto& [a, b, c] = face.ids;
  return surface_.sheet_across_gap(face, (mesh_.points[a] + mesh_.points[b] + mesh_.points[c]) / 3,
                                   Labelling::surface_reach * cell_);
}

/// The sheets of faces of the mesh around a point or an edge. At a closed gap only that of the faces across
/// it: its rim is free to move on the earlier body's surface.
/// \param or_none empty if a face lies on no sheet
std::set<std::size_t> CreaseLabels::sheets_of(const std::vector<Index>& faces, bool or_none) const {
  std::set<std::size_t> sheets, across_gaps;
  for (const Index t : faces) {
    const InterfaceTriangle& face = mesh_.interfaces[t];
    if (surface_.is_beside_bodies(face)) continue;
    if (const auto sheet = surface_.sheet_of(face))
      sheets.insert(*sheet);
    else if (const auto across = sheet_across_gap(face))
      across_gaps.insert(*across);
    else if (or_none)
      return {};
  }
  return across_gaps.empty() ? sheets : across_gaps;
}

/// The label of a point where several sheets meet: the nearest curve of theirs, with a patch of each sheet.
FeatureLabel CreaseLabels::junction_label(const Vec3& p, const std::set<std::size_t>& sheets) const {
  if (sheets.size() < 2) return {};
  const auto place = surface_.nearest_crease(
      p, Labelling::surface_reach * cell_, [&](const FeatureSurface::PatchPair& pair) {
        const std::size_t a = surface_.sheet_of(pair[0]), b = surface_.sheet_of(pair[1]);
        return a != b && sheets.contains(a) && sheets.contains(b);
      });
  if (!place) return {};
  FeatureLabel label{Kind::crease, {place->patches[0], place->patches[1]}, no_index, place->patches};
  // Add the other patches that this curve separates.
  for (std::size_t known = 0; known != label.patches.size();) {
    known = label.patches.size();
    const auto next = surface_.nearest_crease(
        place->point, Labelling::same_curve * cell_, [&](const FeatureSurface::PatchPair& pair) {
          return label.patches.contains(pair[0]) != label.patches.contains(pair[1]) &&
                 sheets.contains(surface_.sheet_of(pair[0])) && sheets.contains(surface_.sheet_of(pair[1]));
        });
    if (!next) break;
    for (const FeatureSurface::Patch patch : next->patches) label.patches.insert(patch);
  }
  return label;
}

bool CreaseLabels::crosses(const SheetEdge& edge) const {
  const PatchSet own = on_sheet(number_[edge.u], edge.sheet), other = on_sheet(number_[edge.v], edge.sheet);
  return own.size() > 0 && other.size() > 0 && !own.meets(other);
}

std::vector<CreaseLabels::SheetEdge> CreaseLabels::crossing_edges() const {
  std::vector<SheetEdge> edges;
  for (const InterfaceTriangle& t : mesh_.interfaces) {
    const auto sheet = sheet_of(t);
    if (!sheet) continue;
    for (int k = 0; k < 3; ++k) {
      const Index u = t.ids[k], v = t.ids[(k + 1) % 3];
      if (const SheetEdge e{std::min(u, v), std::max(u, v), *sheet}; crosses(e)) edges.push_back(e);
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

void CreaseLabels::take_corners() {
  if (surface_.corners().empty()) return;
  // Prefer a vertex of a triangle whose vertices belong to three patches of the corner, then one of a
  // triangle that a crease crosses, then the closest vertex of one of these patches.
  std::vector<Vec3> positions;
  std::vector<ProjectionTree::Item> items;
  for (Index i = 0; i < points_.size(); ++i) {
    positions.push_back(mesh_.points[points_[i]]);
    if (labels_[i].kind == Kind::patch || labels_[i].kind == Kind::crease)
      items.push_back({{i, i, i}, {i, 0, 0}});
  }
  const ProjectionTree tree(std::move(positions), std::move(items));
  struct Taken {
    Index corner, number;
  };
  std::vector<Taken> taken;
  for (Index c = 0; c < surface_.corners().size(); ++c) {
    const FeatureSurface::Corner& corner = surface_.corners()[c];
    PatchSet meeting;
    for (const FeatureSurface::Patch p : corner.patches) meeting.insert(p);
    if (meeting.size() < 3) continue;  // see take_kinks()
    const double cell = cell_of(meeting);
    // Two vertices would not fit next to each other.
    const auto beside = std::find_if(taken.begin(), taken.end(), [&](const Taken& t) {
      return (surface_.corners()[t.corner].point - corner.point).norm() < Labelling::narrow_reach * cell;
    });
    if (beside != taken.end()) {
      for (const FeatureSurface::Patch p : corner.patches) labels_[beside->number].patches.insert(p);
      continue;
    }
    // Points in the border of a volume stay there.
    const unsigned in_border = surface_.border_planes(corner.point, CutTuning::Fitting::border_slack);
    const auto may_leave = [&](const ProjectionTree::Item& item) {
      return (surface_.border_planes(mesh_.points[points_[item.kind[0]]]) & ~in_border) == 0;
    };
    std::set<std::size_t> sheets;
    for (const FeatureSurface::Patch p : corner.patches) sheets.insert(surface_.sheet_of(p));
    if (sheets.size() > 1) {
      // A vertex where the same sheets meet.
      const auto hit = tree.nearest_of(corner.point, Labelling::junction_reach * cell,
                                       [&](const ProjectionTree::Item& item) {
                                         return labels_[item.kind[0]].kind == Kind::crease &&
                                                may_leave(item) && sheets_at(item.kind[0]) == sheets;
                                       });
      if (hit) {
        const Index number = tree.items()[hit->item].kind[0];
        labels_[number] = {Kind::corner, meeting, c, {}};
        taken.push_back({c, number});
      }
      continue;
    }
    const auto fits = [&](const ProjectionTree::Item& item, std::size_t min_patches) {
      const FeatureLabel& own = labels_[item.kind[0]];
      if (own.kind != Kind::patch || !own.patches.meets(meeting) || !may_leave(item)) return false;
      if (min_patches == 1) return true;
      const auto& around = triangles_at_[item.kind[0]];
      return std::any_of(around.begin(), around.end(), [&](Index t) {
        PatchSet of_triangle;
        for (const Index p : mesh_.interfaces[t].ids)
          if (labels_[number_[p]].kind == Kind::patch)
            of_triangle.insert(*labels_[number_[p]].patches.begin());
        return of_triangle.common(meeting).size() >= min_patches;
      });
    };
    for (std::size_t min_patches : {std::size_t{3}, std::size_t{2}, std::size_t{1}}) {
      const auto hit =
          tree.nearest_of(corner.point, Labelling::corner_reach * cell,
                          [&](const ProjectionTree::Item& item) { return fits(item, min_patches); });
      if (!hit) continue;
      const Index number = tree.items()[hit->item].kind[0];
      labels_[number] = {Kind::corner, meeting, c, {}};
      taken.push_back({c, number});
      break;
    }
  }
}

std::optional<CreaseLabels::Crossing> CreaseLabels::find_crossing(const SheetEdge& edge) const {
  const Index u = edge.u, v = edge.v;
  const std::size_t sheet = edge.sheet;
  const PatchSet a = on_sheet(number_[u], sheet), b = on_sheet(number_[v], sheet);
  const Vec3 &p = mesh_.points[u], &q = mesh_.points[v];
  const Vec3 along = q - p;
  Crossing crossing{u, v, 0.5, {}, {}};
  using Pair = FeatureSurface::PatchPair;
  const auto find = [&](const auto& accepts) {
    for (int i = 0; i < Labelling::crossing_steps; ++i) {
      const auto place = surface_.nearest_crease(p + crossing.share * along,
                                                 Labelling::crease_reach * along.norm(), accepts);
      if (!place) return false;
      crossing.share = std::clamp((place->point - p).dot(along) / along.squaredNorm(), 0.0, 1.0);
      crossing.crease = place->patches;
      crossing.patches = {place->patches[0], place->patches[1]};
    }
    return true;
  };
  if (find([&](const Pair& pair) {
        return (a.contains(pair[0]) && b.contains(pair[1])) || (a.contains(pair[1]) && b.contains(pair[0]));
      }))
    return crossing;
  // If the patches between the two are too narrow for the cells, their creases are merged.
  if (!find([&](const Pair& pair) {
        return surface_.sheet_of(pair[0]) == sheet && surface_.sheet_of(pair[1]) == sheet &&
               (a.contains(pair[0]) || a.contains(pair[1]) || b.contains(pair[0]) || b.contains(pair[1]));
      }))
    return {};
  const auto at = surface_.onto_crease_between(p + crossing.share * along, crossing.crease,
                                               Labelling::surface_reach * cell_of(sheet));
  if (!at) return {};
  while (!(crossing.patches.meets(a) && crossing.patches.meets(b))) {
    const std::size_t known = crossing.patches.size();
    const double reach = Labelling::narrow_reach * cell_of(sheet);
    const auto next = surface_.nearest_crease(*at, reach, [&](const Pair& pair) {
      return surface_.sheet_of(pair[0]) == sheet && surface_.sheet_of(pair[1]) == sheet &&
             crossing.patches.contains(pair[0]) != crossing.patches.contains(pair[1]);
    });
    if (!next) return {};
    for (const FeatureSurface::Patch patch : next->patches) crossing.patches.insert(patch);
    if (crossing.patches.size() == known) return {};
  }
  return crossing;
}

bool CreaseLabels::may_snap(Index point, const PatchSet& patches) const {
  // Another sheet passes there.
  if (continued_[number_[point]].size() > 0) return false;
  const auto& around = triangles_at_[number_[point]];
  return std::none_of(around.begin(), around.end(), [&](Index t) {
    // A triangle with all three vertices on one crease would become flat.
    PatchSet shared = patches;
    for (const Index p : mesh_.interfaces[t].ids)
      if (p != point) shared = shared.common(labels_[number_[p]].patches);
    return shared.size() > 1;
  });
}

void CreaseLabels::snap_points() {
  struct Snap {
    double share;
    Index point, other;
    FeatureLabel label;
    std::size_t sheet;
  };
  const std::vector<SheetEdge> edges = crossing_edges();
  std::vector<Snap> snaps = parallel_collect<Snap>(
      0, edges.size(), CutGrains::searches, [&](std::size_t begin, std::size_t end, std::vector<Snap>& out) {
        for (std::size_t e = begin; e < end; ++e) {
          const auto [u, v, sheet] = edges[e];
          const std::optional<Crossing> c = find_crossing(edges[e]);
          if (!c) continue;
          if (labels_[number_[u]].kind == Kind::patch && c->share <= Labelling::max_snap)
            out.push_back({c->share, u, v, c->label(), sheet});
          if (labels_[number_[v]].kind == Kind::patch && 1 - c->share <= Labelling::max_snap)
            out.push_back({1 - c->share, v, u, c->label(), sheet});
        }
      });
  std::sort(snaps.begin(), snaps.end(), [](const Snap& x, const Snap& y) {
    if (x.share != y.share) return x.share < y.share;
    return x.point != y.point ? x.point < y.point : x.other < y.other;
  });
  for (const Snap& s : snaps) {
    if (label(s.point).kind != Kind::patch || !crosses({s.point, s.other, s.sheet}) ||
        !may_snap(s.point, s.label.patches))
      continue;
    label(s.point) = s.label;
  }
}

void CreaseLabels::resolve_rest() {
  for (int round = 0; round < Labelling::max_rounds; ++round) {
    const std::vector<SheetEdge> edges = crossing_edges();
    if (edges.empty()) return;
    for (const SheetEdge& e : edges) {
      const auto [u, v, sheet] = e;
      if (!crosses(e)) continue;
      const std::optional<Crossing> c = find_crossing(e);
      if (!c) continue;
      const bool u_is_nearer = c->share <= 0.5;
      const Index near = u_is_nearer ? u : v;
      if (label(near).kind == Kind::patch && label(near).patches.meets(c->patches) &&
          may_snap(near, c->patches))
        label(near) = c->label();
      else
        split(c->u, c->v, c->share, c->label());
    }
  }
}

}  // namespace tetwright
