// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tetwright/partition.h"
#include "tetwright/prepare.h"
#include "tetwright/prepare_steps.h"

namespace tetwright {

/// NAME=VALUE, as given on the command line.
struct NamedValue {
  std::string name, value;
};

/// Name of standard input in messages.
inline constexpr const char* standard_input = "stdin";

/// How progress is displayed.
enum class ProgressStyle { automatic, bar, json, none };

enum class Command { prepare, mesh, simplify, improve, values, embed, check, batch, sample };

/// Files that a command writes. "-": standard output, for formats that can be streamed; empty: not written.
struct OutputOptions {
  std::string mesh;             ///< the mesh; of `sample` a sample of any kind, of `embed` the weights
  std::string format;           ///< format of `mesh`; empty: from its extension
  std::string boundary;         ///< boundary and interfaces as a surface
  std::string boundary_format;  ///< value of --output-format if `boundary` is standard output
  bool no_boundary = false;     ///< true: write no triangles to `mesh`
  PartNumber parts = 0;         ///< parts into which `mesh` is divided; 0: it is not
  std::string distances;        ///< .vdb file of the signed distances that were meshed
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
  std::vector<std::string> surfaces;  ///< surfaces with which the mesh is compared
  bool json = false;
};

struct BatchOptions {
  std::string results;  ///< file; empty: next to the file of jobs
  unsigned jobs = 0;    ///< concurrent jobs; 0: one for each thread
  bool retry = false;   ///< true: rerun jobs that did not end with status 0
};

/// Options of the sample `foam`; empty: its default.
struct FoamOptions {
  std::optional<int> voxels;            ///< along each edge
  std::optional<std::uint32_t> grains;  ///< their number
};

/// A parsed command line; the initial values are the defaults that --help shows.
struct CommandLine {
  Command command = Command::prepare;
  std::string call;       ///< the call as typed, for the log
  std::string arguments;  ///< `call` without the program's name; each starts with a space
  /// The result stays in the memory of a host program, so that -o is optional. Set this before parsing.
  bool in_memory = false;
  std::vector<std::string> inputs;    ///< standard_input for "-"; of `sample` its name
  std::string input_format;           ///< extension for standard input, such as ".ply"; empty: not used
  std::vector<NamedValue> materials;  ///< inputs after the positional ones: name and file
  std::vector<NamedValue> sheets, partitions;  ///< further inputs: name and file
  std::string modulus_of;                      ///< name of the values of --modulus
  std::optional<ModulusLaw> modulus;           ///< --modulus
  std::optional<double> min_modulus;           ///< --min-modulus
  PrepareOptions options;  ///< options of commands that make meshes; `check` uses some of them
  OutputOptions outputs;
  ConsoleOptions console;
  CheckOptions check;
  BatchOptions batch;
  FoamOptions foam;
};

/// Whether the command makes a mesh.
bool makes_mesh(Command command);
/// Task of a command.
///
/// \pre makes_mesh(command)
Task task_of(Command command);

/// Parses the arguments.
///
/// \return false if it printed the help or the version instead
/// \throws UsageError with one line that includes the remedy: for unknown commands and options (with the
///   nearest known one), for values out of range (with option, value and range), and for options that cannot
///   be combined
bool parse_command_line(int argc, char** argv, CommandLine& out);

/// Names on the command line, such as "prepare", "tuned" and "solid-angle".
const char* name_of(Command command);
const char* name_of(Schedule schedule);
const char* name_of(ProgressStyle style);
const char* name_of(ShapeObjective objective);

}  // namespace tetwright
