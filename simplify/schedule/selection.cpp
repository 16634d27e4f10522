// SPDX-License-Identifier: Apache-2.0
#include "simplify/schedule/selection.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <tuple>

#include "common/parallel/parallel_sort.h"
#include "common/tolerances.h"
#include "simplify/tuning/tuning.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

using Grains = SimplifyTuning::Grains;

/// The live tets that pass the test, in the order of the curve.
template <class Test>
std::vector<TetSnapshot> tets_where(const EditableMesh& mesh, const Test& test) {
  return parallel_collect<TetSnapshot>(
      0, mesh.tet_slots(), Grains::slots,
      [&](std::size_t begin, std::size_t end, std::vector<TetSnapshot>& out) {
        for (std::size_t i = begin; i < end; ++i) {
          const auto t = static_cast<Index>(i);
          if (!mesh.dead(t) && test(t)) out.push_back({t, mesh.points(t)});
        }
      });
}

/// The points for which mark(tet, slot in it) is true for some tet.
template <class Mark>
std::vector<Index> marked_points(const EditableMesh& mesh, const Mark& mark) {
  std::vector<std::uint8_t> marks(mesh.point_slots(), 0);
  parallel_for(0, mesh.tet_slots(), Grains::slots, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto t = static_cast<Index>(i);
      if (mesh.dead(t)) continue;
      // Relaxed: all threads write the same value, which is read after the loop.
      for (int k = 0; k < 4; ++k)
        if (mark(t, k))
          std::atomic_ref<std::uint8_t>(marks[mesh.points(t)[k]]).store(1, std::memory_order_relaxed);
    }
  });
  return parallel_collect<Index>(0, marks.size(), Grains::slots,
                                 [&](std::size_t begin, std::size_t end, std::vector<Index>& out) {
                                   for (std::size_t p = begin; p < end; ++p)
                                     if (marks[p]) out.push_back(static_cast<Index>(p));
                                 });
}

/// By point: 1 if it is a vertex of a listed tet.
std::vector<std::uint8_t> points_of(const EditableMesh& mesh, const std::vector<TetSnapshot>& tets) {
  std::vector<std::uint8_t> listed(mesh.point_slots(), 0);
  for (const TetSnapshot& t : tets)
    for (Index p : t.points) listed[p] = 1;
  return listed;
}

}  // namespace

float quality_cutoff(const EditableMesh& mesh, double percent) {
  // Bit patterns of floats in [0, 1] ascend with their values: a histogram of their upper halves finds the
  // bin, and only the bin's tets are read again.
  constexpr std::size_t bins = 1 << 14;
  const auto bin = [](float q) { return std::bit_cast<std::uint32_t>(q) >> 16; };
  std::vector<std::atomic<std::uint32_t>> shared(bins);
  std::atomic<std::size_t> alive{0};
  parallel_for(0, mesh.tet_slots(), 16 * Grains::slots, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> counts(bins, 0);
    std::size_t count = 0;
    for (std::size_t t = begin; t < end; ++t) {
      if (mesh.dead(static_cast<Index>(t))) continue;
      ++counts[bin(mesh.quality(static_cast<Index>(t)))];
      ++count;
    }
    for (std::size_t b = 0; b < bins; ++b)
      if (counts[b]) shared[b].fetch_add(counts[b], std::memory_order_relaxed);
    alive.fetch_add(count, std::memory_order_relaxed);
  });
  if (alive == 0) return 0;
  auto wanted = static_cast<std::size_t>(percent / 100 * static_cast<double>(alive));
  if (wanted >= alive) return 1;
  std::size_t b = 0;
  while (wanted >= shared[b]) wanted -= shared[b++];
  std::vector<float> in_bin = parallel_collect<float>(
      0, mesh.tet_slots(), Grains::slots, [&](std::size_t begin, std::size_t end, std::vector<float>& out) {
        for (std::size_t t = begin; t < end; ++t) {
          const float quality = mesh.quality(static_cast<Index>(t));
          if (!mesh.dead(static_cast<Index>(t)) && bin(quality) == b) out.push_back(quality);
        }
      });
  std::nth_element(in_bin.begin(), in_bin.begin() + static_cast<std::ptrdiff_t>(wanted), in_bin.end());
  return in_bin[wanted];
}

decltype(IterationReport::tets_by_quality) tets_by_quality(const EditableMesh& mesh) {
  using Counts = decltype(IterationReport::tets_by_quality);
  constexpr std::size_t bins = std::tuple_size_v<Counts>;
  // Cubes of the upper ends of all bins but the last, since the mesh stores cubes.
  std::array<float, bins - 1> ends;
  for (std::size_t b = 0; b < ends.size(); ++b) {
    const float end = static_cast<float>(b + 1) / bins;
    ends[b] = end * end * end;
  }
  std::array<std::atomic<std::size_t>, bins> shared{};
  parallel_for(0, mesh.tet_slots(), 16 * Grains::slots, [&](std::size_t begin, std::size_t end) {
    Counts counts{};
    for (std::size_t i = begin; i < end; ++i) {
      const auto t = static_cast<Index>(i);
      if (!mesh.dead(t)) ++counts[std::upper_bound(ends.begin(), ends.end(), mesh.quality(t)) - ends.begin()];
    }
    for (std::size_t b = 0; b < bins; ++b) shared[b].fetch_add(counts[b], std::memory_order_relaxed);
  });
  Counts counts{};
  for (std::size_t b = 0; b < bins; ++b) counts[b] = shared[b];
  return counts;
}

