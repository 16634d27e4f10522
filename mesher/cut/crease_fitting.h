// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/tet_mesh.h"
#include "mesher/cut/feature_surface.h"
#include "mesher/distance/material_field.h"

namespace tetwright {

/// Gives the boundary faces of a dense mesh the patches of the surface that it was made of, and moves it onto
/// the surface so that edges follow the creases and points stand at the corners. `cell` is the size of the
/// cells there, input units; the mesh is within about one of the surface.
///
/// A mesh that was cut from a lattice chamfers creases: its points lie on either patch, and edges between
/// them cross the crease. Of each such edge the end nearer to the crease is moved there, or where that would
/// flatten a triangle the edge gets a point. (As isosurface stuffing does with lattice points, Labelle &
/// Shewchuk 2007, but on the boundary, so that convex and concave creases are alike.) Then all points go to
/// their corner, crease or patch as far as tets keep their shapes, and what is around makes room.
///
/// Points where three regions meet keep to the junction curves they are on, and so do points on the walls
/// that `field`, which the mesh was cut from, thickens, where shapes would suffer. Where faces came to
/// intersect points go back to where they were. The same result for any number of threads.
void fit_creases(TetMesh& mesh, const FeatureSurface& surface, const MaterialField& field, double cell);

}  // namespace tetwright
