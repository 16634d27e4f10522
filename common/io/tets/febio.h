// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/io/names/mesh_parts.h"
#include "tetwright/io.h"

namespace tetwright {

/// Constraints on names in write_febio().
NameRules febio_names();

/// Writes the geometry of an FEBio model, febio_spec 4.0: nodes, an Elements section (tet4 or tet10) for each
/// material, and for each surface of a mesh with interfaces a Surface (tri3 or tri6, normals pointing out of
/// the smaller tag) and a NodeSet of the same name. Names are those of the materials, with ' for ". A
/// SolidDomain assigns each Elements section the material of the same name; the user adds materials, steps
/// and loads. The format has no fields of a mesh.
void write_febio(const MeshToWrite& written, const ByteSink& sink);

}  // namespace tetwright
