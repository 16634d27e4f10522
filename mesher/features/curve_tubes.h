// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesher/complex/labelled_complex.h"
#include "mesher/cut/sheet_faces.h"
#include "mesher/features/feature_surface.h"
#include "tetwright/mesher.h"
#include "tetwright/progress.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Meshes a tube around each curve in which four or more sheets meet anew, so that it is a chain of edges of
/// the mesh at which exactly the sectors of the complex meet. The lattice has no points on such a curve, so
/// that its cells join sectors that only face each other across it; a little away from it they do not.
///
/// The tets of the tube are replaced by those that join its outer faces to the chain: each outer point is
/// mapped to a vertex of the chain so that faces go to vertices or edges, and the mapping's cylinder is
/// divided into tets (Hatcher 2002, section 2.C, on simplicial mapping cylinders), which inherit the labels
/// of the faces. The tube grows where its faces are not visible from the chain, or the sectors are not bands
/// on it. Where that does not end within a few cells, the mesh stays as it is there. `mesh.interfaces` are
/// found anew. Serial. \param cell size of the cells at the surface, input units \param parts null, or those
/// of the mesh \param progress may be null \throws Interrupted, OutOfTime \pre the interfaces of the mesh
/// have no patches yet, and those of sheets are not among them \return the faces that join what only meets in
/// a curve and are left
StripReport remesh_curve_tubes(TetMesh& mesh, const LabelledComplex& complex, const FeatureSurface& surface,
                               double cell, SheetParts* parts, Progress* progress);

}  // namespace tetwright
