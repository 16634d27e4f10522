// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace CLI {
class App;
}

namespace tetwright {

struct CommandLine;

/// Adds the options and arguments of a command, with their help, to its parser. The parser sets `line`.
///
/// \pre `line` outlives `app`.
void add_prepare(CLI::App& app, CommandLine& line);
void add_mesh(CLI::App& app, CommandLine& line);
void add_simplify(CLI::App& app, CommandLine& line);
void add_values(CLI::App& app, CommandLine& c);
void add_improve(CLI::App& app, CommandLine& line);
void add_embed(CLI::App& app, CommandLine& line);
void add_check(CLI::App& app, CommandLine& line);
void add_batch(CLI::App& app, CommandLine& line);
void add_sample(CLI::App& app, CommandLine& line);

}  // namespace tetwright
