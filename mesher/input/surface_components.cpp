// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/surface_components.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <span>

#include "common/mesh/disjoint_sets.h"
#include "common/message_text.h"
#include "common/parallel/parallel_sort.h"
#include "mesher/tuning/input_tuning.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

/// One side of a triangle; sides that join the same two points are adjacent when sorted.
struct EdgeSide {
  std::uint64_t edge;  ///< smaller point << 32 | larger point
  std::uint32_t triangle;
  std::uint32_t forward;  ///< 1 if the triangle runs from the smaller to the larger point
  auto operator<=>(const EdgeSide&) const = default;
};

std::vector<EdgeSide> sorted_sides(const std::vector<Triangle>& triangles) {
  std::vector<EdgeSide> sides(3 * triangles.size());
  parallel_for(0, triangles.size(), InputGrains::triangles, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint64_t a = triangles[t][k], b = triangles[t][(k + 1) % 3];
        sides[3 * t + k] = {std::min(a, b) << 32 | std::max(a, b), static_cast<std::uint32_t>(t), a < b};
      }
  });
  parallel_sort(sides);
  return sides;
}

/// Calls `body` with each group of sides on one edge.
template <class Body>
void for_each_edge(const std::vector<EdgeSide>& sides, Body&& body) {
  for (std::size_t i = 0, j; i < sides.size(); i = j) {
    for (j = i + 1; j < sides.size() && sides[j].edge == sides[i].edge;) ++j;
    body(std::span(sides).subspan(i, j - i));
  }
}

