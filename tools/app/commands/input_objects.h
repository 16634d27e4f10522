// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <variant>
#include <vector>

#include "common/io/contents/dropped.h"
#include "common/io/contents/read_tet_mesh_result.h"
#include "common/io/tets/file_triangles.h"
#include "common/label_volume.h"
#include "common/tet_mesh.h"
#include "common/triangle_mesh.h"

namespace tetwright {

/// Edge lengths at the points of a tet mesh or a surface; each is finite and above 0 where an element uses
/// the point.
struct SizesObject {
  std::variant<TetMesh, TriangleMesh> elements;
  std::vector<double> lengths;  ///< input units
};

/// Inputs that a host program has in memory, by what stands for them in a CommandLine where a file's name
/// would: it names them in messages, and materials, whole. What is not among them is a file.
struct InputObjects {
  std::map<std::string, TriangleMesh> surfaces;
  /// As the reader of a file leaves them before it chooses the material.
  std::map<std::string, ReadTetMesh> meshes;
  std::map<std::string, FileTriangles> triangles;  ///< that the host lists beside the tets of `meshes`
  std::map<std::string, LabelVolume> volumes;
  std::map<std::string, SizesObject> sizes;  ///< of --size-field
  /// What the host's surfaces had beside points and triangles.
  std::map<std::string, std::vector<Dropped>> dropped;
};

}  // namespace tetwright
