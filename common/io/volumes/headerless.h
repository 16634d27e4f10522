// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "common/io/volumes/encoded_volume.h"
#include "common/io/volumes/raw_volume.h"
#include "tetwright/io.h"

namespace tetwright {

/// Describes a file that has voxels alone (.raw).
/// \throws UsageError if the options lack dimensions or type, or are wrong
/// \throws InputError unless the file has exactly the bytes of the voxels
RawVolume headerless_volume(const std::string& file, std::uint64_t file_size,
                            const VolumeFileOptions& options);

/// Describes the bytes of such a file.
EncodedVolume encoded_headerless(std::string_view bytes, const std::string& name,
                                 const VolumeFileOptions& options);

}  // namespace tetwright
