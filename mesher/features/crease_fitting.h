// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesher/domain/material_field.h"
#include "mesher/features/feature_surface.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Assigns the boundary faces of a dense mesh the patches of its input surface, and moves the mesh onto that
/// surface so that edges follow creases and vertices lie at corners.
///
/// A mesh cut from a lattice chamfers creases: its points lie on one patch or the other, and edges between
/// them cross the crease. The end of such an edge nearer to the crease is moved onto it, or the edge is split
/// where that would flatten a triangle. (Isosurface stuffing, Labelle & Shewchuk 2007, does so with lattice
/// points; doing it on the boundary treats convex and concave creases alike.) Then every vertex moves to its
/// corner, crease or patch as far as tet quality permits, and the vertices around it make room.
///
/// Vertices where three regions meet stay on their junction curves. Vertices on walls that `field` thickens
/// stay if moving them would spoil tets. If faces intersect afterwards, their vertices return to their
/// previous positions. The result does not depend on the number of threads.
/// \param mesh within about one cell of the surface
/// \param field the mesh was cut from it
/// \param cell size of the cells at the surface, input units
void fit_creases(TetMesh& mesh, const FeatureSurface& surface, const MaterialField& field, double cell);

}  // namespace tetwright
