// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tetwright/prepare.h"
#include "tetwright/prepare_steps.h"

namespace tetwright {

/// NAME=VALUE as given on the command line.
struct NamedValue {
  std::string name, value;
};

/// The name of standard input in messages.
inline constexpr const char* standard_input = "stdin";

/// How progress is shown.
enum class ProgressStyle { automatic, bar, json, none };

enum class Command { prepare, mesh, simplify, improve, check, batch, sample };

/// The files that a command writes. "-" is standard output where that is possible; empty: none.
struct OutputOptions {
  std::string mesh;             ///< of `sample`: whatever it is
  std::string format;           ///< of `mesh`; empty: by its extension
  std::string boundary;         ///< the boundary and interfaces as a surface
  std::string boundary_format;  ///< of `boundary` where it is standard output, whose --output-format this is
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
  std::string before;                 ///< the mesh whose topology must be the same; empty: none
  std::vector<std::string> surfaces;  ///< that the mesh is compared with
  bool json = false;
};

struct BatchOptions {
  std::string results;  ///< file; empty: beside the jobs
  unsigned jobs = 0;    ///< at the same time; 0: as many as there are threads
  bool retry = false;   ///< all jobs that did not end with status 0
};

/// The parsed command line, with the defaults that --help shows.
struct CommandLine {
  Command command = Command::prepare;
  std::string call;       ///< as it was given, for the log
  std::string arguments;  ///< the same without the name of the program, each after a space
  /// The result stays in the memory of a host program, and -o may be left out; set before parsing.
  bool in_memory = false;
  std::vector<std::string> inputs;    ///< of `sample`: the name; standard_input for "-"
  std::string input_format;           ///< extension that standard input is read by, ".ply"; empty: no input
  std::vector<NamedValue> materials;  ///< after the positional inputs: name and file
  PrepareOptions options;             ///< of all commands that make meshes; `check` has a few of them
  OutputOptions outputs;
  ConsoleOptions console;
  CheckOptions check;
  BatchOptions batch;
};

/// Whether the command makes a mesh, and how. Of no other command.
bool makes_mesh(Command command);
Task task_of(Command command);

/// Parses the arguments. Returns false if it printed the help or the version instead. Throws UsageError, with
/// one line that says what to do, if the call is wrong: unknown commands and options (the nearest is named),
/// values out of range (option, value and range are named), options that do not go together.
bool parse_command_line(int argc, char** argv, CommandLine& out);

/// The names on the command line, such as "prepare", "tuned" and "solid-angle".
const char* name_of(Command command);
const char* name_of(Schedule schedule);
const char* name_of(ProgressStyle style);
const char* name_of(ShapeObjective objective);

}  // namespace tetwright
