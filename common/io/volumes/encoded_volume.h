// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "common/io/encodings/byte_source.h"
#include "common/io/text/text_scanner.h"
#include "common/io/volumes/data_file.h"
#include "common/io/volumes/voxel_data.h"
#include "tetwright/image_volume.h"
#include "tetwright/label_volume.h"

namespace tetwright {

/// A volume whose header was read, and whose voxels follow in one piece: raw, compressed or text.
struct EncodedVolume {
  LabelGrid grid;
  ChannelAxis channels;
  VoxelFormat format;  ///< of voxels that are not text
  /// Begins with the first voxel. Refers to the bytes of the file that was read, or to `other_file`.
  std::variant<ByteSource, TextScanner> body;
  std::shared_ptr<const std::string> other_file = nullptr;  ///< bytes of a file with the voxels alone
};

/// Reads the header of a volume.
/// \param bytes must outlive the result
/// \param name file name for messages
/// \param others reads other files that the header names
/// \throws InputError for malformed headers, and if the volume has several channels and labels are wanted
using VolumeReader = EncodedVolume (*)(std::string_view bytes, const std::string& name,
                                       const FileReader& others, VoxelUse use);

/// Reads the voxels as labels.
/// \pre one channel
/// \throws InputError as read_voxels() does
LabelVolume labels_of(EncodedVolume volume);

/// Reads the voxels as values of an image.
/// \throws InputError as read_voxels() does
/// \throws OutputError if the values exceed available_memory()
ImageVolume image_of(EncodedVolume volume);

/// Reads the labels of each channel.
std::vector<std::vector<MaterialTag>> labels_of_channels(EncodedVolume volume);

}  // namespace tetwright
