// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/sizes/size_source.h"
#include "common/tet_mesh.h"
#include "common/triangle_mesh.h"

namespace tetwright {

/// Edge lengths at the points of a mesh, linear in each tet. A position outside the tets by up to
/// tolerance::within_mesh of the diagonal (of the points that tets use) counts as the nearest point in them.
/// Inverted tets count as their mirror images. A query takes O(log tets). The tree is built in parallel, and
/// needs memory as TetTree does.
/// \param lengths one for each point, above 0 and finite where a tet uses the point; other points and their
///   lengths are ignored
/// \param field name of the lengths
/// \pre mesh in range, coordinates finite
std::unique_ptr<const SizeSource> tet_mesh_sizes(TetMesh mesh, std::vector<double> lengths,
                                                 std::string field = {});

/// Edge lengths at the points of a surface, linear in each triangle: everywhere that of the nearest point of
/// the surface. The choice among several equally near points is deterministic.
std::unique_ptr<const SizeSource> surface_sizes(TriangleMesh surface, std::vector<double> lengths,
                                                std::string field = {});

}  // namespace tetwright
