// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Disjoint sets of the numbers 0 to n - 1, merged step by step (union-find with path halving).
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n) : parent_(n) {
    for (Index i = 0; i < n; ++i) parent_[i] = i;
  }
  Index root(Index i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// Makes the smaller root the root of both, so that the result does not depend on the order of the calls.
  void unite(Index a, Index b) {
    a = root(a);
    b = root(b);
    if (a < b)
      parent_[b] = a;
    else
      parent_[a] = b;
  }
  bool is_root(Index i) const { return parent_[i] == i; }
  std::size_t size() const { return parent_.size(); }

 private:
  std::vector<Index> parent_;
};

}  // namespace tetwright
