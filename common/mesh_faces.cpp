#include "common/mesh_faces.h"

#include <algorithm>
#include <tuple>

#include "common/error.h"
#include "common/parallel.h"

namespace tetwright {

namespace {

/// A face in the bucket of its smallest vertex.
struct Entry {
  Index middle, largest, tet;
  bool operator<(const Entry& other) const {
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

constexpr std::size_t points_per_part = 4096;

}  // namespace

std::vector<MeshFace> mesh_faces(std::span<const Tet> tets, std::size_t points) {
  TETWRIGHT_CHECK(tets.size() < no_index);
  // A bucket for each smallest vertex, filled by counting: sorting is then local and cheap.
  std::vector<std::size_t> begin(points + 2, 0);
  for (const Tet& tet : tets)
    for (int k = 0; k < 4; ++k) ++begin[sorted_face(tet, k)[0] + 2];
  for (std::size_t i = 2; i < begin.size(); ++i) begin[i] += begin[i - 1];
  std::vector<Entry> entries(4 * tets.size());
  for (std::size_t t = 0; t < tets.size(); ++t)
    for (int k = 0; k < 4; ++k) {
      const Triangle f = sorted_face(tets[t], k);
      entries[begin[f[0] + 1]++] = {f[1], f[2], static_cast<Index>(t)};
    }

  const std::size_t parts = (points + points_per_part - 1) / points_per_part;
  std::vector<std::size_t> part_begin(parts + 1, 0);
  const auto same = [](const Entry& a, const Entry& b) {
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
