// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesher/complex/labelled_complex.h"
#include "mesher/cut/sheet_faces.h"
#include "mesher/features/feature_surface.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Removes the strips of faces that a lattice leaves along curves in which four or more sheets meet: a cut
/// cell there joins two regions that only face each other across the curve. Edges across a strip are
/// collapsed onto the curve, as far as the mesh stays a mesh (link condition, Dey et al. 1999) and tets keep
/// a shape. What cannot be collapsed stays. `mesh.interfaces` are found anew.
/// \param cell size of the cells at the surface, input units
/// \param parts null, or those of the mesh: strips between parts of a region are collapsed, too
/// \pre the interfaces of the mesh have no patches yet, and those of sheets are not among them
void collapse_strips(TetMesh& mesh, const LabelledComplex& complex, const FeatureSurface& surface,
                     double cell, SheetParts* parts);

}  // namespace tetwright