std::vector<TetSnapshot> bad_tets(const EditableMesh& mesh, float limit) {
  return tets_where(mesh, [&](Index t) { return mesh.quality(t) <= limit; });
}

std::vector<Index> bad_points(const EditableMesh& mesh, float limit) {
  return marked_points(mesh, [&](Index t, int) { return mesh.quality(t) <= limit; });
}

double share_below(const EditableMesh& mesh, const Objective& objective, double angle) {
  Objective shape = objective;
  shape.kind = Objective::Kind::shape;
  const auto bound = static_cast<float>(shape_quality_bound(shape.shape, angle));
  const auto below = tets_where(mesh, [&](Index t) {
    const Tet& p = mesh.points(t);
    return shape(mesh.position(p[0]), mesh.position(p[1]), mesh.position(p[2]), mesh.position(p[3])) < bound;
  });
  return static_cast<double>(below.size()) / static_cast<double>(std::max<std::size_t>(1, mesh.live_tets()));
}

std::vector<TetSnapshot> tets_around(const EditableMesh& mesh, const std::vector<TetSnapshot>& tets) {
  const std::vector<std::uint8_t> listed = points_of(mesh, tets);
  return tets_where(mesh, [&](Index t) {
    const Tet& points = mesh.points(t);
    return std::any_of(points.begin(), points.end(), [&](Index p) { return listed[p] != 0; });
  });
}

std::vector<Index> points_around(const EditableMesh& mesh, const std::vector<TetSnapshot>& tets) {
  const std::vector<std::uint8_t> listed = points_of(mesh, tets);
  return marked_points(mesh, [&](Index t, int) {
    const Tet& points = mesh.points(t);
    return std::any_of(points.begin(), points.end(), [&](Index p) { return listed[p] != 0; });
  });
}

std::vector<Index> interface_points(const EditableMesh& mesh, const std::function<bool(RegionId)>& wanted) {
  std::vector<std::uint8_t> is_wanted(mesh.region_count());
  for (std::size_t r = 0; r < is_wanted.size(); ++r) is_wanted[r] = wanted(static_cast<RegionId>(r)) ? 1 : 0;
  return marked_points(mesh, [&](Index t, int k) {
    if (!is_wanted[mesh.region(t)]) return false;
    for (int f = 0; f < 4; ++f)
      if (f != k && mesh.link(t, f).is_interface()) return true;
    return false;
  });
}

std::vector<Index> points_off_features(const EditableMesh& mesh, const SurfaceGrid& grid,
                                       const SurfaceProjection& projection) {
  const PatchId first_body_patch = projection.first_body_patch();
  // By point: min and max patch of its boundary faces, or of its faces on bodies among labels.
  constexpr std::uint32_t no_patch = 0xffffffff;
  std::vector<std::uint32_t> smallest(mesh.point_slots(), no_patch), largest(mesh.point_slots(), 0);
  std::vector<std::uint8_t> third(mesh.point_slots(), 0);  // whether the point has a third patch
  for (std::size_t i = 0; i < mesh.tet_slots(); ++i) {
    const auto t = static_cast<Index>(i);
    if (mesh.dead(t)) continue;
    for (int f = 0; f < 4; ++f) {
      const FaceLink link = mesh.link(t, f);
      if (!(first_body_patch == 0 ? link.is_outside() : link.is_interface())) continue;
      if (!link.is_outside() && link.tet() < t) continue;  // the face's other side
      const Triangle face = face_of(mesh.points(t), f);
      const std::uint32_t patch = link.is_outside() ? link.patch() : grid.patch(mesh, face);
      if (patch < first_body_patch) continue;
      for (const Index p : face) {
        const std::uint32_t low = smallest[p], high = largest[p];
        third[p] |= low != no_patch && low != high && patch != low && patch != high;
        smallest[p] = std::min(low, patch);
        largest[p] = std::max(high, patch);
      }
    }
  }
  return parallel_collect<Index>(
      0, smallest.size(), Grains::slots, [&](std::size_t begin, std::size_t end, std::vector<Index>& out) {
        for (std::size_t p = begin; p < end; ++p) {
          if (smallest[p] == no_patch || smallest[p] == largest[p]) continue;
          // Nearly all points pass this test.
          const Vec3& at = mesh.position(static_cast<Index>(p));
          if (!(third[p]                ? projection.onto_corner(at, tolerance::flat_patch)
                : first_body_patch != 0 ? projection.onto_crease(at, tolerance::flat_patch)
                                        : projection.onto_curve(at, tolerance::flat_patch)))
            out.push_back(static_cast<Index>(p));
        }
      });
}

std::vector<TetSnapshot> tets_with_faces(const EditableMesh& mesh, const std::vector<Triangle>& faces) {
  return tets_where(mesh, [&](Index t) {
    for (int f = 0; f < 4; ++f)
      if (mesh.link(t, f).is_interface() &&
          std::binary_search(faces.begin(), faces.end(), face_key(face_of(mesh.points(t), f))))
        return true;
    return false;
  });
}

}  // namespace tetwright
