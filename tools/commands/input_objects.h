#pragma once

#include <map>
#include <string>

#include "common/label_volume.h"
#include "common/tet_mesh.h"
#include "common/triangle_mesh.h"

namespace tetwright {

/// Inputs that a host program has in memory, by what stands for them in a CommandLine where a file's name
/// would: it names them in messages, and materials. What is not among them is a file.
struct InputObjects {
  std::map<std::string, TriangleMesh> surfaces;
  std::map<std::string, TetMesh> meshes;
  std::map<std::string, LabelVolume> volumes;
};

}  // namespace tetwright
