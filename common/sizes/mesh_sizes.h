// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/sizes/size_source.h"
#include "common/tet_mesh.h"
#include "common/triangle_mesh.h"

namespace tetwright {

/// Edge lengths at the points of a mesh, linear in each tet. A place outside of all tets by up to
/// tolerance::within_mesh of the diagonal (of the points that tets use) counts as the nearest place in them.
/// Inverted tets count as their mirror images.
///
/// `field` is the name of the lengths. `lengths` has one for each point, above 0 and finite where a tet uses
/// the point; other points and their lengths are of no use. The mesh must be in range, with finite
/// coordinates. A search takes O(log tets). The tree is built in parallel, and needs memory as TetTree does.
std::unique_ptr<const SizeSource> tet_mesh_sizes(TetMesh mesh, std::vector<double> lengths,
                                                 std::string field = {});

/// The same at the points of a surface: everywhere that of the nearest place of the surface, linear in each
/// triangle. Of several that are equally near the choice is always the same.
std::unique_ptr<const SizeSource> surface_sizes(TriangleMesh surface, std::vector<double> lengths,
                                                std::string field = {});

}  // namespace tetwright
