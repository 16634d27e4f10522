// SPDX-License-Identifier: Apache-2.0
#include "tetwright/sheets.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "common/mesh/disjoint_sets.h"
#include "common/mesh/surface_chains.h"
#include "tetwright/mesh_quality.h"

namespace tetwright {

namespace {

Triangle sorted_ids(Triangle ids) {
  std::sort(ids.begin(), ids.end());
  return ids;
}

/// Use of an edge by a triangle of a patch.
struct EdgeOfPatch {
  InterfacePatch patch;
  std::array<Index, 2> ends;  ///< ascending
  Index triangle;
  bool ascending;  ///< the triangle traverses the edge from the smaller end to the larger

  bool same_edge(const EdgeOfPatch& o) const { return patch == o.patch && ends == o.ends; }
  bool operator<(const EdgeOfPatch& o) const {
    return std::tie(patch, ends, triangle) < std::tie(o.patch, o.ends, o.triangle);
  }
};

/// Turns triangles so that those of a patch at a common edge traverse it in opposite directions.
void orient(std::vector<InterfaceTriangle>& sheets) {
  std::vector<EdgeOfPatch> uses;
  for (Index t = 0; t < sheets.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index p = sheets[t].ids[k], q = sheets[t].ids[(k + 1) % 3];
      uses.push_back({{sheets[t].pair(), sheets[t].patch}, ascending_edge(p, q), t, p < q});
    }
  std::sort(uses.begin(), uses.end());
  struct Neighbour {
    Index triangle;
    bool turned;  ///< whether one of the two triangles must be turned
  };
  std::vector<std::vector<Neighbour>> neighbours(sheets.size());
  for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
    while (j < uses.size() && uses[j].same_edge(uses[i])) ++j;
    if (j - i != 2) continue;
    const bool turned = uses[i].ascending == uses[i + 1].ascending;
    neighbours[uses[i].triangle].push_back({uses[i + 1].triangle, turned});
    neighbours[uses[i + 1].triangle].push_back({uses[i].triangle, turned});
  }
  enum : std::uint8_t { unknown, as_is, turn };
  std::vector<std::uint8_t> state(sheets.size(), unknown);
  std::vector<Index> reached;
  for (Index first = 0; first < sheets.size(); ++first) {
    if (state[first] != unknown) continue;
    state[first] = as_is;
    reached.assign(1, first);
    for (std::size_t i = 0; i < reached.size(); ++i)
      for (const Neighbour& n : neighbours[reached[i]]) {
        if (state[n.triangle] != unknown) continue;
        state[n.triangle] = (state[reached[i]] == turn) != n.turned ? turn : as_is;
        reached.push_back(n.triangle);
      }
  }
  for (std::size_t t = 0; t < sheets.size(); ++t)
    if (state[t] == turn) std::swap(sheets[t].ids[1], sheets[t].ids[2]);
}

double triangle_area(const TetMesh& mesh, const Triangle& ids) {
  const Vec3& a = mesh.points[ids[0]];
  return (mesh.points[ids[1]] - a).cross(mesh.points[ids[2]] - a).norm() / 2;
}

SheetStatistics statistics_of(const TetMesh& mesh, const std::string& name,
                              const std::vector<Triangle>& triangles) {
  SheetStatistics sheet{.name = name, .triangles = triangles.size()};
  for (const Triangle& ids : triangles) sheet.area += triangle_area(mesh, ids);
  const SurfaceChains chains = surface_chains(triangles);
  sheet.pieces = chains.components;
  sheet.euler = chains.euler(triangles.size());
  std::map<Index, Index> numbers;
  const auto number = [&](Index p) {
    return numbers.try_emplace(p, static_cast<Index>(numbers.size())).first->second;
  };
  std::vector<std::array<Index, 2>> border;
  for (const SurfaceEdge& e : chains.edges) {
    if (e.count != 1) continue;
    sheet.border_length += (mesh.points[e.ids[1]] - mesh.points[e.ids[0]]).norm();
    border.push_back({number(e.ids[0]), number(e.ids[1])});
  }
  DisjointSets sets(numbers.size());
  for (const auto& [p, q] : border) sets.unite(p, q);
  for (Index p = 0; p < sets.size(); ++p) sheet.border_pieces += sets.is_root(p);
  return sheet;
}

}  // namespace

