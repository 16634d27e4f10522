#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <vector>

#include "simplify/mesh/editable_mesh.h"
#include "simplify/mesh/star.h"

namespace tetwright {

/// Keeps the volume of every region within a share of what it was. Error(op) bounds what one operation may do
/// and lets many small losses add up: a simplified ball lies inside the ball.
class VolumeLedger {
 public:
  /// From the volumes as they are; while no task runs.
  void open(const EditableMesh& mesh, double share) {
    allowed_.assign(mesh.region_count(), 0);
    net_ = std::vector<std::atomic<double>>(mesh.region_count());
    for (Index t = 0; t < mesh.tet_slots(); ++t) {
      const TetRecord& r = mesh.tet(t);
      if (r.points[0] != no_index) allowed_[r.region] += share * mesh.signed_volume(t);
    }
    for (double& a : allowed_) a = std::fabs(a);
  }

  /// Books the changes and returns true, unless one takes a volume out of its bounds or farther out of them.
  /// Safe concurrently; concurrent bookings may together exceed the bounds by the sum of their changes.
  template <class Changes>
  bool book(const Changes& changes) {
    for (const VolumeChange& c : changes) {
      if (c.region == outside_id || allowed_.empty()) continue;
      // Relaxed here and below: the numbers carry no other data.
      const double now = net_[c.region].load(std::memory_order_relaxed), then = now + c.volume;
      if (std::fabs(then) > allowed_[c.region] && std::fabs(then) > std::fabs(now)) return false;
    }
    add(changes, 1);
    return true;
  }
  /// Takes back what book() did, where the operation failed after it.
  template <class Changes>
  void take_back(const Changes& changes) {
    add(changes, -1);
  }

  /// How much of its bounds the worst region has used: 1 is all. Only while no task runs.
  double strain() const {
    double largest = 0;
    for (std::size_t r = 0; r < allowed_.size(); ++r)
      if (allowed_[r] > 0)
        largest = std::max(largest, std::fabs(net_[r].load(std::memory_order_relaxed)) / allowed_[r]);
    return largest;
  }

 private:
  template <class Changes>
  void add(const Changes& changes, double sign) {
    for (const VolumeChange& c : changes)
      if (c.region != outside_id && !allowed_.empty())
        net_[c.region].fetch_add(sign * c.volume, std::memory_order_relaxed);
  }

  std::vector<double> allowed_;  ///< by region; empty: no bounds
  std::vector<std::atomic<double>> net_;
};

}  // namespace tetwright
