// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "tetwright/label_source.h"

namespace tetwright {

/// Reads the values of a box of voxels for arrays that read_whole() returns: `first` and those that follow.
template <class Value>
using BoxReader = std::function<void(const VoxelIndex& low, const VoxelIndex& high, std::size_t first,
                                     std::span<const std::span<Value>> out)>;

/// Reads all voxels of a source into arrays, decoding blocks in parallel. `Value` is MaterialTag or float.
/// \param arrays at least 1; all of a box are read at once if the source stores slices, else one after the
///   other
/// \param file file name for messages
/// \param what the values for messages: "labels"
/// \param read is called concurrently
/// \throws InputError if there are more than max_volume_voxels values, and as `read` does: the error of the
///   first box that has one, for any number of threads
/// \throws OutputError if the values, and the blocks that threads decode at a time, exceed
///   available_memory()
template <class Value>
std::vector<std::vector<Value>> read_whole(const LabelSource& source, std::size_t arrays,
                                           const std::string& file, const std::string& what,
                                           const BoxReader<Value>& read);

}  // namespace tetwright
