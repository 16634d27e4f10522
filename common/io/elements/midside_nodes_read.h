// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "common/io/contents/read_tet_mesh_result.h"

namespace tetwright {

/// Midside nodes of second-order elements in a file, whose corners alone are used.
class MidsideNodesRead {
 public:
  /// Adds a tet of ten nodes; `midside` are indices of points.
  void add_tet(std::span<const Index> midside) {
    ++tets_;
    nodes_.insert(nodes_.end(), midside.begin(), midside.end());
  }
  /// Adds a triangle of six nodes; no_index is a node that the file does not have.
  void add_triangle(std::span<const Index> midside) {
    nodes_.insert(nodes_.end(), midside.begin(), midside.end());
  }

  /// Whether there are tets of ten nodes.
  bool any() const { return tets_ > 0; }

  /// Removes the midside nodes that are no tet's corner from the points and their fields, renumbers tets and
  /// `triangles`, and reports it in `read.dropped`.
  /// \pre all tets and triangles are added, and `read.mesh.interfaces` is still empty
  void remove_from(ReadTetMesh& read, std::vector<Triangle>& triangles) const;

 private:
  std::size_t tets_ = 0;
  std::vector<Index> nodes_;
};

}  // namespace tetwright
