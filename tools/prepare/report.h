// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/diagnostic.h"
#include "common/features/surface_patches.h"
#include "common/mesh/curved_elements.h"
#include "common/mesh/mesh_statistics.h"
#include "common/sizes/size_field.h"
#include "mesher/mesher.h"
#include "simplify/simplify.h"
#include "tools/compare/crease_comparison.h"
#include "tools/compare/edge_lengths.h"
#include "tools/compare/patch_comparison.h"
#include "tools/compare/solid_comparison.h"

namespace tetwright {

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

/// The edge lengths that SizeOptions ask for.
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

/// Everything that a run reports. What it does not do stays empty.
struct PrepareReport {
  std::vector<std::string> inputs;
  std::size_t input_triangles = 0, input_points = 0;
  std::string material_field;           ///< the cell field of a tet mesh that its materials came from
  std::optional<VolumeReport> volume;   ///< if the input is a segmented volume
  std::vector<Diagnostic> diagnostics;  ///< all that was found and falls short
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
  /// Red, green and blue, 0 to 1, of the labels of a segmented volume whose file has colours.
  std::map<MaterialTag, std::array<double, 3>> material_colours;
  std::optional<SimplifyReport> simplify;
  double tolerance = 0;                      ///< input units; 0: none
  std::optional<DeviationReport> deviation;  ///< of the result, with a tolerance
  /// Area of the surface that the mesh does not show although no surface hides any: 0 where some are open,
  /// intersect or meet others, or carve them.
  double lost_area() const;
  /// Whether a request was not met: the mesh is valid, and diagnostics say what.
  bool falls_short() const;
  RequestedSizes sizes;
  std::optional<EdgeLengthReport> edge_lengths;  ///< where sizes are asked for
  double seconds_read = 0, seconds_mesh = 0, seconds_write = 0, seconds_total = 0;
};

}  // namespace tetwright
