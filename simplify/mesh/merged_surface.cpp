// SPDX-License-Identifier: Apache-2.0

// Whether the surface keeps its topology and volumes, and does not meet itself, when points are merged.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "common/geometry/self_intersection.h"
#include "common/mesh/disjoint_sets.h"
#include "common/parallel/bucket_sort.h"
#include "common/parallel/parallel_sort.h"
#include "simplify/mesh/bulk_merger.h"
#include "simplify/tuning/merging_tuning.h"
#include "simplify/tuning/tuning.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

using Grains = SimplifyTuning::Grains;
using Merging = MergingTuning;

/// An edge of a triangle of the new surface, from face `face` of the old one.
struct EdgeUse {
  Index end, opposite, face;
  auto operator<=>(const EdgeUse&) const = default;
};

}  // namespace

bool BulkMerger::clusters_are_contractible() {
  // Vertices minus edges plus triangles inside the cluster of each point. Clusters are connected, as each
  // point moves along an edge. An edge inside has a point that moves, so it has two triangles, which run
  // through it in opposite directions.
  std::vector<std::int32_t> characteristic(mesh_.point_slots(), 1);
  const auto count = [&](Index p, std::int32_t by) {
    // Relaxed: the sums are read after the loops.
    std::atomic_ref<std::int32_t>(characteristic[p]).fetch_add(by, std::memory_order_relaxed);
  };
  parallel_for(0, smooth_.size(), Grains::slots, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (const Index p = smooth_[i]; targets_[p] != p) count(targets_[p], 1);
  });
  parallel_for(0, faces_.size(), Grains::slots, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      const Triangle &ids = faces_[f].ids, to = image(ids);
      for (int k = 0; k < 3; ++k)
        if (to[k] == to[(k + 1) % 3] && ids[k] < ids[(k + 1) % 3]) count(to[k], -1);
      if (to[0] == to[1] && to[1] == to[2]) count(to[0], 1);
    }
  });
  const std::vector<Index> wrong = parallel_collect<Index>(
      0, smooth_.size(), Grains::slots, [&](std::size_t begin, std::size_t end, std::vector<Index>& out) {
        for (std::size_t i = begin; i < end; ++i)
          if (const Index p = smooth_[i]; targets_[p] != p && characteristic[targets_[p]] != 1)
            out.push_back(p);
      });
  for (const Index p : wrong) undo(p);
  return wrong.empty();
}

bool BulkMerger::edges_are_kept() {
  std::vector<Index> starts;
  std::vector<std::pair<Index, EdgeUse>> uses;  // with the smaller end
  bucket_sort(
      faces_.size(), mesh_.point_slots(),
      [&](std::size_t f, const auto& emit) {
        const Triangle to = image(faces_[f].ids);
        if (vanishes(to)) return;
        for (int k = 0; k < 3; ++k) {
          const auto [low, high] = std::minmax(to[k], to[(k + 1) % 3]);
          emit(low, std::pair(low, EdgeUse{high, to[(k + 2) % 3], static_cast<Index>(f)}));
        }
      },
      [](const auto& use) { return use.first; }, starts, uses);
  // The number of triangles at an edge between two points that were fixed.
  const auto triangles_before = [&](Index p, Index q) {
    const std::span<const Index> at_p = faces_at_[p];
    const auto count = std::count_if(at_p.begin(), at_p.end(), [&](Index code) {
      const Triangle& ids = faces_[code / 3].ids;
      return ids[0] == q || ids[1] == q || ids[2] == q;
    });
    return count == 0 ? 2 : count;
  };
  const std::vector<Index> wrong = parallel_collect<Index>(
      0, mesh_.point_slots(), Grains::slots,
      [&](std::size_t begin, std::size_t end, std::vector<Index>& out) {
        for (std::size_t p = begin; p < end; ++p) {
          const auto first = uses.begin() + starts[p], last = uses.begin() + starts[p + 1];
          std::sort(first, last);
          for (auto i = first; i != last;) {
            auto j = i + 1;
            bool distinct = true;
            for (; j != last && j->second.end == i->second.end; ++j)
              distinct &= j->second.opposite != (j - 1)->second.opposite;
            const bool fixed = kinds_[p] == Kind::fixed && kinds_[i->second.end] == Kind::fixed;
            const auto expected =
                fixed ? triangles_before(static_cast<Index>(p), i->second.end) : std::ptrdiff_t{2};
            if (!distinct || j - i != expected)
              for (auto k = i; k != j; ++k) out.push_back(k->second.face);
            i = j;
          }
        }
      });
  for (const Index f : wrong) undo_all(faces_[f].ids);
  return wrong.empty();
}

