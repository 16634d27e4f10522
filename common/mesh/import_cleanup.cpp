// SPDX-License-Identifier: Apache-2.0
#include "tetwright/mesh_quality.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "common/geometry/predicates.h"
#include "common/mesh/face_buckets.h"
#include "common/mesh/point_table.h"
#include "common/parallel/parallel_sort.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

constexpr std::size_t element_grain = 4096;
constexpr std::size_t listed_inverted = 3;

int sign(const TetMesh& mesh, const Tet& t) {
  return orient3d(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]);
}

/// Power of two that scales coordinates to at most 1, so that volumes do not overflow.
double scale_of(const TetMesh& mesh) {
  double largest = 0;
  for (const Vec3& p : mesh.points) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  int exponent = 0;
  std::frexp(largest, &exponent);
  return std::ldexp(1.0, -std::clamp(exponent, -1000, 1023));
}

double volume(const TetMesh& mesh, const Tet& t, double scale) {
  return orient3d_value(mesh.points[t[0]] * scale, mesh.points[t[1]] * scale, mesh.points[t[2]] * scale,
                        mesh.points[t[3]] * scale);
}

bool all_positive(const TetMesh& mesh) {
  std::atomic<bool> fine{true};
  parallel_for(0, mesh.tets.size(), element_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end && fine.load(std::memory_order_relaxed); ++t)
      if (sign(mesh, mesh.tets[t]) <= 0) fine.store(false, std::memory_order_relaxed);
  });
  return fine.load();
}

/// Moves the kept entries of `values` to the front and preserves their order.
template <class T, class Stays>
void compact(std::vector<T>& values, std::size_t components, const Stays& stays) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i * components < values.size(); ++i) {
    if (!stays(i)) continue;
    for (std::size_t k = 0; k < components; ++k) values[kept * components + k] = values[i * components + k];
    ++kept;
  }
  values.resize(kept * components);
}

template <class Stays>
void compact(std::vector<MeshField>& fields, const Stays& stays) {
  for (MeshField& field : fields) compact(field.values, static_cast<std::size_t>(field.components), stays);
}

/// Tet of each point, or no_index; empty if some point has two tets.
std::vector<Index> owners_in_soup(const TetMesh& mesh) {
  std::vector<Index> owners(mesh.points.size(), no_index);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (const Index p : mesh.tets[t]) {
      if (owners[p] != no_index && owners[p] != t) return {};
      owners[p] = static_cast<Index>(t);
    }
  return owners;
}

/// Merges the points of a soup.
/// \return the number of points removed
std::size_t merge_soup(TetMesh& mesh) {
  if (mesh.tets.size() < 2) return 0;
  std::vector<Index> owners = owners_in_soup(mesh);
  if (owners.empty()) return 0;
  // From here on, entry p is the point into which p is merged.
  std::vector<Index>& target = owners;
  std::size_t merged = 0;
  {
    PointTable table(mesh.points);
    for (std::size_t p = 0; p < target.size(); ++p) {
      const auto self = static_cast<Index>(p);
      target[p] = target[p] == no_index ? self : table.add(self);
      merged += target[p] != self;
    }
  }
  if (merged == 0) return 0;
  const auto stays = [&](std::size_t p) { return target[p] == p; };
  compact(mesh.points, 1, stays);
  compact(mesh.point_fields, stays);
  // A target's index is at most its point's index, so targets are renumbered before they are looked up.
  Index next = 0;
  for (std::size_t p = 0; p < target.size(); ++p) target[p] = target[p] == p ? next++ : target[target[p]];
  parallel_for(0, mesh.tets.size(), element_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      for (Index& p : mesh.tets[t]) p = target[p];
  });
  for (InterfaceTriangle& t : mesh.interfaces)
    for (Index& p : t.ids) p = target[p];
  return merged;
}

bool repeats_vertex(const Tet& t) {
  return std::any_of(tet_edges.begin(), tet_edges.end(), [&](const auto& e) { return t[e[0]] == t[e[1]]; });
}

