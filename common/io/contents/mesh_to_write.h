// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/files/atomic_file.h"
#include "common/mesh/midside_nodes.h"
#include "common/tet_mesh.h"

namespace tetwright {

/// Input of a writer of tet meshes: a view that must not outlive the mesh and the nodes.
struct MeshToWrite {
  // NOLINTNEXTLINE(google-explicit-constructor): every mesh is something to write
  MeshToWrite(const TetMesh& of_mesh, const MidsideNodes* nodes = nullptr) : mesh(of_mesh), midside(nodes) {}

  const TetMesh& mesh;
  /// Midside nodes that make the tets second-order elements of ten nodes, for writers that support them;
  /// null: linear tets.
  const MidsideNodes* midside;

  /// Fields of the points and, if there are any, of the midside nodes.
  std::vector<MeshField> node_fields() const {
    return midside ? fields_of_nodes(mesh.point_fields, *midside) : mesh.point_fields;
  }

  std::size_t nodes() const { return mesh.points.size() + (midside ? midside->points.size() : 0); }
  const Vec3& node(std::size_t i) const {
    return i < mesh.points.size() ? mesh.points[i] : midside->points[i - mesh.points.size()];
  }
};

/// Writes one file named `path` with the bytes that `content` produces.
using FileWriter =
    std::function<void(const std::string& path, const std::function<void(const ByteSink&)>& content)>;

}  // namespace tetwright
