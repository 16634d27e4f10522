// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tetwright/compare.h"
#include "tetwright/diagnostic.h"
#include "tetwright/mesh_quality.h"

namespace tetwright {

/// Results of `check` for a mesh.
struct CheckReport {
  std::vector<MeshFinding> findings;
  /// False if indices or coordinates are invalid; there are then no statistics and no topology.
  bool measurable = true;
  std::optional<Topology> topology, topology_before;             ///< of the mesh, and of the mesh of --before
  std::optional<std::vector<std::string>> topology_differences;  ///< from the mesh of --before, if given
  std::optional<SurfaceComparison> surface;                      ///< with --surface
  double tolerance = 0;                                          ///< input units; 0: none

  bool valid() const { return is_valid(findings); }
  bool within_tolerance() const { return tolerance == 0 || (surface && surface->upper() <= tolerance); }
  bool topology_kept() const { return !topology_differences || topology_differences->empty(); }
};

/// Findings and unmet requests as diagnostics.
std::vector<Diagnostic> diagnostics_of(const CheckReport& check);

}  // namespace tetwright
