// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "mesher/domain/grid_frame.h"
#include "mesher/domain/narrow_band.h"

namespace tetwright {

class OutputFiles;

/// A level set to be written, read leaf by leaf.
struct LevelSetSource {
  std::string name;
  /// All leaves with grid points within the band or next to the surface, in any order. Space between them
  /// gets the sign of the surrounding leaves.
  std::vector<LeafOrigin> leaves;
  /// Writes the signed distances of a leaf's grid points, finest cells, z fastest. Called concurrently.
  std::function<void(const LeafOrigin&, std::span<float, leaf_points>)> distances;
};

/// Writes a .vdb file of level sets in input units. The file appears complete or not at all (see files.h).
/// The bytes do not depend on the number of threads.
/// \param band_cells finest cells, above 0: distances are true up to this size and clamped to it
/// \param files if given, the file appears when these are committed
/// \throws OutputError if the file cannot be written, or the frame's cells are smaller than OpenVDB's
///   transforms allow (about 1.5e-5 input units)
void write_level_sets(const std::string& file, const GridFrame& frame, double band_cells,
                      std::span<const LevelSetSource> level_sets, OutputFiles* files = nullptr);

}  // namespace tetwright
