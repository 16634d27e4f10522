// SPDX-License-Identifier: Apache-2.0
#include "tetwright/mesh_quality.h"

#include <algorithm>

#include "common/mesh/disjoint_sets.h"
#include "common/mesh/surface_chains.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

/// Ranks of the materials: 0, 1, ... in ascending order of their tags.
struct Ranks {
  explicit Ranks(const std::vector<MaterialTag>& materials) {
    for (std::size_t t = 0; t < materials.size(); ++t)
      if (t == 0 || materials[t] != materials[t - 1]) tags.push_back(materials[t]);
    std::sort(tags.begin(), tags.end());
    tags.erase(std::unique(tags.begin(), tags.end()), tags.end());
    of_tet.resize(materials.size());
    for (std::size_t t = 0; t < materials.size(); ++t)
      of_tet[t] =
          t > 0 && materials[t] == materials[t - 1]
              ? of_tet[t - 1]
              : static_cast<Index>(std::lower_bound(tags.begin(), tags.end(), materials[t]) - tags.begin());
  }
  std::vector<MaterialTag> tags;
  std::vector<Index> of_tet;
};

/// Number of simplices of the domain and of each material.
struct Counts {
  explicit Counts(std::size_t materials) : of_material(materials, 0) {}
  Topology::Count domain = 0;
  std::vector<Topology::Count> of_material;
};

/// Counts the points or edges of the domain and of each material.
/// \param edges true: edges, false: points
Counts count_simplices(const TetMesh& mesh, const Ranks& ranks, bool edges) {
  // One bucket for each smaller vertex, filled by counting, with the other vertex and the material.
  struct Entry {
    Index other, rank;
    bool operator==(const Entry&) const = default;
    bool operator<(const Entry& e) const { return other != e.other ? other < e.other : rank < e.rank; }
  };
  const std::size_t n = mesh.points.size();
  std::vector<std::size_t> begin(n + 2, 0);
  const auto for_each = [&](const auto& call) {
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
      const Tet& tet = mesh.tets[t];
      if (edges)
        for (const auto& e : tet_edges) {
          const auto [low, high] = std::minmax(tet[e[0]], tet[e[1]]);
          call(low, Entry{high, ranks.of_tet[t]});
        }
      else
        for (Index vertex : tet) call(vertex, Entry{0, ranks.of_tet[t]});
    }
  };
  for_each([&](Index low, const Entry&) { ++begin[low + std::size_t{2}]; });
  for (std::size_t i = 2; i < begin.size(); ++i) begin[i] += begin[i - 1];
  std::vector<Entry> entries(begin.back());
  for_each([&](Index low, const Entry& entry) { entries[begin[low + std::size_t{1}]++] = entry; });

  constexpr std::size_t part_size = 4096;
  const std::size_t parts = (n + part_size - 1) / part_size;
  std::vector<Counts> partial(thread_count(), Counts(ranks.tags.size()));
  parallel_chunks(parts, [&](std::size_t part, unsigned worker) {
    Counts& counts = partial[worker];
    const std::size_t last = std::min(n, (part + 1) * part_size);
    for (std::size_t p = part * part_size; p < last; ++p) {
      const auto first = entries.begin() + static_cast<std::ptrdiff_t>(begin[p]);
      const auto end = entries.begin() + static_cast<std::ptrdiff_t>(begin[p + 1]);
      std::sort(first, end);
      for (auto e = first; e != end; ++e) {
        if (e == first || e->other != std::prev(e)->other) ++counts.domain;
        if (e == first || *e != *std::prev(e)) ++counts.of_material[e->rank];
      }
    }
  });
  Counts sum(ranks.tags.size());
  for (const Counts& counts : partial) {
    sum.domain += counts.domain;
    for (std::size_t m = 0; m < ranks.tags.size(); ++m) sum.of_material[m] += counts.of_material[m];
  }
  return sum;
}

