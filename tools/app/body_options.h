// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace tetwright {

struct CommandLine;

/// Adds the options that say which bodies surfaces enclose: materials, layers, contacts, regions, sheets,
/// open surfaces and caps. The parser sets `line`.
///
/// \pre `line` outlives `app`.
void add_bodies(CLI::App& app, CommandLine& line);

/// Adds --surface-space, the space of surfaces whose files name none.
void add_surface_space(CLI::App& app, CommandLine& line, const std::string& description);
/// Adds --mesh-space, the space of a tet mesh whose file names none.
void add_mesh_space(CLI::App& app, CommandLine& line);

}  // namespace tetwright
