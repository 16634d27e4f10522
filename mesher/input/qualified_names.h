// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/io/names/unique_names.h"
#include "mesher/input/surface_repair.h"

namespace tetwright {

/// The names that the file of a body gives to parts of it.
struct NamesOfBody {
  std::string body;  ///< its name
  std::string file;
  std::map<std::string, std::string> names;  ///< from the name in the file to the one that is used
};

/// Fills in the names that are used, no two alike: a name that no other body has stays as it is; one that is
/// in `taken`, or that several bodies have, is qualified by its body, "heater:minY", and gets a suffix, "_2",
/// if that is taken as well. Adds them to `taken`, and a finding for each body with other names than its
/// file's; `what` are these names, a plural.
void qualify_names(const std::string& what, std::vector<NamesOfBody>& bodies, UniqueNames& taken,
                   std::vector<InputFinding>& findings);

}  // namespace tetwright
