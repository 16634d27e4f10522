#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/progress.h"
#include "mesher/label_input.h"
#include "mesher/label_smoothing.h"

namespace tetwright {

/// The distances of LabelSmoother for a whole volume, in blocks of 8 x 8 x 8 cells between nodes. Node (0, 0,
/// 0) is `padding` voxels before the first voxel along each axis: as far as smoothing carries a label beyond
/// the volume.
struct LabelBlocks {
  static constexpr int padding = 4;
  static constexpr int cells = 8, nodes = cells + 1, volume = nodes * nodes * nodes;
  /// Distances are kept as 16-bit whole numbers of this many to a voxel: finer than any decision.
  static constexpr float units_per_voxel = 15000;
  static constexpr auto band_units = static_cast<std::int16_t>(LabelSmoother::band * units_per_voxel);

  /// The labels that come near a block are channels first, first + 1, ...; none where one label is alone.
  struct Block {
    std::uint32_t first = 0;
    std::uint16_t count = 0;
    RegionIndex alone = outside_region;
  };

  std::array<int, 3> counts{};  ///< blocks along each axis
  std::vector<Block> blocks;    ///< x fastest
  std::vector<RegionIndex> channels;
  std::vector<std::int16_t> values;  ///< `volume` for each channel, x fastest

  const Block& block(int x, int y, int z) const {
    return blocks[(static_cast<std::size_t>(z) * counts[1] + y) * counts[0] + x];
  }
  const std::int16_t* channel(std::uint32_t number) const {
    return values.data() + static_cast<std::size_t>(number) * volume;
  }
};

/// Smooths all labels, and grows or shrinks those whose volume is off by it, in a few rounds. In parallel
/// over tiles; the same for any number of threads. Throws Interrupted.
LabelBlocks make_label_blocks(const PreparedLabels& labels, const Progress* progress);

}  // namespace tetwright
