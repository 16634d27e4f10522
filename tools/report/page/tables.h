// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tools/prepare/run_report.h"
#include "tools/report/page/charts.h"
#include "tools/report/page/entries.h"

namespace tetwright {

/// The figures of each mesh side by side; `threshold` is the solid angle that the statistics were made with.
std::string figures_table(std::span<const ChartMesh> meshes, double threshold);

/// The materials of the result, with their tets and volumes.
std::string materials_table(const RunReport& run);

/// The list, with a button for each place; `first_mark` is the number of the first of them and becomes that
/// of the next list.
std::string entries_list(const std::vector<PageEntry>& entries, std::size_t& first_mark);

}  // namespace tetwright
