// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/types.h"
#include "tools/prepare/run_report.h"

namespace tetwright {

/// Something that the page lists, and shows in the mesh where its places are known.
struct PageEntry {
  std::string text;          ///< what it is
  std::string detail;        ///< what was done about it, or held it back; may be empty
  std::vector<Vec3> places;  ///< input units
};

struct PageEntries {
  std::vector<PageEntry> short_of;  ///< what was asked and not reached
  std::vector<PageEntry> found;     ///< in the input, and other notes
  std::vector<PageEntry> worst;     ///< the worst shapes of the mesh
};

/// What a run reports; of `check` with what it found in the mesh. Parallel; the result does not depend on the
/// threads.
PageEntries page_entries(const RunReport& run, const TetMesh& mesh, const CheckReport* check);

}  // namespace tetwright
