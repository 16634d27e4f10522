// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <limits>
#include <vector>

#include "mesher/domain/grid_frame.h"
#include "mesher/domain/refinement_regions.h"
#include "mesher/labels/label_field.h"
#include "tetwright/mesher.h"
#include "tetwright/mesher_input.h"
#include "tetwright/progress.h"
#include "tetwright/surface_mesh.h"

namespace tetwright {

/// Surroundings of bodies. Lengths are in cells of the unrefined frame.
struct FilmOptions {
  double layer;       ///< thickness of the layer around bodies, see CarvedField; cells become no smaller
  double min_film;    ///< thinner films are left to that layer
  bool keep_outside;  ///< the outside is meshed, so that its films count
};

/// Films of labels beside bodies, input units.
struct LabelFilms {
  /// For films between a body and the border of the volume that are thinner than cells become.
  static constexpr int too_many_halvings = std::numeric_limits<int>::max();

  std::vector<RefinementRegion> finer;      ///< points along surfaces, interfaces and creases
  std::vector<RefinementRegion> on_bodies;  ///< points of bodies at films, with the halvings that these need
};

/// Finds films: where a body's outer side is less than a cell from a nearly parallel interface of labels, or
/// from the border of the volume. Cells must be halved there until one fits between them. The same holds
/// along creases that an interface follows within the layer, since a film ends there. Parallel over triangles
/// and creases.
/// \param patches of each body
/// \param labels unrefined
/// \param progress may be null
/// \throws Interrupted
LabelFilms find_films(const MesherInput& bodies, const std::vector<SurfacePatches>& patches,
                      const LabelField& labels, const FilmOptions& options, const Progress* progress);

/// The films for which cells are not small enough.
/// \param voxels the frame of the cells
/// \param finer all cells that are split
NarrowLabelsReport unresolved_films(const LabelFilms& films, const GridFrame& voxels,
                                    std::initializer_list<const RefinementRegions*> finer);

}  // namespace tetwright
