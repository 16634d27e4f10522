// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/mesher/label_volumes.h"
#include "tetwright/mesh_quality.h"

namespace tetwright {

inline MesherOptions cells_of(double cell, double adaptivity = MesherOptions().adaptivity) {
  MesherOptions options;
  options.voxel_size = cell;
  options.adaptivity = adaptivity;
  return options;
}

/// Meshes a volume and checks the invariants that hold for every mesh.
inline DenseMesh checked_mesh(const LabelInput& labels, const MesherOptions& options) {
  DenseMesh meshed = mesh_labels(labels, options, nullptr);
  for (const MeshFinding& f : check_mesh(meshed.mesh)) ADD_FAILURE() << mesh_finding_line(f);
  std::vector<InterfaceTriangle> without_patches = meshed.mesh.interfaces;
  for (InterfaceTriangle& t : without_patches) t.patch = 0;
  EXPECT_TRUE(without_patches == find_interfaces(meshed.mesh));
  for (const LabelMaterial& m : labels.materials) {
    EXPECT_GT(std::count(meshed.mesh.materials.begin(), meshed.mesh.materials.end(), m.tag), 0) << m.tag;
    EXPECT_EQ(meshed.mesh.material_names.at(m.tag), m.name);
  }
  return meshed;
}
inline DenseMesh checked_mesh(const LabelInput& labels, double cell) {
  return checked_mesh(labels, cells_of(cell));
}

inline std::string text(const TetMesh& mesh) {
  std::string all;
  for (const std::string& line : topology_lines(topology(mesh))) all += line + "\n";
  return all;
}

inline void expect_line(const TetMesh& mesh, const std::string& line) {
  EXPECT_NE(text(mesh).find(line + "\n"), std::string::npos) << line << "\nnot in\n" << text(mesh);
}

inline double length(double x, double y, double z) { return std::sqrt(x * x + y * y + z * z); }

inline const std::string disc = "components 1, euler 1, boundary components 1, boundary euler 2";

}  // namespace tetwright
