// SPDX-License-Identifier: Apache-2.0
#include "simplify/mesh/bulk_merger.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <utility>

#include "common/geometry/predicates.h"
#include "common/parallel/bucket_sort.h"
#include "common/parallel/parallel_sort.h"
#include "common/random.h"
#include "simplify/mesh/mesh_builder.h"
#include "simplify/tuning/merging_tuning.h"
#include "simplify/tuning/tuning.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

using Grains = SimplifyTuning::Grains;
using Merging = MergingTuning;

}  // namespace

void BulkMerger::list_faces() {
  faces_ = mesh_.interface_faces();
  parallel_for(0, faces_.size(), Grains::slots, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (InterfaceFace& f = faces_[i]; f.across < f.inside) {
        // Orient the faces between two regions alike; outside_id is the largest.
        std::swap(f.inside, f.across);
        std::swap(f.ids[1], f.ids[2]);
      }
  });
  bucket_sort(
      faces_.size(), mesh_.point_slots(),
      [&](std::size_t f, const auto& emit) {
        for (std::size_t k = 0; k < 3; ++k) emit(faces_[f].ids[k], static_cast<Index>(3 * f + k));
      },
      [&](Index code) { return faces_[code / 3].ids[code % 3]; }, faces_at_.starts, faces_at_.items);
}

bool BulkMerger::is_smooth(Index p) const {
  const std::span<const Index> uses = faces_at_[p];
  const InterfaceFace& first = faces_[uses[0] / 3];
  if (first.is_sheet()) return false;
  Vec3 sum = Vec3::Zero();
  for (const Index code : uses) {
    const InterfaceFace& f = faces_[code / 3];
    if (f.inside != first.inside || f.across != first.across || f.patch != first.patch) return false;
    sum += normal(f.ids);
  }
  // One cycle of triangles around the point, each in the direction of the mean normal.
  const Index start = first.ids[(uses[0] % 3 + 1) % 3];
  Index at = start;
  for (std::size_t i = 0; i < uses.size(); ++i) {
    if (i > 0 && at == start) return false;
    const auto next = std::find_if(
        uses.begin(), uses.end(), [&](Index code) { return faces_[code / 3].ids[(code % 3 + 1) % 3] == at; });
    if (next == uses.end()) return false;
    const Triangle& ids = faces_[*next / 3].ids;
    const Vec3 n = normal(ids);
    if (n.dot(sum) < options_.min_smooth_cosine * n.norm() * sum.norm()) return false;
    at = ids[(*next % 3 + 2) % 3];
  }
  return at == start;
}

void BulkMerger::classify_points() {
  kinds_.assign(mesh_.point_slots(), Kind::fixed);
  const auto collect = [&](const auto& accepts) {
    return parallel_collect<Index>(
        0, mesh_.point_slots(), Grains::slots,
        [&](std::size_t begin, std::size_t end, std::vector<Index>& out) {
          for (std::size_t i = begin; i < end; ++i) {
            const auto p = static_cast<Index>(i);
            if (mesh_.incident_tet(p) != no_index && !mesh_.frozen(p) && accepts(p)) out.push_back(p);
          }
        });
  };
  inner_ = collect([&](Index p) { return !on_surface(p); });
  smooth_ = collect([&](Index p) { return on_surface(p) && is_smooth(p); });
}

void BulkMerger::list_stars() {
  std::vector<std::uint8_t> listed(mesh_.point_slots(), 0);
  for (const std::vector<Index>* const points : {&smooth_, &inner_})
    for (const Index p : *points) listed[p] = 1;
  bucket_sort(
      mesh_.tet_slots(), mesh_.point_slots(),
      [&](std::size_t t, const auto& emit) {
        const Tet& ids = mesh_.points(static_cast<Index>(t));
        for (std::size_t k = 0; k < 4; ++k)
          if (listed[ids[k]]) emit(ids[k], static_cast<Index>(4 * t + k));
      },
      [&](Index code) { return mesh_.points(code / 4)[code % 4]; }, tets_at_.starts, tets_at_.items);
  parallel_for(0, tets_at_.items.size(), Grains::slots, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) tets_at_.items[i] /= 4;
  });
}

template <class F>
bool BulkMerger::for_each_neighbour(Index p, const F& f) const {
  if (on_surface(p)) {
    for (const Index code : faces_at_[p])
      for (const Index q : faces_[code / 3].ids)
        if (q != p && !f(q)) return false;
  } else {
    for (const Index t : tets_at_[p])
      for (const Index q : mesh_.points(t))
        if (q != p && !f(q)) return false;
  }
  return true;
}

