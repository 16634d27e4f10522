// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/features/surface_patches.h"
#include "common/sizes/size_field.h"
#include "common/types.h"
#include "mesher/mesher.h"
#include "simplify/simplify.h"

namespace tetwright {

/// NAME=VALUE as given on the command line.
struct NamedValue {
  std::string name, value;
};

/// A length as given on the command line.
struct LengthOption {
  double value = 0;  ///< input units, or percent of the diagonal of the inputs' bounding box
  bool percent = false;

  double in_input_units(double diagonal) const { return percent ? value / 100 * diagonal : value; }
};

/// What messages call standard input.
inline constexpr const char* standard_input = "stdin";

/// What shows how far a command is.
enum class ProgressStyle { automatic, bar, json, none };

enum class Command { prepare, mesh, simplify, improve, check, batch, sample };

/// The parsed command line, with the defaults that --help shows.
struct CommandLine {
  Command command = Command::prepare;
  std::string call;       ///< as it was given, for the log
  std::string arguments;  ///< the same without the name of the program, each after a space
  /// The result stays in the memory of a host program, and -o may be left out; set before parsing.
  bool in_memory = false;
  std::vector<std::string> inputs;  ///< of `sample`: the name; standard_input for "-"
  std::string input_format;     ///< extension that standard input is read by, ".ply"; empty: it is no input
  std::string output;           ///< "-": standard output
  std::string output_format;    ///< of `output`; empty: by its extension
  int order = 1;                ///< of the elements: 2 has ten nodes
  std::string boundary;         ///< file of the boundary and interfaces as a surface; empty: none; may be "-"
  std::string boundary_format;  ///< of standard output, if `boundary` is that: --output-format then
  bool no_boundary = false;     ///< leave triangles out of `output`
  std::string before;           ///< `check`: the mesh whose topology must be the same
  std::vector<std::string> surfaces;  ///< `check`: what the mesh is compared with
  bool json = false;                  ///< `check`
  std::string material_field;         ///< cell field of the tet mesh that is read; empty: chosen by its name

  std::size_t target_tets = 0;
  double min_solid_angle = 0.1;  ///< steradians
  bool min_solid_angle_given = false;
  double beta = 5, gamma = 10;
  int max_iterations = 100;
  Schedule schedule = Schedule::tuned;
  ShapeObjective objective = ShapeObjective::both;
  double only_below = 0;    ///< `improve`, steradians; 0: all tets
  bool free_count = false;  ///< `improve`
  bool fix_boundary = false;
  LengthOption tolerance;  ///< 0: none
  std::string size_field;  ///< file; empty: none
  LengthOption min_edge, max_edge;
  double grading = default_grading;  ///< growth of the wanted edge length over distance

  int resolution = 0;     ///< 0: not given
  double voxel_size = 0;  ///< input units; 0: not given
  bool uniform = false;
  double adaptivity = 0.05;  ///< finest cells
  std::optional<int> max_refinement;
  LengthOption min_gap, min_thickness;
  std::vector<NamedValue> materials;  ///< after the positional inputs: name and file
  std::vector<NamedValue> layers;     ///< name and thickness (a number above 0, input units)
  NestedRule nested = NestedRule::automatic;
  bool split_solids = false;  ///< of a surface that tells them apart each is a material
  bool keep_outside = false;
  std::string write_sdf;  ///< .vdb file; empty: none

  /// The labels of a segmented volume to mesh, as inclusive ranges; empty: all but the outside label.
  std::vector<std::pair<MaterialTag, MaterialTag>> labels;
  std::string label_names;  ///< file with the names of labels; empty: none
  MaterialTag outside_label = 0;
  bool outside_label_given = false;
  std::size_t min_voxels = 8;  ///< min size of an island that is kept
  bool min_voxels_given = false;

  FeatureAngle feature_angle;

  bool accept_changes = false;  ///< another solid than the input's is a note
  bool strict = false;          ///< a note is a shortfall

  unsigned threads = 0;     ///< 0: all
  double time_limit = 0;    ///< seconds; 0: none
  double memory_limit = 0;  ///< 2^30 bytes; 0: none
  std::uint64_t seed = 1;
  std::string stats;
  std::string report;  ///< .html file; empty: none
  bool quiet = false;
  ProgressStyle progress = ProgressStyle::automatic;
  bool no_progress = false;
  std::string log_file;  ///< empty: none

  std::string results;  ///< `batch`: file; empty: beside the jobs
  unsigned jobs = 0;    ///< `batch`: at the same time; 0: as many as there are threads
  bool retry = false;   ///< `batch`: all jobs that did not end with status 0
};

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
