// SPDX-License-Identifier: Apache-2.0
#include "tetwright/mesh_quality.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "common/geometry/predicates.h"
#include "common/geometry/self_intersection.h"
#include "common/mesh/disjoint_sets.h"
#include "common/mesh/surface_chains.h"
#include "common/number_text.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

std::string numbers(std::span<const Index> ids) {
  std::string out;
  for (Index i : ids) {
    if (!out.empty()) out += ' ';
    append_number(out, i);
  }
  return out;
}

/// Indices below `n` for which `is_bad` returns true, ascending. Parallel.
template <class IsBad>
std::vector<Index> find_bad(std::size_t n, const IsBad& is_bad) {
  constexpr std::size_t part_size = 1 << 14;
  std::vector<std::vector<Index>> parts((n + part_size - 1) / part_size);
  parallel_chunks(parts.size(), [&](std::size_t part, unsigned) {
    const std::size_t last = std::min(n, (part + 1) * part_size);
    for (std::size_t i = part * part_size; i < last; ++i)
      if (is_bad(i)) parts[part].push_back(static_cast<Index>(i));
  });
  std::vector<Index> out;
  for (const auto& part : parts) out.insert(out.end(), part.begin(), part.end());
  return out;
}

class Checker {
 public:
  Checker(const TetMesh& mesh, const MeshCheckOptions& options) : mesh_(mesh), options_(options) {}

  /// Checks the arrays; false if further checks would be meaningless.
  bool check_arrays() {
    if (mesh_.tets.empty() || mesh_.materials.size() != mesh_.tets.size())
      add(DiagnosticCode::materials_missing, 1, [&](std::size_t) {
        return MeshPlace{std::to_string(mesh_.tets.size()) + " tets, " +
                             std::to_string(mesh_.materials.size()) + " materials",
                         {},
                         {}};
      });
    add_tets(DiagnosticCode::index_out_of_range, find_bad(mesh_.tets.size(), [&](std::size_t t) {
               return *std::max_element(mesh_.tets[t].begin(), mesh_.tets[t].end()) >= mesh_.points.size();
             }));
    add_points(DiagnosticCode::coordinates_not_finite,
               find_bad(mesh_.points.size(), [&](std::size_t p) { return !mesh_.points[p].allFinite(); }));
    return findings_.empty();
  }

  void check_tets() {
    const auto& tets = mesh_.tets;
    const auto& points = mesh_.points;
    add_tets(DiagnosticCode::degenerate_tets, find_bad(tets.size(), [&](std::size_t t) {
               for (const auto& e : tet_edges)
                 if (tets[t][e[0]] == tets[t][e[1]]) return true;
               return false;
             }));
    add_tets(DiagnosticCode::duplicate_tets, duplicates());
    std::vector<char> used(points.size(), 0);
    for (const Tet& tet : tets)
      for (Index v : tet) used[v] = 1;
    add_points(DiagnosticCode::unused_points,
               find_bad(points.size(), [&](std::size_t p) { return !used[p]; }));
    add_tets(DiagnosticCode::inverted, find_bad(tets.size(), [&](std::size_t t) {
               const Tet& v = tets[t];
               return orient3d(points[v[0]], points[v[1]], points[v[2]], points[v[3]]) <= 0;
             }));
    used_points_ = static_cast<std::size_t>(std::count(used.begin(), used.end(), 1));
  }

