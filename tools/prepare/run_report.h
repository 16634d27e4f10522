// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/features/surface_patches.h"
#include "common/mesh/curved_elements.h"
#include "common/mesh/mesh_check.h"
#include "common/mesh/mesh_statistics.h"
#include "common/mesh/topology.h"
#include "common/sizes/size_field.h"
#include "mesher/mesher.h"
#include "simplify/simplify.h"
#include "tools/app/exit_status.h"
#include "tools/compare/crease_comparison.h"
#include "tools/compare/edge_lengths.h"
#include "tools/compare/patch_comparison.h"
#include "tools/compare/solid_comparison.h"
#include "tools/compare/surface_comparison.h"

namespace tetwright {

/// A request that was not met, which makes the exit status 1.
struct Shortfall {
  std::string what;  ///< as in --stats: "target_tets", "fidelity" and others
  double asked = 0, reached = 0;
  std::string limited_by;         ///< the rules that prevented it
  std::string message;            ///< the line for the user, without its end
  std::vector<Vec3> places = {};  ///< that the message names, input units
};

/// A segmented volume as it was read: LabelInput without its voxels.
struct VolumeReport {
  explicit VolumeReport(const LabelInput& from)
      : size(from.size),
        origin(from.origin),
        directions(from.directions),
        space(from.space),
        labels(from.materials),
        lost(from.lost),
        outside_parts(from.outside_parts),
        merged_islands(from.merged_islands),
        merged_voxels(from.merged_voxels) {}
  /// The distance between voxels along each axis, input units.
  Vec3 spacing() const { return directions.colwise().norm(); }

  std::array<int, 3> size;
  Vec3 origin;
  Eigen::Matrix3d directions;
  std::string space;
  std::vector<LabelMaterial> labels;
  std::vector<LostLabel> lost;
  LabelParts outside_parts;
  std::size_t merged_islands, merged_voxels;
};

/// What --size-field, --min-edge, --max-edge and --grading ask for.
struct RequestedSizes {
  SizeLimits limits;
  std::shared_ptr<const SizeSource> source;        ///< null: no size field
  std::shared_ptr<const SizeField> target_length;  ///< likewise

  bool any() const { return target_length || limits.min_edge > 0 || std::isfinite(limits.max_edge); }
};

/// Cells that are larger than was meant, since memory would not hold smaller ones.
struct CoarserCells {
  double asked, used;  ///< edges of the finest cells, input units
  double bytes;        ///< that those asked for would take
};

/// Everything that a run of the program reports. What a command does not do stays empty.
struct RunReport {
  std::vector<std::string> inputs;
  std::size_t input_triangles = 0, input_points = 0;
  std::string material_field;          ///< the cell field of a tet mesh that its materials came from
  std::optional<VolumeReport> volume;  ///< if the input is a segmented volume
  std::vector<InputFinding> findings;
  std::optional<MesherReport> mesher;
  std::optional<CoarserCells> coarser;
  std::optional<MeshStatistics> dense, result;
  std::vector<FeatureReport> features;  ///< of each surface, or of the tet mesh
  CreaseCurves creases;                 ///< of all of them
  std::optional<CreaseComparison> crease_comparison;
  std::optional<CurvingReport> second_order;  ///< with --order 2
  std::vector<PatchComparison> patches;       ///< that the input names or numbers
  std::size_t input_limited = 0;  ///< tets of the result below the bound, see input_limited_tets()
  std::vector<SolidComparison> solids;
  std::map<MaterialTag, std::string> material_names;
  /// Of a segmented volume whose file gives its labels colours: red, green, blue, 0 to 1.
  std::map<MaterialTag, std::array<double, 3>> material_colours;
  std::optional<SimplifyReport> simplify;
  double tolerance = 0;                      ///< input units; 0: none
  std::optional<DeviationReport> deviation;  ///< of the result, with a tolerance
  /// Area of the surface that the mesh does not show although no surface hides any: 0 where some are open,
  /// intersect or meet others, or carve them.
  double lost_area() const;
  RequestedSizes sizes;
  std::optional<EdgeLengthReport> edge_lengths;  ///< where sizes are asked for
  double seconds_read = 0, seconds_mesh = 0, seconds_write = 0, seconds_total = 0;
  std::vector<Shortfall> shortfall;
  ExitStatus status = ExitStatus::done;
  std::string error, stage;  ///< of a run that failed: its message, and the stage in which it did
};

/// What `check` found in a mesh.
struct CheckReport {
  std::vector<MeshFinding> findings;
  /// False if indices or coordinates are unsound: then there are no statistics and no topology.
  bool measurable = true;
  std::optional<Topology> topology, topology_before;             ///< of the mesh, and of that of --before
  std::optional<std::vector<std::string>> topology_differences;  ///< from the mesh of --before, if given
  std::optional<SurfaceComparison> surface;                      ///< with --surface
  double tolerance = 0;                                          ///< input units; 0: none

  bool valid() const { return is_valid(findings); }
  bool within_tolerance() const { return tolerance == 0 || (surface && surface->upper() <= tolerance); }
  bool topology_kept() const { return !topology_differences || topology_differences->empty(); }
};

}  // namespace tetwright
