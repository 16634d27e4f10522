// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <vector>

#include "simplify/mesh/editable_mesh.h"
#include "simplify/mesh/star.h"

namespace tetwright {

/// Sum of the signed volumes of each region's tets; working coordinates cubed. Parallel.
/// \pre No task runs.
std::vector<double> region_volumes(const EditableMesh& mesh);

/// Keeps the volume of every region within a fraction of its initial value. Error(op) only bounds single
/// operations, and many small losses add up: a simplified ball lies inside the original.
class VolumeLedger {
 public:
  /// Bounds the changes to the fraction `share` of the initial volumes.
  ///
  /// \param initial by material, input units cubed; null: the current volumes.
  /// \pre No task runs.
  void open(const EditableMesh& mesh, double share, const std::map<MaterialTag, double>* initial = nullptr);

  /// Whether every change keeps its region within the bounds, or brings it nearer to them. Safe concurrently
  /// while no thread commits.
  template <class Changes>
  bool allows(const Changes& changes) const {
    for (const VolumeChange& c : changes) {
      if (c.region == outside_id || allowed_.empty()) continue;
      const double now = net_[c.region], then = now + c.volume;
      if (std::fabs(then) > allowed_[c.region] && std::fabs(then) > std::fabs(now)) return false;
    }
    return true;
  }
  /// Adds the changes. One thread at a time.
  template <class Changes>
  void commit(const Changes& changes) {
    for (const VolumeChange& c : changes)
      if (c.region != outside_id && !allowed_.empty()) net_[c.region] += c.volume;
  }

  /// Max over the regions of the change as a fraction of its bound.
  /// \pre No task runs.
  double utilization() const {
    double largest = 0;
    for (std::size_t r = 0; r < allowed_.size(); ++r)
      largest = std::max(largest, utilization(static_cast<RegionId>(r)));
    return largest;
  }
  /// The change of one region as a fraction of its bound; 0 for the outside, and without bounds.
  /// \pre No task runs.
  double utilization(RegionId region) const {
    return region < allowed_.size() && allowed_[region] > 0 ? std::fabs(net_[region]) / allowed_[region] : 0;
  }

 private:
  std::vector<double> allowed_;  ///< max change, by region; empty: no bounds
  std::vector<double> net_;
};

}  // namespace tetwright
