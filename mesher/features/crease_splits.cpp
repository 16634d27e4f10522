// SPDX-License-Identifier: Apache-2.0
// Edges that are split so that creases and junctions can follow edges of the mesh.
#include <algorithm>

#include "common/parallel/parallel_sort.h"
#include "mesher/features/crease_labels.h"
#include "mesher/tuning/cut_tuning.h"
#include "tetwright/resources.h"

namespace tetwright {

using Labelling = CutTuning::Labelling;

/// The edges between two points of one junction that do not follow it, with the sheet that they lie in, or
/// no_sheet for those inside a region. Where the junction is straight such an edge would pass through the
/// junction's points between its ends.
std::vector<CreaseLabels::SheetEdge> CreaseLabels::find_chords() const {
  std::vector<SheetEdge> chords;
  if (!surface_.has_junctions()) return chords;
  const auto is_on_junction = [&](Index p) {
    return number_[p] != no_index && labels_[number_[p]].kind != Kind::none &&
           sheets_at(number_[p]).size() > 1;
  };
  std::vector<std::uint8_t> on_junction(mesh_.points.size(), 0);
  for (const Index p : points_) on_junction[p] = is_on_junction(p) ? 1 : 0;
  const auto is_candidate = [&](Index u, Index v) {
    return on_junction[u] && on_junction[v] &&
           labels_[number_[u]].patches.common(labels_[number_[v]].patches).size() > 1;
  };
  std::vector<SheetEdge> in_sheets;
  for (const InterfaceTriangle& t : mesh_.interfaces)
    for (int k = 0; k < 3; ++k) {
      const Index u = t.ids[k], v = t.ids[(k + 1) % 3];
      if (!is_candidate(u, v)) continue;
      if (const auto sheet = sheet_of(t)) in_sheets.push_back({std::min(u, v), std::max(u, v), *sheet});
    }
  std::sort(in_sheets.begin(), in_sheets.end());
  in_sheets.erase(std::unique(in_sheets.begin(), in_sheets.end()), in_sheets.end());
  for (auto first = in_sheets.begin(); first != in_sheets.end();) {
    const auto end =
        std::find_if_not(first, in_sheets.end(), [&](const SheetEdge& e) { return e.same_ends(*first); });
    if (end - first == 1) chords.push_back(*first);
    first = end;
  }
  std::vector<SheetEdge> inner;
  for (const Tet& t : mesh_.tets) {
    if (std::count_if(t.begin(), t.end(), [&](Index p) { return on_junction[p] != 0; }) < 2) continue;
    for (const auto& [i, j] : tet_edges) {
      const SheetEdge e{std::min(t[i], t[j]), std::max(t[i], t[j]), no_sheet};
      if (!is_candidate(e.u, e.v)) continue;
      const auto known = std::lower_bound(in_sheets.begin(), in_sheets.end(), SheetEdge{e.u, e.v, 0});
      if (known == in_sheets.end() || !known->same_ends(e)) inner.push_back(e);
    }
  }
  std::sort(inner.begin(), inner.end());
  inner.erase(std::unique(inner.begin(), inner.end()), inner.end());
  chords.insert(chords.end(), inner.begin(), inner.end());
  return chords;
}

/// The edges of the later body's surface between two points on the rim of a closed gap that are no edges of
/// the rim. They would come to lie on the earlier body's surface with their ends.
std::vector<CreaseLabels::SheetEdge> CreaseLabels::find_chords_over_gaps() const {
  std::vector<SheetEdge> chords;
  if (!surface_.has_junctions()) return chords;
  const std::vector<std::uint8_t> at_gap = points_at_gaps();
  std::vector<SheetEdge> edges;
  for (const InterfaceTriangle& t : mesh_.interfaces)
    if (const auto sheet = sheet_of(t))
      for (std::size_t k = 0; k < 3; ++k) {
        const Index u = t.ids[k], v = t.ids[(k + 1) % 3];
        if (at_gap[u] && at_gap[v]) edges.push_back({std::min(u, v), std::max(u, v), *sheet});
      }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  for (auto first = edges.begin(); first != edges.end();) {
    const auto end =
        std::find_if_not(first, edges.end(), [&](const SheetEdge& e) { return e.same_ends(*first); });
    const auto is_elsewhere = [&](Index p) {
      return of(p).patches.size() > 0 && on_sheet(number_[p], first->sheet).size() == 0;
    };
    if (end - first == 1 && is_elsewhere(first->u) && is_elsewhere(first->v))
      chords.push_back({first->u, first->v, no_sheet});
    first = end;
  }
  return chords;
}

/// Splits these edges, so that the junction's points between their ends can move onto it.
void CreaseLabels::split_chords(const std::vector<SheetEdge>& chords) {
  for (const auto& [u, v, sheet] : chords) {
    const Vec3 middle = (mesh_.points[u] + mesh_.points[v]) / 2;
    split(u, v, 0.5, sheet == no_sheet ? FeatureLabel{} : patch_label(middle, sheet, nullptr));
  }
}

/// Splits the edges inside a patch between points on its creases that two patches have in common, if they cut
/// off a point of the patch all of whose other neighbours are on creases, too, from another one. Where the
/// crease is straight such a point could not leave it, and would hold back those around it.
void CreaseLabels::split_chords_of_creases() {
  if (!surface_.has_junctions() && !surface_.is_surrounded()) return;
  struct Side {
    SheetEdge edge;
    Index opposite;
    auto operator<=>(const Side&) const = default;
  };
  const auto is_on_crease = [&](Index p) { return of(p).kind == Kind::crease || of(p).kind == Kind::corner; };
  const auto is_enclosed = [&](Index p) {
    bool is = true;
    for_neighbours(number_[p], [&](Index q) { is &= is_on_crease(q) && of(q).patches.meets(of(p).patches); });
    return is;
  };
  std::vector<Side> sides;
  for (const InterfaceTriangle& t : mesh_.interfaces)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index u = t.ids[k], v = t.ids[(k + 1) % 3], opposite = t.ids[(k + 2) % 3];
      if (!is_on_crease(u) || !is_on_crease(v) || of(opposite).kind != Kind::patch) continue;
      const auto sheet = sheet_of(t);
      // Borders of inner sheets are creases of their continuation.
      if (!sheet || surface_.is_inner(*sheet)) continue;
      if (on_sheet(number_[u], *sheet).common(on_sheet(number_[v], *sheet)).size() > 1)
        sides.push_back({{std::min(u, v), std::max(u, v), *sheet}, opposite});
    }
  std::sort(sides.begin(), sides.end());
  for (std::size_t i = 1; i < sides.size(); ++i) {
    const auto& [u, v, sheet] = sides[i].edge;
    const Index a = sides[i - 1].opposite, b = sides[i].opposite;
    if (sides[i - 1].edge != sides[i].edge || !of(a).patches.meets(of(b).patches)) continue;
    if (is_enclosed(a) || is_enclosed(b)) split(u, v, 0.5, {Kind::patch, of(a).patches, no_index, {}});
  }
}

