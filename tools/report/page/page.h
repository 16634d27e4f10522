// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/files/atomic_file.h"
#include "tools/app/command_line.h"
#include "tools/prepare/run_report.h"
#include "tools/report/page/page_mesh.h"

namespace tetwright {

/// The page of --report, README.md says what is on it: HTML that needs no other file and no network. No time
/// and nothing of the machine is in it, so that the same call gives the same bytes. `mesh` has its
/// interfaces; `distances` and `check` may be null.
std::string report_page(const CommandLine& line, const RunReport& run, const TetMesh& mesh,
                        const SurfaceDistances* distances, const CheckReport* check = nullptr,
                        const PageLimits& limits = {});

}  // namespace tetwright
