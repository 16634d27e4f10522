// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "common/io/volumes/voxel_data.h"
#include "common/io/volumes/voxel_source.h"

namespace tetwright {

/// Whether a folder has a DICOM file, by its content or its extension (.dcm). Folders in it are not searched.
bool has_dicom_files(const std::string& folder);

/// Opens a volume of DICOM: the slices of one series in a folder, or a file of several frames.
///
/// Slices are ordered by their positions along the normal of ImageOrientationPatient, so that the third axis
/// points along that normal, and have the distance of their positions. Positions that are not along the
/// normal, as with a tilted gantry, make a skewed grid. The space is left-posterior-superior. RescaleSlope
/// and RescaleIntercept apply to each slice. The frames of a file without positions have those that
/// SpacingBetweenSlices or GridFrameOffsetVector give, or an assumed spacing. Files in the folder that are no
/// DICOM files, or have no pixels, are named in LabelGrid::ignored_files.
///
/// \param cache_bytes decoded slices that are kept, bytes
/// \throws InputError naming files and values if there are several series, slices of different sizes or
///   orientations, distances that differ by more than 1 %, colour images, one slice alone, or damaged files
std::unique_ptr<VoxelSource> open_dicom(const std::string& path, std::size_t cache_bytes,
                                        VoxelUse use = VoxelUse::labels);

}  // namespace tetwright
