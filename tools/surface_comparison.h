#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/geometry/surface_deviation.h"
#include "common/tet_mesh.h"
#include "common/triangle_mesh.h"
#include "tools/crease_fidelity.h"
#include "tools/fidelity.h"

namespace tetwright {

/// A mesh beside the surfaces that it should have. Input units.
struct SurfaceComparison {
  double diagonal = 0;  ///< of the surfaces' bounding box
  SurfaceDeviation from_mesh, from_surfaces;
  /// Of one closed surface: volume, components, handles and cavities beside those of the mesh's boundary.
  std::optional<MaterialFidelity> solid;
  std::optional<CreaseFidelity> creases;  ///< where the surfaces have any

  /// What is proven: no point of one is farther from the other than this, no place of a crease of the
  /// surfaces from the mesh's creases, no corner of them from the mesh.
  double upper() const;
};

/// Compares the boundary of the mesh, and its interfaces too if there are several surfaces, with all of them
/// together, whatever the mesh was made from. `names` are those of the surfaces, for messages. The mesh has
/// its interfaces; where the surfaces have creases they get their patches. Throws InputError as
/// find_patches() does.
SurfaceComparison compare_with_surfaces(TetMesh& mesh, const std::vector<TriangleMesh>& surfaces,
                                        const std::vector<std::string>& names);

/// The lines that `check` prints, without their ends.
std::vector<std::string> comparison_lines(const SurfaceComparison& comparison);

}  // namespace tetwright
