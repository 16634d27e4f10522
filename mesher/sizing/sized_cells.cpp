// SPDX-License-Identifier: Apache-2.0
#include "mesher/sizing/sized_cells.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/message_text.h"
#include "common/parallel/parallel_sort.h"
#include "mesher/tuning/domain_tuning.h"
#include "mesher/tuning/estimate_tuning.h"
#include "mesher/tuning/lattice_tuning.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

std::vector<MortonKey> root_cells(const GridFrame& frame) {
  std::vector<MortonKey> cells;
  std::array<int, 3> size;
  for (int a = 0; a < 3; ++a) size[a] = frame.cells[a] >> frame.root_level;
  for (int z = 0; z < size[2]; ++z)
    for (int y = 0; y < size[1]; ++y)
      for (int x = 0; x < size[0]; ++x) cells.push_back(morton_encode(x, y, z));
  return cells;
}

}  // namespace

RefinementRegions find_sized_cells(const MaterialField& field, const MaxCell& max_cell, bool outside,
                                   Progress* progress) {
  const GridFrame& frame = field.frame();
  // Test at the centre and the corners: lengths vary slowly, so they are not much smaller in between.
  const auto too_large = [&](const Vec3& centre, double side) {
    const auto asks = [&](const Vec3& at) { return side * frame.cell_size > max_cell(frame.to_input(at)); };
    if (asks(centre)) return true;
    for (int k = 0; k < 8; ++k)
      if (asks(centre + side * (Vec3(k & 1, k >> 1 & 1, k >> 2) - Vec3::Constant(0.5)))) return true;
    return false;
  };
  std::vector<std::vector<MortonKey>> split_by_step;  // starting at the root cells
  std::vector<MortonKey> cells = root_cells(frame);
  double total = 0;
  for (int level = frame.root_level; level > -DomainTuning::Refinement::max_levels && !cells.empty();
       --level) {
    if (progress) progress->throw_if_stopped();
    const double side = std::ldexp(1, level);  // voxels
    std::vector<MortonKey> split = parallel_collect<MortonKey>(
        0, cells.size(), LatticeGrains::sized_cells,
        [&](std::size_t begin, std::size_t end, std::vector<MortonKey>& out) {
          const std::unique_ptr<FieldSampler> sampler = field.sampler();
          for (std::size_t i = begin; i < end; ++i) {
            const std::array<int, 3> low = morton_decode(cells[i]);
            const Vec3 centre = side * (Vec3(low[0], low[1], low[2]) + Vec3::Constant(0.5));
            if (!too_large(centre, side)) continue;
            const NearestRegion there = sampler->nearest(centre);
            const bool whole = there.margin >= std::min(half_cube_diagonal * side, field.band());
            const bool small = half_cube_diagonal * side <= field.band();
            if (!outside && there.region == outside_region && whole && small) continue;
            if (level <= 0 && !whole) continue;
            out.push_back(cells[i]);
          }
        });
    total += 8 * static_cast<double>(split.size());
    require_memory(
        EstimateTuning::Memory::program + EstimateTuning::Memory::per_leaf * total,
        "cells of " + short_number(side / 2 * frame.cell_size) + ", for edges as short as requested,",
        "give a larger --max-edge, or larger sizes");
    cells.clear();
    for (const MortonKey key : split)
      for (MortonKey k = 0; k < 8; ++k) cells.push_back(key << 3 | k);
    split_by_step.push_back(std::move(split));
  }
  while (!split_by_step.empty() && split_by_step.back().empty()) split_by_step.pop_back();
  RefinementRegions finer;
  const int steps = static_cast<int>(split_by_step.size());
  // The cells of the last step are of level root_level - steps + 1 above a voxel.
  finer.refinement = std::max(0, steps - frame.root_level);
  finer.cells.resize(static_cast<std::size_t>(frame.root_level + finer.refinement) + 1);
  for (int step = 0; step < steps; ++step)
    finer.cells[static_cast<std::size_t>(frame.root_level + finer.refinement - step)] =
        std::move(split_by_step[static_cast<std::size_t>(step)]);
  return finer;
}

}  // namespace tetwright
