// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

namespace tetwright::python {

/// Options of a command that makes or checks a mesh, such as "--threads", and the type of each value as
/// --help shows it: "N", "NUMBER", "LENGTH", "FILE"; empty for a flag. Empty for other commands.
std::map<std::string, std::string> option_types(const std::string& command);

}  // namespace tetwright::python
