// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "tetwright/label_volume.h"
#include "tetwright/surface_mesh.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Names of the built-in samples.
/// - Surfaces around the origin, closed and oriented outwards: sphere, torus, cube, two_spheres, knot; and
///   open_sphere, a sphere with a hole; lead, an electrode that leads into the volume of organs.
/// - Five boxes that share faces: heater_left, heater_core and heater_right in a row, between the air
/// heater_below
///   and heater_above. The sides of each are groups, minX to maxZ.
/// - Tet meshes, all tets positive: tet_cube, two_materials (two halves of a box), layers (four materials on
///   top of each other); random_interior, random_interior_small and random_interior_large (a coarse skin
///   filled with 34,000, 1,000 and 200,000 tets between random points, two in five of them slivers and
///   similar).
/// - Volumes of gray values: bone (a shank in Hounsfield units: flesh around a bone, whose density rises
/// along
///   it, with marrow inside; blurred by a voxel, and some noise).
/// - Segmented volumes: organs (a body with a skin one voxel thick, a spine, two organs that touch, noise)
///   and foam (a cube filled with grains) in its default size; class Foam has others.
std::vector<std::string> sample_names();

using Sample = std::variant<TriangleMesh, TetMesh, LabelVolume>;

/// Makes a sample; its bits are the same on every machine.
/// \throws UsageError listing the names if the name is unknown
Sample make_sample(const std::string& name);

}  // namespace tetwright