void BulkMerger::find_pieces() {
  DisjointSets sets(faces_.size());
  for (const Index p : smooth_)
    for (const Index code : faces_at_[p]) sets.unite(faces_at_[p].front() / 3, code / 3);
  pieces_.resize(faces_.size());
  for (Index f = 0; f < faces_.size(); ++f) pieces_[f] = sets.root(f);
}

bool BulkMerger::pieces_remain() {
  // A closed piece may collapse onto an edge: two discs and the ring of triangles between them.
  std::vector<std::uint8_t> remains(faces_.size(), 0);
  parallel_for(0, faces_.size(), Grains::slots, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f)
      // Relaxed: the flags are read after the loop.
      if (!vanishes(image(faces_[f].ids)))
        std::atomic_ref<std::uint8_t>(remains[pieces_[f]]).store(1, std::memory_order_relaxed);
  });
  const std::vector<Index> lost = parallel_collect<Index>(
      0, faces_.size(), Grains::slots, [&](std::size_t begin, std::size_t end, std::vector<Index>& out) {
        for (std::size_t f = begin; f < end; ++f)
          if (!remains[pieces_[f]]) out.push_back(static_cast<Index>(f));
      });
  for (const Index f : lost) undo_all(faces_[f].ids);
  return lost.empty();
}

bool BulkMerger::topology_is_kept() {
  return clusters_are_contractible() && edges_are_kept() && pieces_remain();
}

bool BulkMerger::volumes_are_kept() {
  // Six times the volumes before and after, as sums over the faces, in parts of fixed size.
  struct Volumes {
    std::vector<double> before, after;
  };
  const std::size_t regions = mesh_.region_count();
  std::vector<Volumes> parts((faces_.size() + Grains::slots - 1) / Grains::slots);
  parallel_for(0, faces_.size(), Grains::slots, [&](std::size_t begin, std::size_t end) {
    auto& [before, after] = parts[begin / Grains::slots];
    before.assign(regions, 0);
    after.assign(regions, 0);
    const auto below = [&](const Triangle& t) {
      return mesh_.position(t[0]).dot(mesh_.position(t[1]).cross(mesh_.position(t[2])));
    };
    for (std::size_t i = begin; i < end; ++i) {
      const InterfaceFace& f = faces_[i];
      const double was = below(f.ids), is = below(image(f.ids));
      before[f.inside] += was;
      after[f.inside] += is;
      if (f.across == outside_id) continue;
      before[f.across] -= was;
      after[f.across] -= is;
    }
  });
  std::vector<std::uint8_t> changed(regions, 0);
  for (std::size_t r = 0; r < regions; ++r) {
    double before = 0, after = 0;
    for (const Volumes& part : parts) {
      before += part.before[r];
      after += part.after[r];
    }
    changed[r] = std::fabs(after - before) > Merging::max_volume_change * std::fabs(before);
  }
  if (std::none_of(changed.begin(), changed.end(), [](std::uint8_t c) { return c != 0; })) return true;
  // Half of the points at a time, in the end all.
  const int pass = volume_passes_++;
  for (const InterfaceFace& f : faces_)
    if (changed[f.inside] || (f.across != outside_id && changed[f.across]))
      for (const Index p : f.ids)
        if (pass >= Merging::max_volume_passes || (keys_[p] >> pass & 1u) != 0) undo(p);
  return false;
}

bool BulkMerger::surface_is_embedded() {
  // Touching points have one number, as triangles that share a point may touch there.
  const std::vector<Index> from = parallel_collect<Index>(
      0, faces_.size(), Grains::slots, [&](std::size_t begin, std::size_t end, std::vector<Index>& out) {
        for (std::size_t f = begin; f < end; ++f)
          if (faces_[f].across == outside_id && !vanishes(image(faces_[f].ids)))
            out.push_back(static_cast<Index>(f));
      });
  std::vector<Triangle> triangles(from.size());
  parallel_for(0, from.size(), Grains::slots, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      triangles[i] = image(faces_[from[i]].ids);
      for (Index& p : triangles[i]) p = mesh_.original(p);
    }
  });
  const std::vector<std::pair<Index, Index>> pairs = self_intersections(mesh_.positions(), triangles);
  const auto stays = [&](Index triangle) {
    const Triangle& ids = faces_[from[triangle]].ids;
    return image(ids) == ids;
  };
  for (const auto& [f, g] : pairs) intersects_ |= stays(f) && stays(g);
  for (const auto& [f, g] : pairs) {
    undo_all(faces_[from[f]].ids);
    undo_all(faces_[from[g]].ids);
  }
  return pairs.empty();
}

}  // namespace tetwright
