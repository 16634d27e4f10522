// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "tetwright/progress.h"
#include "tetwright/region_grid.h"

namespace tetwright {

/// The labels of a volume and their voxels.
struct LabelRegions {
  /// 0 for labels that were not chosen, i + 1 for counts[i].
  RegionGrid regions;
  /// The chosen labels that occur, ascending, with their numbers of voxels.
  std::vector<std::pair<MaterialTag, std::uint64_t>> counts;
  /// The smallest labels that occur, ascending: at least one more than messages list, beside the outside
  /// label.
  std::vector<MaterialTag> smallest;
  MaterialTag largest = 0;  ///< label that occurs
};

/// Reads a volume by layers of whole blocks and numbers its labels. Beside the result and a layer, which
/// takes two bytes for each voxel, each thread has the labels of a block in memory. The result does not
/// depend on the number of threads.
///
/// \param file file name for messages
/// \param chosen tells which labels get a number; called concurrently
/// \param progress may be null
/// \throws InputError as LabelSource::read() does, for the first block with an error, or for more than 60,000
///   chosen labels
/// \throws OutputError if memory does not suffice
/// \throws Interrupted
LabelRegions read_regions(const LabelSource& source, const std::string& file,
                          const std::function<bool(MaterialTag)>& chosen, const Progress* progress);

}  // namespace tetwright
