// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/tet_mesh.h"
#include "mesher/mesher.h"

namespace tetwright {

/// What is compared of a solid.
struct SolidNumbers {
  double volume = 0;  ///< input units cubed
  std::size_t components = 0, cavities = 0;
  std::ptrdiff_t handles = 0;
};

/// A material of a mesh beside the solid that it is meant to be.
struct SolidComparison {
  std::string name;
  MaterialTag tag = 0;
  enum class Against { surface, distances, voxels } against = Against::surface;
  /// By voxels only volumes and components are known.
  SolidNumbers expected, result;
  /// By voxels as many components are possible as expected or more, up to this.
  std::size_t max_components = 0;
  /// "256 handles instead of 0, volume 3.1 % less"; empty where the solid is the same.
  std::string difference;
  /// Of the largest shell without a counterpart, input units. By voxels: of the smallest component, of the
  /// mesh where it has too many, else of the volume.
  std::optional<Vec3> place;

  bool same() const { return difference.empty(); }
  bool same_counts() const {
    if (against == Against::voxels)
      return expected.components <= result.components && result.components <= max_components;
    return expected.components == result.components && expected.handles == result.handles &&
           expected.cavities == result.cavities;
  }
};

/// Whether a volume is within 1 % of the one that is meant.
bool is_same_volume(double volume, double meant);

/// Compares materials with what they are meant to be: components, handles and cavities must be equal, volumes
/// within 1 %. `mesh` has its interfaces.
std::vector<SolidComparison> compare_solids(const std::vector<ExpectedSolid>& expected, const TetMesh& mesh);

/// Compares labels with their voxels: volumes, and components with the parts that voxels may mean. What is
/// called "outside" there are the cavities of all labels together, with `outside` if that is not meshed; its
/// volume is not compared. `mesh` has its interfaces.
std::vector<SolidComparison> compare_labels(const std::vector<LabelMaterial>& labels,
                                            const std::optional<LabelParts>& outside, double voxel_volume,
                                            const TetMesh& mesh);

}  // namespace tetwright