/// Removes tets with a repeated vertex.
/// \return their number
std::size_t remove_repeating(TetMesh& mesh) {
  const auto count = std::count_if(mesh.tets.begin(), mesh.tets.end(), repeats_vertex);
  if (count == 0) return 0;
  const auto stays = [&](std::size_t t) { return !repeats_vertex(mesh.tets[t]); };
  compact(mesh.materials, 1, stays);
  compact(mesh.cell_fields, stays);
  std::erase_if(mesh.tets, repeats_vertex);
  return static_cast<std::size_t>(count);
}

/// Neighbours across faces: entry 4 t + f is for face f of tet t. It is no_index unless exactly one other tet
/// has the face; otherwise twice that tet's index, plus one if both tets list the face in the same sense.
/// Consistently oriented neighbours list it in opposite senses. Peak memory 32 bytes for each tet and 8 for
/// each point.
std::vector<Index> link_faces(const TetMesh& mesh) {
  using Buckets = FaceBuckets<Index>;
  std::vector<Index> across(4 * mesh.tets.size(), no_index);
  const auto tet_at = [&](std::size_t t) -> const Tet& { return mesh.tets[t]; };
  const Buckets buckets(mesh.tets.size(), mesh.points.size(), tet_at);
  parallel_for(0, mesh.points.size(), element_grain, [&](std::size_t begin, std::size_t end) {
    Buckets::Workspace ws;
    for (std::size_t p = begin; p < end; ++p)
      buckets.visit(static_cast<Index>(p), tet_at, ws,
                    [&](const Triangle&, std::span<const Buckets::Use> uses) {
                      if (uses.size() != 2) return;
                      const Index same = uses[0].even == uses[1].even ? 1 : 0;
                      across[4 * std::size_t{uses[0].tet} + uses[0].face] = uses[1].tet * 2 + same;
                      across[4 * std::size_t{uses[1].tet} + uses[1].face] = uses[0].tet * 2 + same;
                    });
  });
  return across;
}

/// Orients the tets.
/// \return the number of tets reoriented
std::size_t orient(TetMesh& mesh) {
  std::vector<Tet>& tets = mesh.tets;
  const std::vector<Index> across = link_faces(mesh);
  const double scale = scale_of(mesh);
  enum : std::uint8_t { unseen, as_is, turned };
  std::vector<std::uint8_t> state(tets.size(), unseen);
  std::vector<Index> part;  // face-connected tets, in the order reached
  std::size_t count = 0;
  for (std::size_t seed = 0; seed < tets.size(); ++seed) {
    if (state[seed] != unseen) continue;
    part.assign(1, static_cast<Index>(seed));
    state[seed] = as_is;
    double total = 0;
    std::size_t turned_here = 0;
    for (std::size_t i = 0; i < part.size(); ++i) {
      const Index t = part[i];
      const double v = volume(mesh, tets[t], scale);
      total += state[t] == turned ? -v : v;
      turned_here += state[t] == turned;
      for (std::size_t f = 0; f < 4; ++f) {
        const Index link = across[4 * std::size_t{t} + f];
        if (link == no_index || state[link / 2] != unseen) continue;
        const bool turn = (state[t] == turned) != (link % 2 == 1);
        state[link / 2] = turn ? turned : as_is;
        part.push_back(link / 2);
      }
    }
    for (std::size_t i = 0; i < part.size() && total == 0; ++i) {
      const int s = sign(mesh, tets[part[i]]);
      total = state[part[i]] == turned ? -s : s;
    }
    const std::uint8_t to_turn = total < 0 ? as_is : turned;
    count += total < 0 ? part.size() - turned_here : turned_here;
    for (const Index t : part)
      if (state[t] == to_turn) std::swap(tets[t][2], tets[t][3]);
  }
  return count;
}

