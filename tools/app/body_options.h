// SPDX-License-Identifier: Apache-2.0
#pragma once

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

}  // namespace tetwright
