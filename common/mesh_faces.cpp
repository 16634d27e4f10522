#include "common/mesh_faces.h"

#include <algorithm>
#include <tuple>

#include "common/error.h"
#include "common/parallel.h"

namespace tetwright {

namespace {

/// A face in the bucket of its smallest vertex.
struct FaceEntry {
  Index middle, largest, tet;
  bool operator<(const FaceEntry& other) const {
    return std::tie(middle, largest, tet) < std::tie(other.middle, other.largest, other.tet);
  }
};

Triangle sorted_face(const Tet& tet, int k) {
  Triangle f{tet[tet_faces[k][0]], tet[tet_faces[k][1]], tet[tet_faces[k][2]]};
  if (f[0] > f[1]) std::swap(f[0], f[1]);
  if (f[1] > f[2]) std::swap(f[1], f[2]);
  if (f[0] > f[1]) std::swap(f[0], f[1]);
  return f;
}

/// Calls `body(face, tet)` for the faces of every tet, as sorted_face() gives them; with `candidates` for
/// those of three flagged points.
template <class Body>
void for_each_face(std::span<const Tet> tets, const std::vector<std::uint8_t>* candidates, Body&& body) {
  for (std::size_t t = 0; t < tets.size(); ++t) {
    const Tet& tet = tets[t];
    std::array<bool, 4> flagged{true, true, true, true};
    if (candidates)
      for (int k = 0; k < 4; ++k) flagged[k] = (*candidates)[tet[k]] != 0;
    const int missing = 4 - flagged[0] - flagged[1] - flagged[2] - flagged[3];
    if (missing > 1) continue;
    // A face lies opposite its number: without a flag, only the one that does without that point is left.
    for (int k = 0; k < 4; ++k)
      if (missing == 0 || !flagged[k]) body(sorted_face(tet, k), t);
  }
}

constexpr std::size_t points_per_part = 4096;

}  // namespace

std::vector<MeshFace> mesh_faces(std::span<const Tet> tets, std::size_t points,
                                 const std::vector<std::uint8_t>* candidates) {
  TETWRIGHT_CHECK(tets.size() < no_index);
  TETWRIGHT_CHECK(!candidates || candidates->size() == points);
  // A bucket for each smallest vertex, filled by counting: sorting is then local and cheap.
  std::vector<std::size_t> begin(points + 2, 0);
  for_each_face(tets, candidates, [&](const Triangle& f, std::size_t) { ++begin[f[0] + std::size_t{2}]; });
  for (std::size_t i = 2; i < begin.size(); ++i) begin[i] += begin[i - 1];
  std::vector<FaceEntry> entries(begin.back());
  for_each_face(tets, candidates, [&](const Triangle& f, std::size_t t) {
    entries[begin[f[0] + std::size_t{1}]++] = {f[1], f[2], static_cast<Index>(t)};
  });

  const std::size_t parts = (points + points_per_part - 1) / points_per_part;
  std::vector<std::size_t> part_begin(parts + 1, 0);
  const auto same = [](const FaceEntry& a, const FaceEntry& b) {
    return a.middle == b.middle && a.largest == b.largest;
  };
  parallel_chunks(parts, [&](std::size_t part, unsigned) {
    std::size_t faces = 0;
    const std::size_t last = std::min(points, (part + 1) * points_per_part);
    for (std::size_t p = part * points_per_part; p < last; ++p) {
      std::sort(entries.begin() + static_cast<std::ptrdiff_t>(begin[p]),
                entries.begin() + static_cast<std::ptrdiff_t>(begin[p + 1]));
      for (std::size_t i = begin[p]; i < begin[p + 1]; ++i)
        faces += i == begin[p] || !same(entries[i - 1], entries[i]);
    }
    part_begin[part + 1] = faces;
  });
  for (std::size_t part = 0; part < parts; ++part) part_begin[part + 1] += part_begin[part];

  std::vector<MeshFace> faces(part_begin[parts]);
  parallel_chunks(parts, [&](std::size_t part, unsigned) {
    std::size_t out = part_begin[part];
    const std::size_t last = std::min(points, (part + 1) * points_per_part);
    for (std::size_t p = part * points_per_part; p < last; ++p)
      for (std::size_t i = begin[p]; i < begin[p + 1];) {
        std::size_t end = i + 1;
        while (end < begin[p + 1] && same(entries[i], entries[end])) ++end;
        faces[out++] = {{static_cast<Index>(p), entries[i].middle, entries[i].largest},
                        entries[i].tet,
                        end > i + 1 ? entries[i + 1].tet : no_index,
                        static_cast<std::uint32_t>(end - i)};
        i = end;
      }
  });
  return faces;
}

}  // namespace tetwright
