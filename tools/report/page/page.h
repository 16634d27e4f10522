// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tetwright/files.h"
#include "tetwright/prepare.h"
#include "tools/app/command_line.h"
#include "tools/compare/check_report.h"
#include "tools/report/page/page_mesh.h"

namespace tetwright {

/// The page of --report as described in README.md: HTML that needs no other file and no network. It has no
/// time and no data of the machine, so that equal calls give equal bytes.
///
/// \param distances may be null
/// \param check may be null
/// \pre `mesh` has its interfaces.
std::string report_page(const CommandLine& line, const PrepareReport& run, const TetMesh& mesh,
                        const SurfaceDistances* distances, const CheckReport* check = nullptr,
                        const PageLimits& limits = {});

}  // namespace tetwright
