// SPDX-License-Identifier: Apache-2.0
#include "mesher/lattice/star_map.h"

#include <algorithm>
#include <atomic>
#include <span>

#include "mesher/tuning/lattice_tuning.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

void append_steps(std::span<const Index> ascending, std::vector<std::uint8_t>& out) {
  Index before = 0;
  for (Index i : ascending) {
    Index step = i - before;
    for (; step >= 0x80; step >>= 7) out.push_back(static_cast<std::uint8_t>(step | 0x80));
    out.push_back(static_cast<std::uint8_t>(step));
    before = i;
  }
}

}  // namespace

StarMap::StarMap(std::vector<Index> points, std::size_t point_count, const TetList& tets)
    : points_(std::move(points)) {
  slots_.assign(point_count, no_index);
  for (Index i = 0; i < points_.size(); ++i) slots_[points_[i]] = i;
  // Rows are counted, filled by threads in any order, then sorted, so the result does not depend on that
  // order.
  std::vector<Index> counts(points_.size(), 0);
  const auto for_each_corner = [&](std::size_t first, std::size_t last, auto&& body) {
    parallel_for(0, tets.size(), LatticeGrains::tets, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        for (Index v : tets[i])
          if (const Index s = slots_[v]; s >= first && s < last)
            body(std::atomic_ref<Index>(counts[s]).fetch_add(1, std::memory_order_relaxed), s, i);
    });
  };
  for_each_corner(0, points_.size(), [](Index, Index, std::size_t) {});

  const std::size_t chunks = (points_.size() + chunk_rows - 1) / chunk_rows;
  chunks_.resize(chunks);
  offsets_.resize(points_.size() + chunks);
  for (std::size_t pass = 0; pass < LatticeTuning::StarMap::passes; ++pass) {
    const std::size_t first_chunk = chunks * pass / LatticeTuning::StarMap::passes,
                      last_chunk = chunks * (pass + 1) / LatticeTuning::StarMap::passes;
    const std::size_t first = first_chunk * chunk_rows,
                      last = std::min(points_.size(), last_chunk * chunk_rows);
    if (first >= last) continue;
    std::vector<std::size_t> starts(last - first + 1, 0);
    for (std::size_t s = first; s < last; ++s) {
      starts[s - first + 1] = starts[s - first] + counts[s];
      counts[s] = 0;
    }
    std::vector<Index> rows(starts.back());
    for_each_corner(first, last, [&](Index place, Index s, std::size_t i) {
      rows[starts[s - first] + place] = static_cast<Index>(i);
    });
    parallel_for(first_chunk, last_chunk, 1, [&](std::size_t begin, std::size_t end) {
      std::vector<std::uint8_t> bytes;
      for (std::size_t chunk = begin; chunk < end; ++chunk) {
        bytes.clear();
        std::size_t s = chunk * chunk_rows;
        for (; s < std::min(last, (chunk + 1) * chunk_rows); ++s) {
          const std::span<Index> row(rows.data() + starts[s - first], rows.data() + starts[s - first + 1]);
          std::sort(row.begin(), row.end());
          offsets_[s + chunk] = static_cast<std::uint32_t>(bytes.size());
          append_steps(row, bytes);
        }
        offsets_[s + chunk] = static_cast<std::uint32_t>(bytes.size());
        bytes.push_back(0);
        chunks_[chunk].assign(bytes.begin(), bytes.end());
      }
    });
  }
}

}  // namespace tetwright
