// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/unique_names.h"
#include "tetwright/diagnostic.h"

namespace tetwright {

/// The names that a body's file gives to parts of it.
struct NamesOfBody {
  std::string body;  ///< its name
  std::string file;
  std::map<std::string, std::string> names;  ///< from the name in the file to the name that is used
};

/// Chooses the names that are used, no two alike. A name that only one body has stays as it is. A name that
/// is in `taken` or that several bodies have is qualified by its body, "heater:minY", with a suffix, "_2", if
/// that is taken as well.
///
/// \param what a plural that says what is named
/// \param bodies their used names are filled in
/// \param taken the chosen names are added
/// \param findings a finding is added for each body with names other than its file's
void qualify_names(const std::string& what, std::vector<NamesOfBody>& bodies, UniqueNames& taken,
                   std::vector<Diagnostic>& findings);

}  // namespace tetwright
