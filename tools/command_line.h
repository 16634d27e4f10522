#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "common/types.h"
#include "mesher/surface_input.h"
#include "simplify/simplify.h"

namespace tetwright {

/// NAME=VALUE as given on the command line.
struct NamedValue {
  std::string name, value;
};

enum class Command { prepare, mesh, simplify, improve, check, sample };

/// What the command line said; defaults are those of --help.
struct CommandLine {
  Command command = Command::prepare;
  std::vector<std::string> inputs;  ///< for sample: its name
  std::string output;
  std::string before;          ///< check: mesh whose topology must be the same
  bool json = false;           ///< check
  std::string material_field;  ///< of a tet mesh that is read; empty: by the rule

  std::size_t target_tets = 0;
  double min_solid_angle = 0.1;  ///< steradians
  bool min_solid_angle_given = false;
  double beta = 5, gamma = 10;
  int max_iterations = 100;
  Schedule schedule = Schedule::tuned;
  ShapeObjective objective = ShapeObjective::both;
  double only_below = 0;  ///< improve, steradians; 0: all tets

  int resolution = 0;     ///< 0: not given
  double voxel_size = 0;  ///< input units; 0: not given
  bool uniform = false;
  double adaptivity = 0.05;           ///< finest cells
  std::vector<NamedValue> materials;  ///< after the positional inputs: name and file
  std::vector<NamedValue> layers;     ///< name and thickness (a number above 0, input units)
  NestedRule nested = NestedRule::automatic;
  bool keep_outside = false;
  std::string write_sdf;  ///< .vdb file; empty: not wanted

  /// Of a segmented volume: the labels to mesh, as ranges with both ends; empty: all but the outside label.
  std::vector<std::pair<MaterialTag, MaterialTag>> labels;
  std::string label_names;  ///< file with names of labels; empty: none
  MaterialTag outside_label = 0;
  bool outside_label_given = false;
  std::size_t min_voxels = 8;  ///< smaller islands are merged
  bool min_voxels_given = false;

  unsigned threads = 0;  ///< 0: all
  std::uint64_t seed = 1;
  std::string stats;
  bool quiet = false;
  bool no_progress = false;
};

/// Parses the arguments. Throws UsageError (one line that says what to do) when the call is wrong. Returns
/// false when help or the version was asked for and printed.
bool parse_command_line(int argc, char** argv, CommandLine& out);

/// As options spell them: "tuned", "paper"; "both", "solid-angle", "dihedral".
const char* name_of(Schedule schedule);
const char* name_of(ShapeObjective objective);

}  // namespace tetwright