/// The first index of each part when items i are sorted by their part `of(i)`; `parts` + 1 entries.
template <class Of>
std::vector<std::size_t> starts(std::size_t items, std::size_t parts, Of&& of) {
  std::vector<std::size_t> start(parts + 1, 0);
  for (std::size_t i = 0; i < items; ++i) ++start[of(i) + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  return start;
}

/// The part of a patch that lies on a seam edge.
struct Seam {
  Index edge;  ///< index of the seam edge
  Index patch;
  int net;  ///< sides that run forward minus sides that run back
  int sides;
};

enum class PatchKind : std::uint8_t { core, open, wall };

/// The patches of a surface and how they meet.
class Patches {
 public:
  Patches(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles,
          const std::vector<EdgeSide>& sides, const std::string& file)
      : points_(points), triangles_(triangles) {
    flood(sides, file);
    find_seams(sides);
  }

  void arrange(const std::vector<char>& two_sided) {
    drop_flaps();
    peel();
    drop_fins(two_sided);
    drop_walls_of_core();
    // Balance the core first, since patches attached to it must not affect it.
    balance(PatchKind::core);
    balance(PatchKind::open);
  }

  bool turned(Index t) const { return turned_[t] != patch_turned_[patch_[t]]; }
  bool wall(Index t) const { return kind_[patch_[t]] == PatchKind::wall; }

  std::vector<SurfaceComponent> components() const;

 private:
  void flood(const std::vector<EdgeSide>& sides, const std::string& file);
  void find_seams(const std::vector<EdgeSide>& sides);
  void drop_flaps();
  void peel();
  void drop_fins(const std::vector<char>& two_sided);
  void drop_walls_of_core();
  void balance(PatchKind kind);

  std::span<const Seam> at_edge(Index edge) const {
    return std::span(seams_).subspan(edge_start_[edge], edge_start_[edge + 1] - edge_start_[edge]);
  }
  /// Indices into seams_ of a patch's seams.
  std::span<const Index> of_patch(Index patch) const {
    return std::span(patch_seams_)
        .subspan(patch_start_[patch], patch_start_[patch + 1] - patch_start_[patch]);
  }
  int sides_at(Index edge, PatchKind kind) const {
    int sum = 0;
    for (const Seam& s : at_edge(edge)) sum += kind_[s.patch] == kind ? s.sides : 0;
    return sum;
  }

  const std::vector<Vec3>& points_;
  const std::vector<Triangle>& triangles_;
  std::vector<Index> patch_;     ///< of each triangle
  std::vector<char> turned_;     ///< of each triangle: reversed so that its patch is consistent
  std::vector<PatchKind> kind_;  ///< this and the following: of each patch
  std::vector<char> patch_turned_;
  std::vector<Index> patch_size_;  ///< in triangles
  std::vector<double> area_;
  std::vector<Seam> seams_;  ///< by edge, then patch
  std::vector<std::size_t> edge_start_, patch_start_;
  std::vector<Index> patch_seams_;
};

void Patches::flood(const std::vector<EdgeSide>& sides, const std::string& file) {
  struct Beside {
    std::uint32_t triangle, other;
    std::uint32_t same_direction;
    auto operator<=>(const Beside&) const = default;
  };
  std::vector<Beside> neighbours;
  neighbours.reserve(sides.size());
  for_each_edge(sides, [&](std::span<const EdgeSide> edge) {
    if (edge.size() != 2) return;
    const std::uint32_t same = edge[0].forward == edge[1].forward;
    neighbours.push_back({edge[0].triangle, edge[1].triangle, same});
    neighbours.push_back({edge[1].triangle, edge[0].triangle, same});
  });
  parallel_sort(neighbours);
  const auto start =
      starts(neighbours.size(), triangles_.size(), [&](std::size_t i) { return neighbours[i].triangle; });
  patch_.assign(triangles_.size(), no_index);
  turned_.assign(triangles_.size(), 0);
  std::vector<Index> queue;  // finally holds the whole patch
  for (Index seed = 0; seed < triangles_.size(); ++seed) {
    if (patch_[seed] != no_index) continue;
    const auto patch = static_cast<Index>(kind_.size());
    patch_[seed] = patch;
    queue.assign(1, seed);
    std::size_t against = 0;
    double area = 0;
    for (std::size_t i = 0; i < queue.size(); ++i) {
      const Index t = queue[i];
      const auto& [a, b, c] = triangles_[t];
      area += (points_[b] - points_[a]).cross(points_[c] - points_[a]).norm() / 2;
      against += turned_[t] != 0;
      for (std::size_t k = start[t]; k < start[t + 1]; ++k) {
        const Index other = neighbours[k].other;
        const char turn = (turned_[t] != 0) != (neighbours[k].same_direction != 0);
        if (patch_[other] == no_index) {
          patch_[other] = patch;
          turned_[other] = turn;
          queue.push_back(other);
        } else if (turned_[other] != turn) {
          throw InputError(file, 0,
                           "the surface is one-sided, like a Moebius strip or a Klein bottle, at " +
                               place_text(points_[a]) + ": it has no inside; leave that part out or cut it");
        }
      }
    }
    if (2 * against > queue.size())
      for (Index t : queue) turned_[t] = !turned_[t];
    kind_.push_back(PatchKind::core);
    patch_size_.push_back(static_cast<Index>(queue.size()));
    area_.push_back(area);
  }
  patch_turned_.assign(kind_.size(), 0);
}

void Patches::find_seams(const std::vector<EdgeSide>& sides) {
  Index edges = 0;
  std::vector<Seam> here;
  for_each_edge(sides, [&](std::span<const EdgeSide> edge) {
    if (edge.size() == 2) return;
    here.clear();
    for (const EdgeSide& s : edge)
      here.push_back({edges, patch_[s.triangle], (s.forward != 0) != (turned_[s.triangle] != 0) ? 1 : -1, 1});
    std::stable_sort(here.begin(), here.end(),
                     [](const Seam& a, const Seam& b) { return a.patch < b.patch; });
    for (const Seam& s : here) {
      if (&s == &here.front() || s.patch != seams_.back().patch) {
        seams_.push_back(s);
      } else {
        seams_.back().net += s.net;
        ++seams_.back().sides;
      }
    }
    ++edges;
  });
  edge_start_ = starts(seams_.size(), edges, [&](std::size_t i) { return seams_[i].edge; });
  patch_start_ = starts(seams_.size(), kind_.size(), [&](std::size_t i) { return seams_[i].patch; });
  patch_seams_.resize(seams_.size());
  std::vector<std::size_t> next(patch_start_.begin(), patch_start_.end() - 1);
  for (Index i = 0; i < seams_.size(); ++i) patch_seams_[next[seams_[i].patch]++] = i;
}

/// Drops patches all of whose boundary lies on seams at which other patches continue without them.
void Patches::drop_flaps() {
  for (Index p = 0; p < kind_.size(); ++p) {
    bool ends = false, needed = false;
    for (Index i : of_patch(p)) {
      if (seams_[i].net == 0) continue;
      ends = true;
      int others = 0;
      for (const Seam& s : at_edge(seams_[i].edge)) {
        if (s.patch == p) continue;
        needed |= s.net != 0;
        others += s.sides;
      }
      needed |= others == 0;
    }
    if (ends && !needed) kind_[p] = PatchKind::wall;
  }
}

/// Sets aside patches with a free edge, and repeats this for patches that then have one.
void Patches::peel() {
  std::vector<Index> queue;
  const auto look_at = [&](Index edge) {
    if (sides_at(edge, PatchKind::core) != 1) return;
    for (const Seam& s : at_edge(edge))
      if (kind_[s.patch] == PatchKind::core) {
        kind_[s.patch] = PatchKind::open;
        queue.push_back(s.patch);
      }
  };
  for (Index e = 0; e + 1 < edge_start_.size(); ++e) look_at(e);
  for (std::size_t k = 0; k < queue.size(); ++k)
    for (Index i : of_patch(queue[k])) look_at(seams_[i].edge);
}

/// Drops patches that are listed from both sides and attached to others, since their two sides enclose
/// nothing.
void Patches::drop_fins(const std::vector<char>& two_sided) {
  std::vector<char> fin(kind_.size(), 1);
  for (Index t = 0; t < triangles_.size(); ++t) fin[patch_[t]] &= two_sided[t];
  DisjointSets sets(kind_.size());
  for (std::size_t i = 1; i < seams_.size(); ++i)
    if (seams_[i].edge == seams_[i - 1].edge) sets.unite(seams_[i - 1].patch, seams_[i].patch);
  std::vector<char> hangs(kind_.size(), 0);
  for (Index p = 0; p < kind_.size(); ++p) hangs[sets.root(p)] |= !fin[p];
  for (Index p = 0; p < kind_.size(); ++p)
    if (fin[p] && kind_[p] == PatchKind::open && hangs[sets.root(p)]) kind_[p] = PatchKind::wall;
}

/// Drops inner walls, smallest first: of three patches between the same seams the wall is most likely the
/// flat one.
void Patches::drop_walls_of_core() {
  std::vector<Index> order;
  for (Index p = 0; p < kind_.size(); ++p)
    if (kind_[p] == PatchKind::core && !of_patch(p).empty()) order.push_back(p);
  std::sort(order.begin(), order.end(),
            [&](Index a, Index b) { return area_[a] != area_[b] ? area_[a] < area_[b] : a < b; });
  for (Index p : order) {
    bool ends = false, needed = false;
    for (Index i : of_patch(p)) {
      if (seams_[i].net == 0) continue;
      ends = true;
      const int all = sides_at(seams_[i].edge, PatchKind::core);
      needed |= all % 2 == 0 || all == seams_[i].sides;
    }
    if (ends && !needed) kind_[p] = PatchKind::wall;
  }
}

/// Reverses patches of a kind as long as that improves the balance of seams. Terminates because each reversal
/// reduces the sum of all imbalances by at least one.
void Patches::balance(PatchKind kind) {
  std::vector<Index> queue;
  for (Index p = 0; p < kind_.size(); ++p)
    if (kind_[p] == kind && !of_patch(p).empty()) queue.push_back(p);
  std::sort(queue.begin(), queue.end(), [&](Index a, Index b) {
    return patch_size_[a] != patch_size_[b] ? patch_size_[a] < patch_size_[b] : a < b;
  });
  std::vector<char> waiting(kind_.size(), 0);
  for (Index p : queue) waiting[p] = 1;
  for (std::size_t k = 0; k < queue.size(); ++k) {
    const Index p = queue[k];
    waiting[p] = 0;
    int gain = 0;
    for (Index i : of_patch(p)) {
      int rest = 0;
      for (const Seam& s : at_edge(seams_[i].edge))
        if (s.patch != p && (kind_[s.patch] == kind || kind_[s.patch] == PatchKind::core)) rest += s.net;
      gain += std::abs(rest + seams_[i].net) - std::abs(rest - seams_[i].net);
    }
    if (gain <= 0) continue;
    patch_turned_[p] = !patch_turned_[p];
    for (Index i : of_patch(p)) {
      seams_[i].net = -seams_[i].net;
      for (const Seam& s : at_edge(seams_[i].edge)) {
        if (s.patch == p || kind_[s.patch] != kind || waiting[s.patch]) continue;
        waiting[s.patch] = 1;
        queue.push_back(s.patch);
      }
    }
  }
}

std::vector<SurfaceComponent> Patches::components() const {
  DisjointSets sets(kind_.size());
  std::vector<char> closed(kind_.size());
  for (Index p = 0; p < kind_.size(); ++p) closed[p] = kind_[p] == PatchKind::core;
  for (Index e = 0; e + 1 < edge_start_.size(); ++e)
    for (const PatchKind kind : {PatchKind::core, PatchKind::open}) {
      Index first = no_index;
      int sum = 0;
      for (const Seam& s : at_edge(e)) {
        if (kind_[s.patch] != kind || s.net == 0) continue;
        if (first == no_index) first = s.patch;
        sets.unite(first, s.patch);
        sum += s.net;
      }
      if (sum != 0) closed[first] = 0;
    }
  for (Index p = 0; p < kind_.size(); ++p) closed[sets.root(p)] &= closed[p];
  std::vector<SurfaceComponent> components;
  std::vector<Index> number(kind_.size(), no_index);
  for (Index t = 0; t < triangles_.size(); ++t) {
    if (wall(t)) continue;
    const Index root = sets.root(patch_[t]);
    if (number[root] == no_index) {
      number[root] = static_cast<Index>(components.size());
      components.push_back({{}, closed[root] != 0});
    }
    components[number[root]].triangles.push_back(t);
  }
  return components;
}

}  // namespace

