// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/io/volumes/dicom_elements.h"
#include "common/io/volumes/voxel_data.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Representation of the pixels of a DICOM image.
struct DicomPixelFormat {
  VoxelType type = VoxelType::uint16;
  int bits_stored = 16;
  int shift = 0;  ///< bits below the stored ones
  bool is_signed = false;

  bool operator==(const DicomPixelFormat&) const = default;
};

/// A file with pixels: a slice, or several frames.
struct DicomImage {
  std::string file;
  std::string series;       ///< SeriesInstanceUID
  std::string description;  ///< of the series, for messages
  int columns = 0, rows = 0;
  std::int64_t frames = 1;
  DicomPixelFormat format;
  std::string transfer_syntax;
  bool big_endian = false;
  DicomPixels pixels;
};

/// A frame of an image, and where it is.
struct DicomSlice {
  std::size_t image = 0;           ///< index of its file
  std::int64_t frame = 0;          ///< in its file
  std::optional<Vec3> position;    ///< of the centre of the first pixel, mm
  Vec3 along_row = Vec3::UnitX();  ///< unit vector from a column to the next one
  Vec3 along_column = Vec3::UnitY();
  bool oriented = false;
  std::optional<Vec3> spacing;  ///< x: of columns, y: of rows, z: of frames if it is given, else 0; mm
  double slope = 1, intercept = 0;
};

/// An image and its slices, whose index of the image is 0.
struct DicomFrames {
  DicomImage image;
  std::vector<DicomSlice> slices;
};

/// Reads all but the pixels of a file.
/// \return no slices if it is a DICOM file without pixels that is no image, such as a report
/// \throws InputError if it is damaged, or is no image of gray values
DicomFrames read_dicom_frames(const std::string& file);

/// Name of a frame for messages: its file, and the number of the frame if there are several.
std::string frame_name(const DicomImage& image, std::int64_t frame);

/// Bytes of the decoded pixels of a frame.
std::size_t frame_bytes(const DicomImage& image);

/// Reads and decodes a frame, in this machine's byte order. May be called concurrently.
/// \throws InputError if it cannot be read or decoded
ByteBuffer read_dicom_frame(const DicomImage& image, std::int64_t frame);

}  // namespace tetwright
