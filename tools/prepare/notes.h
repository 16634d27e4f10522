// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/prepare/report.h"

namespace tetwright {

enum class NotesOf : std::uint8_t { all, certain };
/// The notes, a line each; the first has all that are about files. Empty if there are none.
std::vector<std::string> notes_of(const PrepareReport& report, NotesOf which = NotesOf::all);

/// The requests that were not met, a line each.
std::vector<std::string> shortfalls_of(const PrepareReport& report);

}  // namespace tetwright
