// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/io/encodings/file_ranges.h"
#include "common/io/volumes/voxel_data.h"

namespace tetwright {

/// Shape of a page and of the pieces in which it is stored.
struct TiffPage {
  std::uint32_t width = 0, height = 0;
  VoxelType type = VoxelType::uint8;
  /// Size of strips (as wide as the page) or tiles.
  std::uint32_t piece_width = 0, piece_height = 0;
  bool tiled = false;

  bool operator==(const TiffPage&) const = default;
};

/// Fields of a file's first page that say how large voxels are, and where they are.
struct TiffDescription {
  std::string text;  ///< ImageDescription
  /// Pixels for each unit, or 0.
  double resolution_x = 0, resolution_y = 0;
  double unit_mm = 0;  ///< the unit of the resolution, 0: none
  bool compressed = false;
  bool big_endian = false;
  std::uint64_t first_offset = 0;  ///< of the first strip, bytes
};

/// An open TIFF file. libtiff, which knows BigTIFF and all compressions. Not safe for concurrent use.
class TiffFile {
 public:
  /// \throws InputError if the file cannot be read or is not a TIFF file
  explicit TiffFile(const std::string& path);
  ~TiffFile();
  TiffFile(TiffFile&&) noexcept;

  /// Goes to the next page.
  /// \return false at the end
  bool next();
  /// Position of the page in the file, for go_to().
  std::uint64_t offset() const;
  void go_to(std::uint64_t offset);

  /// Shape of the page.
  /// \param page its name for messages
  /// \throws InputError unless it has one sample of 8, 16, 32 or 64 bits for each pixel
  TiffPage page(const std::string& page, VoxelUse use) const;
  TiffDescription description() const;

  /// Reads a strip or tile of the page, in this machine's byte order.
  /// \param number from 0, row by row
  /// \param bytes of the piece; fewer are an error
  void read_piece(bool tile, std::uint32_t number, char* to, std::size_t bytes,
                  const std::string& page) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tetwright