/// Recomputes the interfaces if they have patches; clears them otherwise.
/// \return the number of lost faces with a patch
std::size_t renew_interfaces(TetMesh& mesh) {
  std::map<Triangle, InterfacePatch> before;
  const auto key = [](Triangle ids) {
    std::sort(ids.begin(), ids.end());
    return ids;
  };
  const std::map<InterfacePatch, SurfaceRegion> groups = std::move(mesh.patch_groups);
  std::size_t lost = 0;
  std::vector<InterfaceTriangle> sheets = sheets_of(mesh);
  for (const InterfaceTriangle& t : mesh.interfaces) {
    if (t.patch == 0 || t.is_sheet()) continue;
    // Both copies of a merged face may have a patch.
    const InterfacePatch own{t.pair(), t.patch};
    const auto [known, added] = before.emplace(key(t.ids), own);
    lost += !added && known->second != own && groups.contains(own);
  }
  mesh.patch_groups.clear();
  mesh.interfaces = std::move(sheets);
  const std::vector<std::size_t> misplaced = misplaced_sheet_faces(mesh);
  for (auto i = misplaced.rbegin(); i != misplaced.rend(); ++i)
    mesh.interfaces.erase(mesh.interfaces.begin() + static_cast<std::ptrdiff_t>(*i));
  lost += misplaced.size();
  sheets = std::move(mesh.interfaces);
  for (const InterfaceTriangle& t : sheets)
    if (const auto group = groups.find({t.pair(), t.patch}); group != groups.end())
      mesh.patch_groups.insert(*group);
  mesh.interfaces.clear();
  if (before.empty() && sheets.empty()) return lost;
  mesh.interfaces = find_interfaces(mesh);
  // Boundary faces may have become interface faces, next to patches with the same number.
  std::map<std::pair<InterfacePatch, InterfacePatch>, std::uint16_t> numbers;
  std::set<InterfacePatch> taken;
  std::map<MaterialPair, std::uint32_t> next_free;
  constexpr std::uint32_t max_patch = 0xffff;
  for (InterfaceTriangle& t : mesh.interfaces) {
    const auto known = before.find(key(t.ids));
    if (known == before.end()) continue;
    const InterfacePatch old = known->second;
    const auto [number, added] = numbers.try_emplace({old, {t.pair(), 0}}, old.second);
    if (added && !taken.insert(InterfacePatch{t.pair(), old.second}).second) {
      std::uint32_t& free = next_free.try_emplace(t.pair(), 1).first->second;
      while (free <= max_patch && !taken.insert({t.pair(), static_cast<std::uint16_t>(free)}).second) ++free;
      number->second = free <= max_patch ? static_cast<std::uint16_t>(free) : 0;
    }
    if (number->second == 0) continue;  // counts as lost
    t.patch = number->second;
    if (const auto group = groups.find(old); group != groups.end())
      mesh.patch_groups[{t.pair(), t.patch}] = group->second;
    before.erase(known);
  }
  append_sheets(mesh.interfaces, std::move(sheets));
  return lost + before.size();
}

}  // namespace

ImportCleanupReport make_coherent(TetMesh& mesh) {
  ImportCleanupReport report;
  bool fine = all_positive(mesh);
  // A soup of positive tets has four points for each tet.
  if (!fine || mesh.points.size() >= 4 * mesh.tets.size()) report.merged_points = merge_soup(mesh);
  if (!fine) {
    report.removed_tets = remove_repeating(mesh);
    if (report.removed_tets > 0) fine = all_positive(mesh);
  }
  if (!fine) {
    report.turned_tets = orient(mesh);
    const std::vector<Index> inverted = parallel_collect<Index>(
        0, mesh.tets.size(), element_grain, [&](std::size_t begin, std::size_t end, std::vector<Index>& out) {
          for (std::size_t t = begin; t < end; ++t)
            if (sign(mesh, mesh.tets[t]) <= 0) out.push_back(static_cast<Index>(t));
        });
    report.inverted_tets = inverted.size();
    report.first_inverted.assign(inverted.begin(), inverted.begin() + static_cast<std::ptrdiff_t>(std::min(
                                                                          listed_inverted, inverted.size())));
  }
  if (report.merged_points + report.removed_tets + report.turned_tets > 0)
    report.lost_faces = renew_interfaces(mesh);
  return report;
}

}  // namespace tetwright