void BulkMerger::merge(const std::vector<Index>& points) {
  for (const Index p : points) kinds_[p] = Kind::undecided;
  // Rounds: an undecided point whose key is above those of all undecided neighbours is kept, and its
  // neighbours are merged (Luby 1986). The result is that of one pass in descending order of the keys.
  std::vector<Index> undecided = points;
  while (!undecided.empty()) {
    const std::vector<Index> kept = parallel_collect<Index>(
        0, undecided.size(), Grains::slots, [&](std::size_t begin, std::size_t end, std::vector<Index>& out) {
          for (std::size_t i = begin; i < end; ++i) {
            const Index p = undecided[i];
            if (for_each_neighbour(p, [&](Index q) {
                  return kinds_[q] != Kind::undecided || keys_[q] < keys_[p] ||
                         (keys_[q] == keys_[p] && q < p);
                }))
              out.push_back(p);
          }
        });
    parallel_for(0, kept.size(), Grains::slots, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        kinds_[kept[i]] = Kind::kept;
        for_each_neighbour(kept[i], [&](Index q) {
          // Relaxed: two points may merge the same neighbour; the value is read after the loop.
          const std::atomic_ref<Kind> kind(kinds_[q]);
          if (kind.load(std::memory_order_relaxed) == Kind::undecided)
            kind.store(Kind::merged, std::memory_order_relaxed);
          return true;
        });
      }
    });
    std::erase_if(undecided, [&](Index p) { return kinds_[p] != Kind::undecided; });
  }
  parallel_for(0, points.size(), Grains::slots, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (const Index p = points[i]; kinds_[p] == Kind::merged) targets_[p] = next_target(p, p);
  });
}

Index BulkMerger::next_target(Index p, Index last) const {
  const Vec3& at = mesh_.position(p);
  using Place = std::pair<double, Index>;  // squared distance, point
  const Place after = last == p ? Place(0, p) : Place((mesh_.position(last) - at).squaredNorm(), last);
  Place best(max_squared_, no_index);
  for_each_neighbour(p, [&](Index q) {
    if (kinds_[q] != Kind::kept && kinds_[q] != Kind::fixed) return true;
    const Place place((mesh_.position(q) - at).squaredNorm(), q);
    if (place < best && (last == p || after < place)) best = place;
    return true;
  });
  return best.second == no_index ? p : best.second;
}

template <std::size_t n>
Index BulkMerger::moved_farthest(const std::array<Index, n>& ids) const {
  std::pair<double, Index> farthest(-1, no_index);
  for (const Index p : ids)
    if (targets_[p] != p)
      farthest = std::max(farthest, {(mesh_.position(targets_[p]) - mesh_.position(p)).squaredNorm(), p});
  return farthest.second;
}

bool BulkMerger::is_bad(const Triangle& face) const {
  const Triangle to = image(face);
  if (to == face || vanishes(to)) return false;
  const Vec3 before = normal(face), after = normal(to);
  double longest_squared = 0;
  for (int k = 0; k < 3; ++k)
    longest_squared =
        std::max(longest_squared, (mesh_.position(to[k]) - mesh_.position(to[(k + 1) % 3])).squaredNorm());
  const double size = after.norm();
  if (size < options_.min_face_shape * longest_squared || longest_squared > max_squared_ ||
      before.dot(after) < options_.min_turn_cosine * before.norm() * size)
    return true;
  for (int k = 0; k < 3; ++k)
    if (std::fabs((mesh_.position(face[k]) - mesh_.position(to[0])).dot(after)) >
        options_.max_deviation * size)
      return true;
  return false;
}

bool BulkMerger::is_bad(const Tet& tet) const {
  const Tet to = image(tet);
  if (to == tet || vanishes(to)) return false;
  double longest_squared = 0;
  for (const auto& [k, l] : tet_edges)
    longest_squared =
        std::max(longest_squared, (mesh_.position(to[k]) - mesh_.position(to[l])).squaredNorm());
  const double det = orient3d_value(mesh_.position(to[0]), mesh_.position(to[1]), mesh_.position(to[2]),
                                    mesh_.position(to[3]));
  return det <= Merging::min_tet_shape * longest_squared * std::sqrt(longest_squared);
}

void BulkMerger::undo(Index p) {
  if (targets_[p] == p) return;
  targets_[p] = p;
  kinds_[p] = Kind::kept;
  if (on_surface(p)) changed_.push_back(p);
}

void BulkMerger::move_elsewhere(std::vector<Index>& points) {
  if (progress_) progress_->throw_if_stopped();
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  std::vector<Index> targets(points.size());
  parallel_for(0, points.size(), Grains::samples, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Index p = points[i];
      targets[i] = changes_[p] == Merging::max_changes ? p : next_target(p, targets_[p]);
    }
  });
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Index p = points[i];
    ++changes_[p];
    if (targets[i] == p) {
      undo(p);
      continue;
    }
    targets_[p] = targets[i];
    if (on_surface(p)) changed_.push_back(p);
  }
}