/// Components of the domain or of each material.
/// \param materials number of materials; 0: the domain
std::vector<Topology::Count> count_components(const TetMesh& mesh, const std::vector<MeshFace>& faces,
                                              const std::vector<Index>* ranks, std::size_t materials) {
  DisjointSets sets(mesh.tets.size());
  for (const MeshFace& f : faces)
    if (f.second != no_index && (!ranks || (*ranks)[f.first] == (*ranks)[f.second]))
      sets.unite(f.first, f.second);
  std::vector<Topology::Count> components(ranks ? materials : 1, 0);
  for (Index t = 0; t < mesh.tets.size(); ++t)
    if (sets.is_root(t)) ++components[ranks ? (*ranks)[t] : 0];
  return components;
}

Topology::Surface surface_of(const std::vector<Triangle>& triangles) {
  const SurfaceChains chains = surface_chains(triangles);
  return {static_cast<Topology::Count>(chains.components), chains.euler(triangles.size())};
}

Topology::Curves curves_of(const std::vector<SurfaceEdge>& edges) {
  // Endpoints of the curves' edges: each point once for each of its edges.
  std::vector<Index> ends;
  Topology::Count count = 0;
  for (const SurfaceEdge& e : edges)
    if (e.count > 2) {
      ends.insert(ends.end(), e.ids.begin(), e.ids.end());
      ++count;
    }
  std::sort(ends.begin(), ends.end());
  std::vector<Index> points = ends;
  points.erase(std::unique(points.begin(), points.end()), points.end());
  Topology::Curves curves;
  curves.euler = std::ssize(points) - count;
  DisjointSets sets(points.size());
  const auto number = [&](Index p) {
    return static_cast<Index>(std::lower_bound(points.begin(), points.end(), p) - points.begin());
  };
  for (const SurfaceEdge& e : edges)
    if (e.count > 2) sets.unite(number(e.ids[0]), number(e.ids[1]));
  auto end = ends.begin();
  for (Index i = 0; i < points.size(); ++i) {
    curves.components += sets.is_root(i);
    const auto first = end;
    while (end != ends.end() && *end == points[i]) ++end;
    curves.branch_points += end - first != 2;
  }
  return curves;
}

std::string text(const Topology::Surface& s) {
  return "components " + std::to_string(s.components) + ", euler " + std::to_string(s.euler);
}

/// Descriptions of the parts by name, in a fixed order.
std::vector<std::pair<std::string, std::string>> parts(const Topology& t) {
  std::vector<std::pair<std::string, std::string>> out;
  const auto add_solid = [&](const std::string& name, const Topology::Solid& s) {
    out.emplace_back(name, text(Topology::Surface{s.components, s.euler}) + ", boundary components " +
                               std::to_string(s.boundary_components) + ", boundary euler " +
                               std::to_string(s.boundary_euler));
  };
  add_solid("domain", t.domain);
  for (const auto& [tag, solid] : t.materials) add_solid("material " + std::to_string(tag), solid);
  for (const auto& [pair, surface] : t.interfaces)
    out.emplace_back("interface " + pair_name(pair), text(surface));
  for (const auto& [name, sheet] : t.sheets) out.emplace_back("sheet " + name, text(sheet));
  if (t.touching_fans)
    out.emplace_back("interfaces touch at points", "count " + std::to_string(*t.touching_fans));
  if (t.junction_curves)
    out.emplace_back("junction curves",
                     text(Topology::Surface{t.junction_curves->components, t.junction_curves->euler}) +
                         ", branch points " + std::to_string(t.junction_curves->branch_points));
  return out;
}

}  // namespace

std::vector<Triangle> boundary_and_interfaces(const TetMesh& mesh, const std::vector<MeshFace>& faces) {
  std::vector<Triangle> out;
  for (const MeshFace& f : faces)
    if (f.second == no_index || mesh.materials[f.first] != mesh.materials[f.second]) out.push_back(f.ids);
  return out;
}

Topology topology(const TetMesh& mesh) { return topology(mesh, mesh_faces(mesh.tets, mesh.points.size())); }