void add_finding(std::vector<Diagnostic>& findings, DiagnosticCode code, const std::string& what,
                 std::size_t count, const std::optional<Vec3>& place, const std::string& done) {
  if (count == 0) return;
  findings.push_back({.code = code, .what = what, .count = count, .done = done});
  if (place) findings.back().places.push_back(*place);
}

std::vector<SurfaceComponent> split_into_components(const std::vector<Vec3>& points,
                                                    std::vector<Triangle>& triangles,
                                                    const std::vector<char>& two_sided,
                                                    const std::string& file,
                                                    std::vector<Diagnostic>& findings) {
  const std::vector<EdgeSide> sides = sorted_sides(triangles);
  Patches patches(points, triangles, sides, file);
  patches.arrange(two_sided);

  std::size_t crowded = 0, free = 0, walls = 0, turned = 0;
  std::optional<Vec3> crowded_place, free_place, wall_place, turned_place;
  const auto count = [](std::size_t& n, std::optional<Vec3>& place, const Vec3& p) {
    if (n++ == 0) place = p;
  };
  for_each_edge(sides, [&](std::span<const EdgeSide> edge) {
    const Vec3 middle = 0.5 * points[edge[0].edge >> 32] + 0.5 * points[edge[0].edge & 0xffffffffu];
    if (edge.size() > 2) count(crowded, crowded_place, middle);
    const auto kept =
        std::count_if(edge.begin(), edge.end(), [&](const EdgeSide& s) { return !patches.wall(s.triangle); });
    if (kept == 1) count(free, free_place, middle);
  });
  for (Index t = 0; t < triangles.size(); ++t) {
    const Vec3& place = points[triangles[t][0]];
    if (patches.wall(t)) {
      count(walls, wall_place, place);
    } else if (patches.turned(t)) {
      count(turned, turned_place, place);
      std::swap(triangles[t][1], triangles[t][2]);
    }
  }
  add_finding(findings, DiagnosticCode::edges_non_manifold, "edges of more than two triangles", crowded,
              crowded_place, "kept; the surface may touch or cross itself there");
  add_finding(findings, DiagnosticCode::inner_walls_dropped, "triangles of inner walls and fins", walls,
              wall_place, "left out");
  add_finding(findings, DiagnosticCode::triangles_turned, "triangles oriented against their neighbours",
              turned, turned_place, "reversed");
  add_finding(findings, DiagnosticCode::holes_closed, "boundary edges of holes", free, free_place,
              "holes are closed where the winding number is 1/2");
  return patches.components();
}

}  // namespace tetwright
