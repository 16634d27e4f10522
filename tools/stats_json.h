#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/mesh_statistics.h"
#include "mesher/label_input.h"
#include "mesher/mesher.h"
#include "simplify/simplify.h"
#include "tools/command_line.h"

namespace tetwright {

/// One thing that was asked for and not reached.
struct Shortfall {
  std::string what;  ///< "target_tets" or "min_solid_angle"
  double asked = 0, reached = 0;
  std::string held_back_by;  ///< the rule, from the rejection counts
};

/// What was read of a segmented volume: PreparedLabels without its voxels.
struct VolumeReport {
  explicit VolumeReport(const PreparedLabels& from)
      : size(from.size),
        origin(from.origin),
        directions(from.directions),
        space(from.space),
        labels(from.materials),
        lost(from.lost),
        merged_islands(from.merged_islands),
        merged_voxels(from.merged_voxels) {}
  /// Between voxels along each axis, input units.
  Vec3 spacing() const { return directions.colwise().norm(); }

  std::array<int, 3> size;
  Vec3 origin;
  Eigen::Matrix3d directions;
  std::string space;
  std::vector<LabelMaterial> labels;
  std::vector<LostLabel> lost;
  std::size_t merged_islands, merged_voxels;
};

/// All that one run has to tell; what a command does not do stays empty.
struct RunReport {
  std::vector<std::string> inputs;
  std::size_t input_triangles = 0, input_points = 0;
  std::string material_field;          ///< of a tet mesh: where its materials came from
  std::optional<VolumeReport> volume;  ///< where the input is one
  std::vector<InputFinding> findings;
  std::optional<MesherReport> mesher;
  std::optional<MeshStatistics> dense, result;
  std::map<MaterialTag, std::string> material_names;
  std::optional<SimplifyReport> simplify;
  double seconds_read = 0, seconds_mesh = 0, seconds_write = 0, seconds_total = 0;
  std::vector<Shortfall> shortfall;
};

/// Largest resident size of the process so far.
std::size_t peak_bytes();

/// The keys that data/stats.schema.json fixes.
nlohmann::json stats_json(const CommandLine& line, const RunReport& run);
/// As it is written and printed; bytes that are no UTF-8 (names may have any) become replacement characters.
std::string json_text(const nlohmann::json& json);
/// `names` of materials that have one; `threshold` is what the statistics were made with, steradians.
nlohmann::json mesh_json(const MeshStatistics& mesh, const std::map<MaterialTag, std::string>& names,
                         double threshold);

}  // namespace tetwright
