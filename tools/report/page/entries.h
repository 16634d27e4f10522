// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tetwright/prepare.h"
#include "tetwright/tet_mesh.h"
#include "tools/compare/check_report.h"

namespace tetwright {

/// An entry of a list on the page, shown in the mesh if it has locations.
struct PageEntry {
  std::string text;                      ///< what it is
  std::string detail;                    ///< what was done about it, or a remedy; may be empty
  std::vector<Vec3> places;              ///< input units
  const DiagnosticKind* kind = nullptr;  ///< null: no diagnostic
};

struct PageEntries {
  std::vector<PageEntry> short_of;  ///< unmet requests
  std::vector<PageEntry> found;     ///< findings in the input, and other notes
  std::vector<PageEntry> worst;     ///< the worst shapes of the mesh
};

/// Collects the entries of a run's report. `check` adds its findings in the mesh; null for other commands.
/// Parallel; the result does not depend on the number of threads.
PageEntries page_entries(const PrepareReport& run, const TetMesh& mesh, const CheckReport* check);

}  // namespace tetwright
