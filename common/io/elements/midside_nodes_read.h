// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "common/io/contents/read_tet_mesh_result.h"

namespace tetwright {

/// The midside nodes of second-order elements in a file, which are read by their corners.
class MidsideNodesRead {
 public:
  /// To be called for each tet of ten nodes; `midside` are indices of points.
  void add_tet(std::span<const Index> midside) {
    ++tets_;
    nodes_.insert(nodes_.end(), midside.begin(), midside.end());
  }
  /// The same for each triangle of six. no_index is a node that the file does not have.
  void add_triangle(std::span<const Index> midside) {
    nodes_.insert(nodes_.end(), midside.begin(), midside.end());
  }

  /// Whether there are tets of ten nodes.
  bool any() const { return tets_ > 0; }

  /// Takes those that are no tet's corner out of the points and their fields, renumbers tets and `triangles`,
  /// and says so in `read.dropped`. To be called when all of them are there, but before interfaces are.
  void remove_from(ReadTetMesh& read, std::vector<Triangle>& triangles) const;

 private:
  std::size_t tets_ = 0;
  std::vector<Index> nodes_;
};

}  // namespace tetwright
