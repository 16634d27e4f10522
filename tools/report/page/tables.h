// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tetwright/prepare.h"
#include "tools/report/page/charts.h"
#include "tools/report/page/entries.h"

namespace tetwright {

/// The figures of the meshes side by side.
///
/// \param threshold solid angle that the statistics were made with, steradians
std::string figures_table(std::span<const ChartMesh> meshes, double threshold);

/// The materials of the result, with their tets and volumes.
std::string materials_table(const PrepareReport& run);

/// A list of entries with a button for each location.
///
/// \param first_mark number of the first location; becomes that of the next list
std::string entries_list(const std::vector<PageEntry>& entries, std::size_t& first_mark);

}  // namespace tetwright