  void check_faces(const std::vector<MeshFace>& faces) {
    const std::vector<Index> over = find_bad(faces.size(), [&](std::size_t f) { return faces[f].count > 2; });
    add(DiagnosticCode::face_over_shared, over.size(),
        [&](std::size_t i) { return place("face " + numbers(faces[over[i]].ids), faces[over[i]].ids); });

    std::vector<Triangle> boundary;
    for (const MeshFace& f : faces)
      if (f.second == no_index) boundary.push_back(f.ids);
    const SurfaceChains chains = surface_chains(boundary);
    std::vector<SurfaceEdge> bad_edges;
    for (const SurfaceEdge& e : chains.edges)
      if (e.count != 2) bad_edges.push_back(e);
    add(DiagnosticCode::boundary_edges_not_two, bad_edges.size(), [&](std::size_t i) {
      return place(
          "edge " + numbers(bad_edges[i].ids) + " with " + std::to_string(bad_edges[i].count) + " triangles",
          bad_edges[i].ids);
    });
    add(DiagnosticCode::boundary_points_non_manifold, chains.surplus_fans, [&](std::size_t i) {
      return i < chains.touching_points.size() ? point_place(chains.touching_points[i]) : MeshPlace();
    });
    check_stars(faces);
    const std::vector<std::size_t> misplaced = misplaced_sheet_faces(mesh_);
    if (options_.self_intersections) {
      std::vector<Triangle> surface = boundary_and_interfaces(mesh_, faces);
      if (misplaced.empty())
        for (const InterfaceTriangle& t : sheets_of(mesh_)) surface.push_back(t.ids);
      check_self_intersections(surface);
    }
    add(DiagnosticCode::sheet_faces_misplaced, misplaced.size(), [&](std::size_t i) {
      const Triangle& ids = mesh_.interfaces[misplaced[i]].ids;
      return place("face " + numbers(ids), ids);
    });
  }

  std::vector<MeshFinding> findings() { return std::move(findings_); }

 private:
  /// Adds a finding; `place_of(i)` describes the i-th item, which is left out if its text is empty.
  template <class PlaceOf>
  void add(DiagnosticCode code, std::size_t count, const PlaceOf& place_of) {
    if (count == 0) return;
    MeshFinding finding{code, count, {}};
    for (std::size_t i = 0; i < std::min(count, options_.places); ++i)
      if (MeshPlace found = place_of(i); !found.text.empty()) finding.places.push_back(std::move(found));
    findings_.push_back(std::move(finding));
  }
  void add_tets(DiagnosticCode code, const std::vector<Index>& tets) {
    add(code, tets.size(), [&](std::size_t i) {
      return place("tet " + std::to_string(tets[i]) + " (" + numbers(mesh_.tets[tets[i]]) + ")",
                   mesh_.tets[tets[i]]);
    });
  }
  void add_points(DiagnosticCode code, const std::vector<Index>& points) {
    add(code, points.size(), [&](std::size_t i) { return point_place(points[i]); });
  }
  MeshPlace point_place(Index p) const {
    std::string out = "point " + std::to_string(p) + " at ";
    append_point(out, mesh_.points[p]);
    return place(std::move(out), std::array{p});
  }
  MeshPlace place(std::string text, std::span<const Index> points) const {
    MeshPlace found{std::move(text), {points.begin(), points.end()}, {}};
    Vec3 sum = Vec3::Zero();
    for (const Index p : points) {
      if (p >= mesh_.points.size() || !mesh_.points[p].allFinite()) return found;
      sum += mesh_.points[p] / static_cast<double>(points.size());
    }
    found.at = sum;
    return found;
  }