Topology topology(const TetMesh& mesh, const std::vector<MeshFace>& faces) {
  const Ranks ranks(mesh.materials);
  const std::size_t materials = ranks.tags.size();
  const Counts points = count_simplices(mesh, ranks, false), edges = count_simplices(mesh, ranks, true);

  // Count the faces and tets of each material, and list the triangles of its boundary and of each interface.
  Counts face_counts(materials), tet_counts(materials);
  face_counts.domain = std::ssize(faces);
  tet_counts.domain = std::ssize(mesh.tets);
  for (Index rank : ranks.of_tet) ++tet_counts.of_material[rank];
  std::vector<Triangle> outer, all;
  std::vector<std::vector<Triangle>> boundary(materials);
  std::map<Topology::Pair, std::vector<Triangle>> interfaces;
  for (const MeshFace& f : faces) {
    const Index a = ranks.of_tet[f.first];
    ++face_counts.of_material[a];
    if (f.second == no_index) {
      outer.push_back(f.ids);
      all.push_back(f.ids);
      boundary[a].push_back(f.ids);
      interfaces[{ranks.tags[a], std::nullopt}].push_back(f.ids);
      continue;
    }
    const Index b = ranks.of_tet[f.second];
    if (a == b) continue;
    ++face_counts.of_material[b];
    all.push_back(f.ids);
    boundary[a].push_back(f.ids);
    boundary[b].push_back(f.ids);
    interfaces[{ranks.tags[std::min(a, b)], ranks.tags[std::max(a, b)]}].push_back(f.ids);
  }

  Topology out;
  const auto solid = [](Topology::Count components, Topology::Count euler,
                        const std::vector<Triangle>& surface) {
    const Topology::Surface s = surface_of(surface);
    return Topology::Solid{components, euler, s.components, s.euler};
  };
  out.domain = solid(count_components(mesh, faces, nullptr, 0)[0],
                     points.domain - edges.domain + face_counts.domain - tet_counts.domain, outer);
  for (const SheetStatistics& s : sheet_statistics(mesh))
    out.sheets[s.name] = {static_cast<Topology::Count>(s.pieces), static_cast<Topology::Count>(s.euler)};
  if (materials < 2) return out;
  const std::vector<Topology::Count> components = count_components(mesh, faces, &ranks.of_tet, materials);
  for (std::size_t m = 0; m < materials; ++m)
    out.materials[ranks.tags[m]] = solid(
        components[m],
        points.of_material[m] - edges.of_material[m] + face_counts.of_material[m] - tet_counts.of_material[m],
        boundary[m]);
  for (const auto& [pair, triangles] : interfaces) out.interfaces[pair] = surface_of(triangles);
  const SurfaceChains chains = surface_chains(all);
  out.touching_fans = static_cast<Topology::Count>(chains.surplus_fans);
  if (std::any_of(chains.edges.begin(), chains.edges.end(), [](const SurfaceEdge& e) { return e.count > 2; }))
    out.junction_curves = curves_of(chains.edges);
  return out;
}

namespace {

std::string joined(std::initializer_list<std::string_view> texts) {
  std::string out;
  for (std::string_view text : texts) out += text;
  return out;
}

}  // namespace

std::vector<std::string> topology_lines(const Topology& topology) {
  std::vector<std::string> out;
  for (const auto& [name, text] : parts(topology)) out.push_back(joined({name, ": ", text}));
  return out;
}

std::vector<std::string> topology_differences(const Topology& before, const Topology& after) {
  const auto before_parts = parts(before), after_parts = parts(after);
  const auto find = [](const auto& in, const std::string& name) {
    const auto at = std::find_if(in.begin(), in.end(), [&](const auto& part) { return part.first == name; });
    return at == in.end() ? std::string("missing") : at->second;
  };
  std::vector<std::string> out;
  for (const auto& [name, text] : before_parts)
    if (const std::string now = find(after_parts, name); now != text)
      out.push_back(joined({name, ": before ", text, "; after ", now}));
  for (const auto& [name, text] : after_parts)
    if (find(before_parts, name) == "missing")
      out.push_back(joined({name, ": before missing; after ", text}));
  return out;
}

}  // namespace tetwright
