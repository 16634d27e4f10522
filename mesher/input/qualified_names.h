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

/// Chooses unique names. A name that only one body has is kept. A name that is in `taken` or that several
/// bodies have is prefixed with its body, as in "heater:minY", and gets a suffix such as "_2" if that is
/// taken as well.
///
/// \param what plural noun for the things named, for the finding
/// \param bodies their `names` are filled in
/// \param taken the chosen names are added
/// \param findings gets a finding for each body with names that differ from its file's
void qualify_names(const std::string& what, std::vector<NamesOfBody>& bodies, UniqueNames& taken,
                   std::vector<Diagnostic>& findings);

}  // namespace tetwright
