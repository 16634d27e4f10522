// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace CLI {
class App;
}

namespace tetwright {

struct CommandLine;

/// Adds a command's options and arguments, with their help, to its parser, which then sets `line`: both must
/// outlive it.
void add_prepare(CLI::App& app, CommandLine& line);
void add_mesh(CLI::App& app, CommandLine& line);
void add_simplify(CLI::App& app, CommandLine& line);
void add_improve(CLI::App& app, CommandLine& line);
void add_check(CLI::App& app, CommandLine& line);
void add_batch(CLI::App& app, CommandLine& line);
void add_sample(CLI::App& app, CommandLine& line);

}  // namespace tetwright