  /// Tets with the vertices of a tet of smaller index.
  std::vector<Index> duplicates() const {
    const auto& tets = mesh_.tets;
    const auto sorted = [&](Index t) {
      Tet tet = tets[t];
      std::sort(tet.begin(), tet.end());
      return tet;
    };
    // Equal tets have equal hashes; sorting the hashes takes half the memory of sorting the tets.
    std::vector<std::pair<std::uint64_t, Index>> keys(tets.size());
    parallel_for(0, tets.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) {
        std::uint64_t key = 0;
        for (Index v : sorted(static_cast<Index>(t))) {
          key = (key ^ v) * 0x9e3779b97f4a7c15u;
          key ^= key >> 32;
        }
        keys[t] = {key, static_cast<Index>(t)};
      }
    });
    std::sort(keys.begin(), keys.end());
    std::vector<Index> out;
    for (std::size_t i = 0; i < keys.size();) {
      std::size_t end = i + 1;
      while (end < keys.size() && keys[end].first == keys[i].first) ++end;
      if (end - i > 1) {
        std::vector<std::pair<Tet, Index>> same;
        for (std::size_t k = i; k < end; ++k) same.emplace_back(sorted(keys[k].second), keys[k].second);
        std::sort(same.begin(), same.end());
        for (std::size_t k = 1; k < same.size(); ++k)
          if (same[k].first == same[k - 1].first) out.push_back(same[k].second);
      }
      i = end;
    }
    std::sort(out.begin(), out.end());
    return out;
  }

  /// Checks that each point's tets are connected by faces at the point: corners of tets are joined across
  /// faces, and each point must have one set.
  void check_stars(const std::vector<MeshFace>& faces) {
    const auto& tets = mesh_.tets;
    // Corner indices 4 t + k have 32 bits, since 64 would take twice the memory. Meshes of 2^30 tets and more
    // are therefore not checked.
    if (tets.size() >= (std::size_t{1} << 30)) return;
    DisjointSets corners(4 * tets.size());
    const auto corner = [&](Index t, Index v) {
      return 4 * t + static_cast<Index>(std::find(tets[t].begin(), tets[t].end(), v) - tets[t].begin());
    };
    for (const MeshFace& f : faces)
      if (f.second != no_index)
        for (Index v : f.ids) corners.unite(corner(f.first, v), corner(f.second, v));
    std::size_t stars = 0;
    for (Index c = 0; c < corners.size(); ++c) stars += corners.is_root(c);
    if (stars == used_points_) return;
    std::vector<Index> points;
    for (Index c = 0; c < corners.size(); ++c)
      if (corners.is_root(c)) points.push_back(tets[c / 4][c % 4]);
    std::sort(points.begin(), points.end());
    std::vector<Index> split;
    for (std::size_t i = 1; i < points.size(); ++i)
      if (points[i] == points[i - 1] && (split.empty() || split.back() != points[i]))
        split.push_back(points[i]);
    add(DiagnosticCode::point_star_split, stars - used_points_,
        [&](std::size_t i) { return i < split.size() ? point_place(split[i]) : MeshPlace(); });
  }

  void check_self_intersections(const std::vector<Triangle>& surface) {
    const auto pairs = self_intersections(mesh_.points, surface);
    add(DiagnosticCode::self_intersections, pairs.size(), [&](std::size_t i) {
      const Triangle &a = surface[pairs[i].first], &b = surface[pairs[i].second];
      return place("triangles " + numbers(a) + " and " + numbers(b),
                   std::array{a[0], a[1], a[2], b[0], b[1], b[2]});
    });
  }

  const TetMesh& mesh_;
  const MeshCheckOptions& options_;
  std::size_t used_points_ = 0;
  std::vector<MeshFinding> findings_;
};

}  // namespace

std::string mesh_finding_name(const MeshFinding& finding) {
  std::string name = kind_of(finding.code).name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

bool is_valid(const std::vector<MeshFinding>& findings) {
  return std::none_of(findings.begin(), findings.end(),
                      [](const MeshFinding& f) { return kind_of(f.code).severity == Severity::error; });
}

std::vector<MeshFinding> check_mesh(const TetMesh& mesh, const MeshCheckOptions& options) {
  Checker checker(mesh, options);
  if (!checker.check_arrays()) return checker.findings();
  checker.check_tets();
  checker.check_faces(mesh_faces(mesh.tets, mesh.points.size()));
  return checker.findings();
}

std::vector<MeshFinding> check_mesh(const TetMesh& mesh, const MeshCheckOptions& options,
                                    const std::vector<MeshFace>& faces) {
  Checker checker(mesh, options);
  if (!checker.check_arrays()) return checker.findings();
  checker.check_tets();
  checker.check_faces(faces);
  return checker.findings();
}

std::string mesh_finding_line(const MeshFinding& finding) {
  std::string out = std::string(kind_of(finding.code).message) + " (" + mesh_finding_name(finding) +
                    "): " + std::to_string(finding.count);
  for (std::size_t i = 0; i < finding.places.size(); ++i) {
    out += i > 0 ? "; " : finding.count == 1 ? ", at " : ", the first at ";
    out += finding.places[i].text;
  }
  return out;
}

Diagnostic diagnostic_of(const MeshFinding& finding) {
  Diagnostic d{.code = finding.code, .what = mesh_finding_line(finding)};
  for (const MeshPlace& place : finding.places)
    if (place.at) d.places.push_back(*place.at);
  return d;
}

}  // namespace tetwright