void CreaseLabels::track(const std::vector<SheetEdge>& edges) {
  // Include the neighbours of crossing edges: after a vertex has moved onto a crease, its other edges may
  // cross one.
  std::vector<std::uint8_t> tracked(points_.size(), 0);
  for (const SheetEdge& edge : edges)
    for (const Index p : {edge.u, edge.v}) {
      tracked[number_[p]] = 1;
      for_neighbours(number_[p], [&](Index q) { tracked[number_[q]] = 1; });
    }
  const std::vector<Index> tets = parallel_collect<Index>(
      0, mesh_.tets.size(), CutGrains::tets,
      [&](std::size_t begin, std::size_t end, std::vector<Index>& out) {
        for (std::size_t t = begin; t < end; ++t)
          if (std::any_of(mesh_.tets[t].begin(), mesh_.tets[t].end(),
                          [&](Index p) { return number_[p] != no_index && tracked[number_[p]]; }))
            out.push_back(static_cast<Index>(t));
      });
  for (const Index t : tets)
    for (const Index p : mesh_.tets[t])
      if (number_[p] != no_index && tracked[number_[p]]) tets_at_[number_[p]].push_back(t);
}

/// Splits an edge; the new point has the label unless it is on a junction.
void CreaseLabels::split(Index u, Index v, double share, const FeatureLabel& given) {
  // All points near creases are tracked, so at least one end is.
  const Index known = tets_at_[number_[u]].empty() ? v : u;
  std::vector<Index> tets, triangles;
  for (const Index t : tets_at_[number_[known]])
    if (const Tet& c = mesh_.tets[t];
        std::find(c.begin(), c.end(), u) != c.end() && std::find(c.begin(), c.end(), v) != c.end())
      tets.push_back(t);
  if (tets.empty()) return;
  for (const Index t : triangles_at_[number_[u]])
    if (const Triangle& c = mesh_.interfaces[t].ids; std::find(c.begin(), c.end(), v) != c.end())
      triangles.push_back(t);
  const auto middle = static_cast<Index>(mesh_.points.size());
  const double s = std::clamp(share, Labelling::min_split, 1 - Labelling::min_split);
  mesh_.points.push_back(mesh_.points[u] + s * (mesh_.points[v] - mesh_.points[u]));
  const auto number = static_cast<Index>(points_.size());
  number_.push_back(triangles.empty() ? no_index : number);
  if (!triangles.empty()) {
    points_.push_back(middle);
    std::set<std::size_t> sheets = sheets_of(triangles, false);
    continued_.push_back(leave_out_continuations(mesh_.points[middle], sheets));
    labels_.push_back(sheets.size() > 1 ? junction_label(mesh_.points[middle], sheets) : given);
    triangles_at_.emplace_back();
    tets_at_.emplace_back();
  }
  // Each tet keeps u; a new tet takes v.
  for (const Index t : tets) {
    const auto added = static_cast<Index>(mesh_.tets.size());
    Tet second = mesh_.tets[t];
    std::replace(second.begin(), second.end(), u, middle);
    std::replace(mesh_.tets[t].begin(), mesh_.tets[t].end(), v, middle);
    mesh_.tets.push_back(second);
    mesh_.materials.push_back(mesh_.materials[t]);
    for (const Index p : second) {
      if (number_[p] == no_index) continue;
      std::vector<Index>& at = tets_at_[number_[p]];
      if (p == v) {
        if (!at.empty()) std::replace(at.begin(), at.end(), t, added);
      } else if (p == middle) {
        at.push_back(t);
        at.push_back(added);
      } else if (!at.empty()) {
        at.push_back(added);
      }
    }
  }
  for (const Index t : triangles) {
    const auto added = static_cast<Index>(mesh_.interfaces.size());
    InterfaceTriangle second = mesh_.interfaces[t];
    std::replace(second.ids.begin(), second.ids.end(), u, middle);
    Triangle& first = mesh_.interfaces[t].ids;
    std::replace(first.begin(), first.end(), v, middle);
    mesh_.interfaces.push_back(second);
    std::replace(triangles_at_[number_[v]].begin(), triangles_at_[number_[v]].end(), t, added);
    triangles_at_[number].push_back(t);
    triangles_at_[number].push_back(added);
    for (const Index p : second.ids)
      if (p != v && p != middle) triangles_at_[number_[p]].push_back(added);
  }
}

}  // namespace tetwright
