// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/io/contents/mesh_to_write.h"
#include "common/io/names/mesh_parts.h"

namespace tetwright {

/// What write_febio() makes of names.
NameRules febio_names();

/// The geometry of a model of FEBio, febio_spec 4.0: nodes, an Elements section (tet4 or tet10) for each
/// material, and a Surface (tri3 or tri6, normals out of the smaller tag) and a NodeSet of the same name for
/// each surface of the mesh, if it has interfaces. Names are the materials' own, with ' for ". A SolidDomain
/// gives each Elements section the material of the same name, which is the user's to add; so are steps and
/// loads. The format has no place for the fields of a mesh.
void write_febio(const MeshToWrite& written, const ByteSink& sink);

}  // namespace tetwright
