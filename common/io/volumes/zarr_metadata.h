// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/io/encodings/chunk_codecs.h"
#include "common/io/volumes/voxel_data.h"

namespace tetwright {

// Metadata of zarr arrays and groups: versions 2 and 3 of the specification (zarr-specs.readthedocs.io), and
// OME-Zarr (ngff.openmicroscopy.org) 0.1 to 0.5. No library is used: TensorStore and z5 are not packaged.

/// Encoding of the items of a chunk.
struct ZarrChunk {
  std::vector<std::int64_t> size;  ///< items along each axis
  /// Axes from the one whose items are farthest apart in the chunk to the one whose items are adjacent.
  std::vector<std::size_t> order;
  std::vector<ChunkCodec> codecs;  ///< in the order of encoding
};

/// An array of a zarr hierarchy.
struct ZarrArray {
  std::vector<std::int64_t> shape;  ///< axes in the order of the file
  ZarrChunk chunk;                  ///< the chunks that are decoded
  VoxelFormat format;
  /// Label of items that no chunk has; std::nullopt if the fill value is not a label.
  std::optional<MaterialTag> fill;
  /// Value of such items in an image; std::nullopt if it is not a finite 32-bit float.
  std::optional<float> fill_value;
  std::string fill_text;                ///< the fill value for messages
  std::string key_prefix;               ///< of the keys of chunks: "c/" or nothing
  char separator = '.';                 ///< between the numbers in the keys of chunks
  std::vector<std::string> axis_names;  ///< one for each axis, in lower case, or none
  /// A file has a shard of several chunks; empty: one chunk.
  std::vector<std::int64_t> shard;
  bool index_at_end = true;              ///< of a shard; otherwise at its beginning
  std::vector<ChunkCodec> index_codecs;  ///< after its little- or big-endian numbers
  bool index_swap = false;               ///< true: the byte order is not this machine's
};

/// Parses .zarray.
/// \param file its name for messages
/// \throws InputError if it is malformed, or needs what is not supported
ZarrArray parse_zarr2_array(std::string_view text, const std::string& file);

/// Parses zarr.json.
/// \return std::nullopt for a group
std::optional<ZarrArray> parse_zarr3_array(std::string_view text, const std::string& file);

/// An array of an OME-Zarr image in one of its resolutions.
struct ZarrDataset {
  std::string path;                        ///< of the array in the group
  std::vector<double> scale, translation;  ///< for each axis, or empty
};

/// The image of an OME-Zarr group.
struct ZarrImage {
  std::vector<std::string> axis_names;  ///< in lower case, or none
  std::vector<ZarrDataset> datasets;    ///< the first has the full resolution
};

/// Parses the multiscales of a group.
/// \param text .zattrs of version 2, or zarr.json
/// \return std::nullopt if there are none
/// \throws InputError if they are malformed, or spatial axes have different units
std::optional<ZarrImage> parse_zarr_image(std::string_view text, const std::string& file);

}  // namespace tetwright
