// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "common/samples/samples.h"
#include "tetwright/io.h"
#include "tetwright/mesher.h"

namespace tetwright {

/// The Stanford bunny of Debian's glmark2-data if that is installed, otherwise the built-in knot.
inline MesherInput benchmark_input() {
  const std::string bunny = "/usr/share/glmark2/models/bunny.obj";
  MaterialSurface s{"body", 1, {}, "knot"};
  if (std::filesystem::exists(bunny)) {
    s.surface = read_surface(bunny);
    s.file = bunny;
  } else {
    s.surface = std::get<TriangleMesh>(make_sample("knot"));
  }
  return make_mesher_input({s});
}

/// The dense mesh of benchmark_input(), created once for each resolution.
inline const TetMesh& benchmark_mesh(int resolution) {
  static std::map<int, TetMesh> meshes;
  const auto known = meshes.find(resolution);
  if (known != meshes.end()) return known->second;
  MesherOptions options;
  options.resolution = resolution;
  return meshes[resolution] = mesh_surfaces(benchmark_input(), options, nullptr).mesh;
}

}  // namespace tetwright
