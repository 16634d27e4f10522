// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "tetwright/image_volume.h"
#include "tetwright/label_volume.h"
#include "tetwright/progress.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Which voxels of an image count. A voxel belongs to the voxel of another volume, the mask, that contains
/// its centre; outside the mask it counts nowhere.
class ImageMask {
 public:
  /// All voxels count.
  ImageMask() = default;
  /// Voxels that belong to one other than 0 count.
  ///
  /// \pre both grids are in the same space
  static ImageMask nonzero(const LabelGrid& image, const LabelVolume& mask);
  /// For a tet, the voxels count that belong to one with the tag of the tet's material.
  static ImageMask own_label(const LabelGrid& image, const LabelVolume& labels);

  bool all() const { return groups_.empty(); }
  bool depends_on_material() const { return !group_of_.empty(); }
  /// Number of the voxels that count for a material, 1 or more; 0: none.
  std::uint32_t group_for(MaterialTag material) const {
    if (group_of_.empty()) return 1;
    const auto found = group_of_.find(material);
    return found == group_of_.end() ? 0 : found->second;
  }
  /// Group of a voxel, 0 if it counts nowhere.
  std::uint32_t group(std::size_t voxel) const { return groups_.empty() ? 1 : groups_[voxel]; }

 private:
  std::vector<std::uint32_t> groups_;              ///< of each voxel; empty: all are 1
  std::map<MaterialTag, std::uint32_t> group_of_;  ///< empty: 1 for all
};

/// Voxels of an image that count for a mesh.
struct CountedVoxels {
  std::size_t count = 0;
  double lowest = 0, highest = 0;  ///< their values; 0 if there are none
};

/// Finds the finite voxels of a channel that count for any of the materials, or for any at all if `materials`
/// is empty. Parallel.
CountedVoxels counted_voxels(const ImageVolume& image, const ImageMask& mask,
                             const std::vector<MaterialTag>& materials, std::size_t channel = 0);

struct ImageValueOptions {
  std::size_t channel = 0;
  bool minimum = false, maximum = false, deviation = false;  ///< beside the mean
};

/// Tets or points with the same finding.
struct FoundPlaces {
  std::size_t count = 0;
  Vec3 first = Vec3::Zero();  ///< centroid or point, input units
};

/// Values of an image on a mesh, in the units of the image.
struct ImageValues {
  std::vector<double> mean;                         ///< of each tet
  std::vector<double> minimum, maximum, deviation;  ///< of each tet, as far as asked for
  std::vector<double> at_points;                    ///< of each point of the mesh
  FoundPlaces partly_outside;      ///< tets with a part outside the image's box, which does not count
  FoundPlaces nearest;             ///< tets without a voxel that counts
  FoundPlaces nearest_points;      ///< points without one
  std::size_t not_finite = 0;      ///< voxels that are not finite, which never count
  double lowest = 0, highest = 0;  ///< of all voxels that are finite
};

/// Checks that the box around an image, with the outer halves of its voxels, meets another one.
///
/// \param low, high corners of the box of `other`, in the space of the image
/// \param image_name, other names for the message
/// \throws InputError if it does not, with both boxes
void check_image_meets(const LabelGrid& image, const Vec3& low, const Vec3& high,
                       const std::string& image_name, const std::string& other);

/// Takes the values of an image for the tets and points of a mesh.
///
/// The image is interpolated trilinearly between the centres of voxels and is constant in the outer halves of
/// its outermost voxels; it has no values outside this box. In a tet, each voxel has a share: the integral of
/// its weight in the interpolation over the tet. The shares are integrated exactly, so that only rounding
/// (about 1e-9 of the image's range in well-shaped tets) makes an error, whatever the size of the tet.
///
/// - `mean` is the mean of all voxels that count, weighted by their shares. If all voxels count, this is the
///   mean of the interpolated image over the part of the tet that is inside the image.
/// - `deviation` is the standard deviation of these voxels from their mean, with the same weights; `minimum`
///   and `maximum` are those of the voxels that count and have a share. A tet smaller than a voxel has shares
///   of the eight voxels around it.
/// - A point has the interpolated value, with the weights of the voxels that count, scaled to sum 1. With
///   ImageMask::own_label() these are the voxels for any of the materials at the point.
/// - A tet or a point for which no voxel counts has the value of the voxel nearest to its centroid, with
///   deviation 0, of those that count for its material, or of all that count if there is none.
///
/// Parallel; results do not depend on the number of threads.
/// \param image_name, mesh_name names for messages
/// \param progress receives the fraction that is done; may be null
/// \pre the mesh and the image are in the same space
/// \throws InputError if no tet has a part inside the image, with both boxes; if no voxel counts
/// \throws Interrupted if cancelled
ImageValues image_values(const TetMesh& mesh, const ImageVolume& image, const ImageMask& mask,
                         const ImageValueOptions& options, const std::string& image_name,
                         const std::string& mesh_name, Progress* progress = nullptr);

}  // namespace tetwright
