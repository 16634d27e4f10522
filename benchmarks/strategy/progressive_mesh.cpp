// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "benchmarks/strategy/orderings.h"

namespace tetwright {

namespace {

struct Queued {
  WeighedCollapse collapse;
  std::uint32_t version;  ///< version of the origin when the weight was computed
};

/// Order for heaps of the standard library, whose top is the largest element.
bool later(const Queued& a, const Queued& b) {
  const WeighedCollapse &x = a.collapse, &y = b.collapse;
  return x.weight != y.weight   ? x.weight > y.weight
         : x.origin != y.origin ? x.origin > y.origin
                                : x.target > y.target;
}

class ProgressiveMesh {
 public:
  ProgressiveMesh(Workpiece& piece, bool eager)
      : piece_(piece),
        eager_(eager),
        task_(piece.mesh, piece.grid, ledger_),
        versions_(piece.mesh.point_slots(), 0) {}

  void run() {
    for (Index p = 0; p < piece_.mesh.point_slots(); ++p)
      if (piece_.alive(p)) weigh(p);
    heap_ = std::move(fresh_);
    fresh_.clear();
    std::make_heap(heap_.begin(), heap_.end(), later);
    drop_outdated_at_ = 2 * heap_.size() + 1024;
    while (!heap_.empty() && !piece_.reached()) {
      std::pop_heap(heap_.begin(), heap_.end(), later);
      const Queued next = heap_.back();
      heap_.pop_back();
      if (current(next)) take(next.collapse);
      if (heap_.size() > drop_outdated_at_) drop_outdated();
    }
  }

 private:
  bool current(const Queued& q) const {
    return versions_[q.collapse.origin] == q.version && piece_.alive(q.collapse.origin);
  }

  /// Computes the weights of the half-edges that begin at a point and stores them in fresh_.
  void weigh(Index p) {
    weighed_.clear();
    ++versions_[p];
    if (piece_.gather(task_, p)) {
      piece_.weigh(task_, weighed_);
      for (const WeighedCollapse& c : weighed_)
        if (!eager_ || piece_.propose(task_, c.target)) fresh_.push_back({c, versions_[p]});
    }
  }

  void take(const WeighedCollapse& c) {
    if (!piece_.gather(task_, c.origin) || !piece_.propose(task_, c.target))
      return;  // illegal until its star changes
    link_ = task_.star.points;
    piece_.carry_out(task_);
    for (const Index p : link_) weigh(p);
    for (const Queued& q : fresh_) {
      heap_.push_back(q);
      std::push_heap(heap_.begin(), heap_.end(), later);
    }
    fresh_.clear();
  }

  /// Removes outdated entries; otherwise memory would grow without bound.
  void drop_outdated() {
    std::erase_if(heap_, [&](const Queued& q) { return !current(q); });
    std::make_heap(heap_.begin(), heap_.end(), later);
    drop_outdated_at_ = 2 * heap_.size() + 1024;
  }

  Workpiece& piece_;
  bool eager_;
  VolumeLedger ledger_;  // without bounds, as in the paper
  Workspace task_;
  std::vector<std::uint32_t> versions_;  ///< by point; incremented when its half-edges get new weights
  std::vector<Queued> heap_, fresh_;
  std::size_t drop_outdated_at_ = 0;
  std::vector<WeighedCollapse> weighed_;
  std::vector<Index> link_;
};

}  // namespace

void progressive_mesh(Workpiece& piece, bool eager) { ProgressiveMesh(piece, eager).run(); }

}  // namespace tetwright
