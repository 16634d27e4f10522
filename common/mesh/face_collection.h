// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/face_buckets.h"
#include "common/parallel/parallel_sort.h"
#include "tetwright/error.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Calls `body(vertices, first, second, count, out)` for each face of the tets, in parallel: its vertices in
/// ascending order, its first two tets (no_index if there is no second) and the number of its tets. `out` is
/// a vector to append to. \param candidates a flag for each point: only faces of three flagged points are
/// listed; null: all faces \return what the bodies appended, in lexicographic order of the vertices
template <class T, class Body>
std::vector<T> collect_from_faces(std::span<const Tet> tets, std::size_t points,
                                  const std::vector<std::uint8_t>* candidates, const Body& body) {
  TETWRIGHT_CHECK(tets.size() < no_index);
  TETWRIGHT_CHECK(!candidates || candidates->size() == points);
  constexpr std::size_t vertex_grain = 4096;  // vertices for each task
  const auto tet_at = [&](std::size_t t) -> const Tet& { return tets[t]; };
  const auto collect = [&]<class Code>(Code) {
    const FaceBuckets<Code> buckets(tets.size(), points, tet_at, candidates);
    using Use = typename FaceBuckets<Code>::Use;
    return parallel_collect<T>(
        0, points, vertex_grain, [&](std::size_t begin, std::size_t end, std::vector<T>& out) {
          typename FaceBuckets<Code>::Workspace ws;
          for (std::size_t p = begin; p < end; ++p)
            buckets.visit(
                static_cast<Index>(p), tet_at, ws, [&](const Triangle& vertices, std::span<const Use> uses) {
                  body(vertices, uses[0].tet, uses.size() > 1 ? uses[1].tet : no_index, uses.size(), out);
                });
        });
  };
  return tets.size() < no_index / 4 ? collect(std::uint32_t{}) : collect(std::uint64_t{});
}

}  // namespace tetwright