std::vector<InterfaceTriangle> sheets_of(const TetMesh& mesh) {
  std::vector<InterfaceTriangle> sheets;
  std::copy_if(mesh.interfaces.begin(), mesh.interfaces.end(), std::back_inserter(sheets),
               [](const InterfaceTriangle& t) { return t.is_sheet(); });
  return sheets;
}

void append_sheets(std::vector<InterfaceTriangle>& interfaces, std::vector<InterfaceTriangle> sheets) {
  if (sheets.empty()) return;
  for (InterfaceTriangle& t : sheets) t.ids = sorted_ids(t.ids);
  std::sort(sheets.begin(), sheets.end(), [](const InterfaceTriangle& x, const InterfaceTriangle& y) {
    return std::tie(x.ids, x.material, x.patch) < std::tie(y.ids, y.material, y.patch);
  });
  orient(sheets);
  interfaces.insert(interfaces.end(), sheets.begin(), sheets.end());
}

std::vector<InterfaceTriangle> interfaces_with_sheets(const TetMesh& mesh) {
  const std::vector<InterfaceTriangle> sheets = sheets_of(mesh);
  std::vector<InterfaceTriangle> interfaces = find_interfaces(mesh);
  interfaces.insert(interfaces.end(), sheets.begin(), sheets.end());
  return interfaces;
}

std::vector<std::size_t> misplaced_sheet_faces(const TetMesh& mesh) {
  std::vector<std::size_t> misplaced;
  std::vector<std::uint8_t> candidates(mesh.points.size(), 0);
  bool any = false;
  for (const InterfaceTriangle& t : mesh.interfaces)
    if (t.is_sheet()) {
      any = true;
      for (const Index p : t.ids)
        if (p < candidates.size()) candidates[p] = 1;
    }
  if (!any) return misplaced;
  const std::vector<MeshFace> faces = mesh_faces(mesh.tets, mesh.points.size(), &candidates);
  std::set<Triangle> known;
  for (std::size_t i = 0; i < mesh.interfaces.size(); ++i) {
    const InterfaceTriangle& t = mesh.interfaces[i];
    if (!t.is_sheet()) continue;
    const Triangle ids = sorted_ids(t.ids);
    const auto face = std::lower_bound(faces.begin(), faces.end(), ids,
                                       [](const MeshFace& f, const Triangle& key) { return f.ids < key; });
    const bool fits = face != faces.end() && face->ids == ids && face->count == 2 &&
                      mesh.materials[face->first] == t.material && mesh.materials[face->second] == t.material;
    if (!fits || !known.insert(ids).second) misplaced.push_back(i);
  }
  return misplaced;
}

std::vector<SheetStatistics> sheet_statistics(const TetMesh& mesh) {
  std::map<std::pair<SurfaceRegion, std::string>, std::vector<Triangle>> sheets;
  for (const InterfaceTriangle& t : mesh.interfaces) {
    if (!t.is_sheet()) continue;
    const auto known = mesh.patch_groups.find({t.pair(), t.patch});
    const SurfaceRegion group = known == mesh.patch_groups.end() ? SurfaceRegion{} : known->second;
    const std::string name = !group               ? pair_name(t.pair(), mesh.material_names)
                             : group.name.empty() ? std::to_string(group.number)
                                                  : group.name;
    sheets[{group, name}].push_back(t.ids);
  }
  std::vector<SheetStatistics> out;
  out.reserve(sheets.size());
  for (const auto& [key, triangles] : sheets) out.push_back(statistics_of(mesh, key.second, triangles));
  return out;
}

}  // namespace tetwright
