// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>

#include "tetwright/mesh_quality.h"

namespace tetwright {

/// Smallest, largest and histogram of the dihedral angles of many tets. The first two are exactly as
/// dihedral_angles() gives them; angles that reach the end of a bin but for rounding are in the next one.
/// Nearly all angles are only compared by their cosines, since arc tangents take most of the time.
/// Different objects may be used concurrently.
class DihedralCounter {
 public:
  /// Adds the six angles of a tet, leaving out undefined ones.
  void add(const std::array<Vec3, 4>& tet);
  /// Adds the angles of another counter.
  void add(const DihedralCounter& other);

  double min() const { return min_; }  ///< degrees; infinite without angles
  double max() const { return max_; }  ///< degrees; -infinite without angles
  const DihedralHistogram& histogram() const { return histogram_; }

 private:
  void add_exact(double degrees);

  double min_ = std::numeric_limits<double>::infinity(), max_ = -min_;
  /// Approximate cosines of min_ and max_; before the first angle, values that every cosine exceeds.
  double min_cosine_ = -2, max_cosine_ = 2;
  DihedralHistogram histogram_;
};

}  // namespace tetwright
