// SPDX-License-Identifier: Apache-2.0
#include "mesher/features/patch_specks.h"

#include <map>
#include <utility>
#include <vector>

#include "common/features/edge_uses.h"
#include "common/mesh/disjoint_sets.h"
#include "common/parallel/parallel_sort.h"
#include "mesher/tuning/cell_tuning.h"
#include "mesher/tuning/cut_tuning.h"

namespace tetwright {

namespace {

/// Two faces that share an edge on one sheet.
struct Adjacent {
  Index first, second;
  double length;
};

/// The pairs of adjacent faces of which one is flagged.
std::vector<Adjacent> adjacent_faces(const TetMesh& mesh, const FeatureSurface& surface,
                                     const std::vector<std::uint8_t>& flags) {
  std::vector<Triangle> triangles;
  triangles.reserve(mesh.interfaces.size());
  for (const InterfaceTriangle& t : mesh.interfaces) triangles.push_back(t.ids);
  const std::vector<EdgeUse> uses = edge_uses(triangles, {});
  std::vector<Adjacent> pairs;
  for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
    while (j < uses.size() && uses[j].key == uses[i].key) ++j;
    if (j - i != 2 || !(flags[uses[i].triangle] || flags[uses[i + 1].triangle])) continue;
    const auto [a, b] = ends_of(uses[i].key);
    const InterfaceTriangle &f = mesh.interfaces[uses[i].triangle],
                            &g = mesh.interfaces[uses[i + 1].triangle];
    if (f.pair() == g.pair() && surface.sheet_of(f) == surface.sheet_of(g))
      pairs.push_back({uses[i].triangle, uses[i + 1].triangle, (mesh.points[b] - mesh.points[a]).norm()});
  }
  return pairs;
}

/// Joins each speck with the neighbour with which it shares most of its border. False if there is none.
bool join_once(TetMesh& mesh, const std::vector<Adjacent>& pairs, const std::vector<std::uint8_t>& flags,
               double max_area) {
  DisjointSets sets(mesh.interfaces.size());
  const auto patch = [&](Index face) { return mesh.interfaces[face].patch; };
  for (const Adjacent& a : pairs)
    if (patch(a.first) == patch(a.second)) sets.unite(a.first, a.second);
  std::map<Index, double> areas;
  for (Index f = 0; f < flags.size(); ++f) {
    if (!flags[f]) continue;
    const auto& [a, b, c] = mesh.interfaces[f].ids;
    const Vec3& apex = mesh.points[a];
    areas[sets.root(f)] += (mesh.points[b] - apex).cross(mesh.points[c] - apex).norm() / 2;
  }
  const auto is_speck = [&](Index root) {
    const auto area = areas.find(root);
    return area != areas.end() && area->second < max_area;
  };
  // Groups that reach beyond the flagged faces are no specks.
  for (const Adjacent& a : pairs)
    for (const Index f : {a.first, a.second})
      if (!flags[f]) areas.erase(sets.root(f));
  // The smaller one of two specks joins the larger one.
  const auto order = [&](Index root) { return std::pair(is_speck(root) ? areas.at(root) : max_area, root); };
  std::map<Index, std::map<std::uint16_t, double>> borders;
  for (const Adjacent& a : pairs) {
    const Index first = sets.root(a.first), second = sets.root(a.second);
    if (first == second) continue;
    for (const auto& [own, other] : {std::pair(first, second), std::pair(second, first)})
      if (is_speck(own) && order(own) < order(other)) borders[own][patch(other)] += a.length;
  }
  if (borders.empty()) return false;
  std::map<Index, std::uint16_t> joins;
  for (const auto& [root, lengths] : borders) {
    auto longest = lengths.begin();
    for (auto l = lengths.begin(); l != lengths.end(); ++l)
      if (l->second > longest->second) longest = l;
    joins[root] = longest->first;
  }
  for (Index f = 0; f < flags.size(); ++f)
    if (flags[f])
      if (const auto to = joins.find(sets.root(f)); to != joins.end()) mesh.interfaces[f].patch = to->second;
  return true;
}

}  // namespace

void join_specks(TetMesh& mesh, const FeatureSurface& surface, double cell) {
  std::vector<std::uint8_t> flags(mesh.interfaces.size(), 0);
  parallel_for(0, flags.size(), CutGrains::searches, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const InterfaceTriangle& t = mesh.interfaces[i];
      if (t.other == t.material) continue;
      const auto sheet = surface.sheet_of(t);
      const Vec3 centre = (mesh.points[t.ids[0]] + mesh.points[t.ids[1]] + mesh.points[t.ids[2]]) / 3;
      flags[i] = sheet && surface.is_given_up(centre, *sheet);
    }
  });
  const std::vector<Adjacent> pairs = adjacent_faces(mesh, surface, flags);
  const double max_area = CellTuning::Patches::min_area * cell * cell;
  // Each round joins at least half of the specks that touch others.
  while (join_once(mesh, pairs, flags, max_area)) {
  }
}

}  // namespace tetwright