void BulkMerger::repair_faces() {
  std::vector<Index> changed;
  do {
    changed = parallel_collect<Index>(0, faces_.size(), Grains::slots,
                                      [&](std::size_t begin, std::size_t end, std::vector<Index>& out) {
                                        for (std::size_t f = begin; f < end; ++f)
                                          if (is_bad(faces_[f].ids))
                                            out.push_back(moved_farthest(faces_[f].ids));
                                      });
    move_elsewhere(changed);
  } while (!changed.empty());
}

void BulkMerger::repair_tets(const std::optional<std::vector<Index>>& points) {
  const auto list = [&](Index t, std::vector<Index>& out) {
    if (!mesh_.dead(t) && is_bad(mesh_.points(t))) out.push_back(moved_farthest(mesh_.points(t)));
  };
  const auto at_points = [&](const std::vector<Index>& some) {
    return parallel_collect<Index>(0, some.size(), Grains::samples,
                                   [&](std::size_t begin, std::size_t end, std::vector<Index>& out) {
                                     for (std::size_t i = begin; i < end; ++i)
                                       for (const Index t : tets_at_[some[i]]) list(t, out);
                                   });
  };
  std::vector<Index> changed =
      points ? at_points(*points)
             : parallel_collect<Index>(0, mesh_.tet_slots(), Grains::slots,
                                       [&](std::size_t begin, std::size_t end, std::vector<Index>& out) {
                                         for (std::size_t t = begin; t < end; ++t)
                                           list(static_cast<Index>(t), out);
                                       });
  while (!changed.empty()) {
    const auto of_surface =
        std::partition(changed.begin(), changed.end(), [&](Index p) { return !on_surface(p); });
    for (auto p = of_surface; p != changed.end(); ++p) undo(*p);
    std::vector<Index> inner(changed.begin(), of_surface);
    move_elsewhere(inner);
    inner.insert(inner.end(), of_surface, changed.end());
    changed = at_points(inner);
  }
}

bool BulkMerger::run() {
  if (!mesh_.all_positive()) return false;
  targets_.resize(mesh_.point_slots());
  std::iota(targets_.begin(), targets_.end(), Index{0});
  changes_.assign(mesh_.point_slots(), 0);
  keys_.resize(mesh_.point_slots());
  parallel_for(0, keys_.size(), Grains::slots, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      keys_[p] = static_cast<std::uint32_t>(Random(options_.seed, p, 0).next());
  });
  list_faces();
  classify_points();
  find_pieces();
  list_stars();
  merge(smooth_);
  do repair_faces();
  while (!topology_is_kept() || !volumes_are_kept());
  merge(inner_);
  changed_.clear();
  repair_tets({});
  // Each pass undoes moves of surface points, so this ends.
  do {
    while (!changed_.empty()) {
      do repair_faces();
      while (!topology_is_kept() || !volumes_are_kept());
      std::vector<Index> changed;
      changed.swap(changed_);
      repair_tets(std::move(changed));
    }
  } while (!surface_is_embedded() && !intersects_);
  return !intersects_;
}

void BulkMerger::tets(std::vector<Tet>& tets, std::vector<RegionId>& regions) const {
  const std::vector<Index> remaining = parallel_collect<Index>(
      0, mesh_.tet_slots(), Grains::slots, [&](std::size_t begin, std::size_t end, std::vector<Index>& out) {
        for (std::size_t i = begin; i < end; ++i)
          if (const auto t = static_cast<Index>(i); !mesh_.dead(t) && !vanishes(image(mesh_.points(t))))
            out.push_back(t);
      });
  tets.resize(remaining.size());
  regions.resize(remaining.size());
  parallel_for(0, remaining.size(), Grains::slots, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      tets[i] = image(mesh_.points(remaining[i]));
      regions[i] = mesh_.region(remaining[i]);
    }
  });
}

std::vector<InterfaceFace> BulkMerger::faces() const {
  return parallel_collect<InterfaceFace>(
      0, faces_.size(), Grains::slots,
      [&](std::size_t begin, std::size_t end, std::vector<InterfaceFace>& out) {
        for (std::size_t i = begin; i < end; ++i) {
          InterfaceFace f = faces_[i];
          f.ids = image(f.ids);
          if (!vanishes(f.ids)) out.push_back(f);
        }
      });
}

bool merge_points(EditableMesh& mesh, const PointMerging& options, const Progress* progress) {
  std::vector<Tet> tets;
  std::vector<RegionId> regions;
  std::vector<InterfaceFace> faces;
  {
    BulkMerger merger(mesh, options, progress);
    if (!merger.run()) return false;
    merger.tets(tets, regions);
    faces = merger.faces();
  }
  MeshBuilder(mesh, "mesh").replace_tets(std::move(tets), std::move(regions), faces);
  return true;
}

}  // namespace tetwright
