// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesher/labels/label_smoothing.h"
#include "tetwright/mesher_input.h"
#include "tetwright/progress.h"

namespace tetwright {

/// The distances of the regions of a whole volume, those of LabelSmoother or of an image, stored in bricks of
/// 8 x 8 x 8 cells between nodes. Node (0, 0, 0) is `padding` voxels before the first voxel along each axis,
/// so that bricks reach half a voxel beyond the outermost centres, to the border of the volume. Labels
/// continue there as in the outermost voxels, so that the border does not affect surfaces that cross it.
struct LabelBricks {
  static constexpr int padding = 1;
  static constexpr int cells = 8, nodes = cells + 1, volume = nodes * nodes * nodes;
  /// Distances are stored as 16-bit integers with this many units per voxel, finer than any decision needs.
  /// Labels clamp them to the band; an image does not at nodes next to an interface, because that would move
  /// the interface.
  static constexpr float units_of_labels = 15000, units_of_images = 1875;

  /// The labels near a brick have the channels first, first + 1, ...; no channels if the brick has a single
  /// label.
  struct Brick {
    std::uint32_t first = 0;
    std::uint16_t count = 0;
    RegionIndex alone = outside_region;
  };

  float units_per_voxel = units_of_labels;
  std::array<int, 3> counts{};  ///< bricks along each axis
  std::vector<Brick> bricks;    ///< x fastest
  std::vector<RegionIndex> channels;
  std::vector<std::int16_t> values;  ///< `volume` for each channel, x fastest

  /// LabelSmoother::band in units: 31875 for labels.
  std::int16_t band_units() const { return static_cast<std::int16_t>(LabelSmoother::band * units_per_voxel); }
  /// The largest distance that can be stored, voxels.
  double max_distance() const {
    return units_per_voxel == units_of_labels ? LabelSmoother::band : INT16_MAX / units_per_voxel;
  }

  const Brick& brick(int x, int y, int z) const {
    return bricks[(static_cast<std::size_t>(z) * counts[1] + y) * counts[0] + x];
  }
  const std::int16_t* channel(std::uint32_t number) const {
    return values.data() + static_cast<std::size_t>(number) * volume;
  }
};

/// Smooths all labels, then grows or shrinks those whose volume changed, in a few rounds. Parallel over
/// tiles; the result does not depend on the number of threads.
/// \throws InputError for too many labels close together, as in an image of gray values
/// \throws Interrupted
LabelBricks make_label_bricks(const LabelInput& labels, const Progress* progress);

}  // namespace tetwright
