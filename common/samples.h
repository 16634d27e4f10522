#pragma once

#include <string>
#include <variant>
#include <vector>

#include "common/formats/formats.h"

namespace tetwright {

/// The built-in samples. Surfaces about the origin, all closed and outward but open_sphere: sphere, torus,
/// cube, two_spheres, knot, open_sphere (a sphere with a hole). Tet meshes, all positive: tet_cube,
/// two_materials (two halves of a box), layers (four materials on top of each other). A volume of labels:
/// organs (a body with a skin one voxel thick, a spine and two organs that touch, and noise).
std::vector<std::string> sample_names();

/// surface, tet_mesh or volume. Throws UsageError, which lists the names, for an unknown one.
FileKind sample_kind(const std::string& name);

/// The sample itself, the same bits on every machine. Throws UsageError for an unknown name.
std::variant<TriangleMesh, TetMesh, LabelVolume> make_sample(const std::string& name);

/// Writes a sample. Throws UsageError if the name is unknown or the extension does not fit its kind,
/// OutputError if it can't be written.
void write_sample(const std::string& name, const std::string& path);

}  // namespace tetwright
