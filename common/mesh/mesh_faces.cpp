// SPDX-License-Identifier: Apache-2.0
#include "common/mesh/mesh_faces.h"

#include "common/error.h"
#include "common/mesh/face_buckets.h"
#include "common/parallel/parallel_sort.h"

namespace tetwright {

namespace {

constexpr std::size_t vertex_grain = 4096;  ///< vertices for each task of a parallel loop

template <class Code>
std::vector<MeshFace> collect_faces(std::span<const Tet> tets, std::size_t points,
                                    const std::vector<std::uint8_t>* candidates) {
  const auto tet_at = [&](std::size_t t) -> const Tet& { return tets[t]; };
  const FaceBuckets<Code> buckets(tets.size(), points, tet_at, candidates);
  using Use = typename FaceBuckets<Code>::Use;
  return parallel_collect<MeshFace>(
      0, points, vertex_grain, [&](std::size_t begin, std::size_t end, std::vector<MeshFace>& out) {
        typename FaceBuckets<Code>::Workspace ws;
        for (std::size_t p = begin; p < end; ++p)
          buckets.visit(static_cast<Index>(p), tet_at, ws,
                        [&](const Triangle& vertices, std::span<const Use> uses) {
                          out.push_back({vertices, uses[0].tet, uses.size() > 1 ? uses[1].tet : no_index,
                                         static_cast<std::uint32_t>(uses.size())});
                        });
      });
}

}  // namespace

std::vector<MeshFace> mesh_faces(std::span<const Tet> tets, std::size_t points,
                                 const std::vector<std::uint8_t>* candidates) {
  TETWRIGHT_CHECK(tets.size() < no_index);
  TETWRIGHT_CHECK(!candidates || candidates->size() == points);
  return tets.size() < no_index / 4 ? collect_faces<std::uint32_t>(tets, points, candidates)
                                    : collect_faces<std::uint64_t>(tets, points, candidates);
}

}  // namespace tetwright
