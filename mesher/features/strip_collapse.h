// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesher/complex/labelled_complex.h"
#include "mesher/cut/sheet_faces.h"
#include "mesher/features/feature_surface.h"
#include "tetwright/progress.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Removes the strips of faces that a lattice leaves along curves in which four or more sheets meet: a cut
/// cell there joins two regions that only face each other across the curve. Edges across a strip are
/// collapsed, then all edges of its faces, then while inner points around them make room; as far
/// as the mesh stays a mesh (link condition, Dey et al. 1999: a few edges in the way are split, also where
/// the collapse then fails) and tets keep a shape. What cannot be collapsed stays. Points end up near the
/// curve; fit_creases() moves them onto it. `mesh.interfaces` are found anew. Serial. \param cell size of the
/// cells at the surface, input units \param progress may be null \param parts null, or those of the mesh:
/// strips between parts of a region are collapsed, too \throws Interrupted, OutOfTime \pre the interfaces of
/// the mesh have no patches yet, and those of sheets are not among them
void collapse_strips(TetMesh& mesh, const LabelledComplex& complex, const FeatureSurface& surface,
                     double cell, SheetParts* parts, Progress* progress);

}  // namespace tetwright
