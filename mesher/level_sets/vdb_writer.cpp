// SPDX-License-Identifier: Apache-2.0
#include "mesher/level_sets/vdb_writer.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "common/tolerances.h"
#include "mesher/level_sets/openvdb_grids.h"
#include "mesher/tuning/distance_tuning.h"
#include "tetwright/error.h"
#include "tetwright/files.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

/// Offset of OpenVDB's random identifier of 36 characters, after the magic number, three 32-bit numbers and a
/// flag.
constexpr std::size_t identifier_start = 21, identifier_length = 36;

DistanceGrid make_grid(const GridFrame& frame, double band_cells, const LevelSetSource& source) {
  const auto size = static_cast<float>(frame.cell_size);
  const auto band = static_cast<float>(band_cells);
  const float true_below = band * (1 - tolerance::band_share);
  DistanceGrid grid(size * band);
  std::vector<GridLeaf<float>> leaves;
  leaves.reserve(source.leaves.size());
  for (const LeafOrigin& origin : source.leaves) leaves.push_back(grid.touch_leaf(origin));
  parallel_for(0, leaves.size(), DistanceGrains::band_leaves, [&](std::size_t begin, std::size_t end) {
    std::array<float, leaf_points> values;
    for (std::size_t i = begin; i < end; ++i) {
      source.distances(source.leaves[i], values);
      for (int k = 0; k < leaf_points; ++k)
        if (std::abs(values[k]) < true_below)
          leaves[i].activate(k, size * values[k]);
        else
          leaves[i].values[k] = std::copysign(size * band, values[k]);
    }
  });
  grid.fill_tiles_outside_band(size * band);
  return grid;
}

/// Replaces the random identifier by one that depends only on the rest of the file (FNV-1a).
void settle_identifier(std::string& bytes) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (std::size_t i = 0; i < bytes.size(); ++i)
    if (i < identifier_start || i >= identifier_start + identifier_length)
      hash = (hash ^ static_cast<unsigned char>(bytes[i])) * 0x100000001b3;
  char digits[17] = "0000000000000000";
  std::array<char, 16> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), hash, 16).ptr;
  std::copy_backward(text.data(), end, digits + 16);
  // Random identifiers are written as 8-4-4-4-12 hexadecimal digits.
  std::string identifier = "00000000-0000-0000-0000-000000000000";
  identifier.replace(0, 8, digits, 8);
  identifier.replace(24, 8, digits + 8, 8);
  bytes.replace(identifier_start, identifier_length, identifier);
}

}  // namespace

void write_level_sets(const std::string& file, const GridFrame& frame, double band_cells,
                      std::span<const LevelSetSource> level_sets, OutputFiles* files) {
  std::vector<NamedGrid> grids;
  for (const LevelSetSource& source : level_sets)
    grids.push_back({source.name, make_grid(frame, band_cells, source)});
  std::string bytes;
  try {
    bytes = level_sets_to_vdb(grids, frame);
  } catch (const std::domain_error&) {
    throw OutputError(file + ": OpenVDB has no transform for cells this small; scale the input up");
  }
  settle_identifier(bytes);
  if (files)
    files->write(file, bytes);
  else
    write_file_atomically(file, bytes);
}

}  // namespace tetwright
