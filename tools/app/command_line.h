// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tetwright/prepare.h"
#include "tetwright/prepare_steps.h"

namespace tetwright {

/// NAME=VALUE on the command line.
struct NamedValue {
  std::string name, value;
};

/// The name of standard input in messages.
inline constexpr const char* standard_input = "stdin";

/// Display of progress.
enum class ProgressStyle { automatic, bar, json, none };

enum class Command { prepare, mesh, simplify, improve, check, batch, sample };

/// The files that a command writes. "-": standard output, for streams only; empty: none.
struct OutputOptions {
  std::string mesh;             ///< the mesh; of `sample`: the sample of any kind
  std::string format;           ///< format of `mesh`; empty: by its extension
  std::string boundary;         ///< the boundary and interfaces as a surface
  std::string boundary_format;  ///< --output-format if `boundary` is standard output
  bool no_boundary = false;     ///< leaves triangles out of `mesh`
  std::string distances;        ///< the signed distances that were meshed, .vdb
  std::string report;           ///< .html
  std::string stats;            ///< .json
};

/// Output to the console and the log.
struct ConsoleOptions {
  bool quiet = false;
  ProgressStyle progress = ProgressStyle::automatic;
  bool no_progress = false;
  std::string log_file;  ///< empty: none
};

struct CheckOptions {
  std::string before;                 ///< mesh that must have the same topology; empty: none
  std::vector<std::string> surfaces;  ///< to compare the mesh with
  bool json = false;
};

struct BatchOptions {
  std::string results;  ///< file; empty: beside the jobs
  unsigned jobs = 0;    ///< concurrent jobs; 0: one for each thread
  bool retry = false;   ///< reruns jobs that did not end with status 0
};

/// The parsed command line, with the defaults that --help shows.
struct CommandLine {
  Command command = Command::prepare;
  std::string call;       ///< the call as typed, for the log
  std::string arguments;  ///< `call` without the program's name; each starts with a space
  /// The result stays in memory of a host program, so that -o is optional. Set before parsing.
  bool in_memory = false;
  std::vector<std::string> inputs;    ///< standard_input for "-"; of `sample`: its name
  std::string input_format;           ///< extension for standard input, ".ply"; empty: not used
  std::vector<NamedValue> materials;  ///< after the positional inputs: name and file
  PrepareOptions options;             ///< of commands that make meshes; `check` uses a few
  OutputOptions outputs;
  ConsoleOptions console;
  CheckOptions check;
  BatchOptions batch;
};

/// Whether the command makes a mesh.
bool makes_mesh(Command command);
/// The task of a command.
///
/// \pre makes_mesh(command)
Task task_of(Command command);

/// Parses the arguments.
///
/// \return false if it printed the help or the version instead
/// \throws UsageError with one line that names the remedy: for unknown commands and options (with the nearest
/// known one), values out of range (with option, value and range), and options that do not go together
bool parse_command_line(int argc, char** argv, CommandLine& out);

/// The names on the command line, such as "prepare", "tuned" and "solid-angle".
const char* name_of(Command command);
const char* name_of(Schedule schedule);
const char* name_of(ProgressStyle style);
const char* name_of(ShapeObjective objective);

}  // namespace tetwright
