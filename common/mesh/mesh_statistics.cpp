// SPDX-License-Identifier: Apache-2.0
#include "tetwright/mesh_quality.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/geometry/predicates.h"
#include "common/mesh/dihedral_counter.h"
#include "common/parallel/parallel_sort.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

/// Fixed, so that rounding of the sums does not depend on the number of threads.
constexpr std::size_t statistics_grain = 1 << 14;

struct PartStatistics {
  std::map<MaterialTag, MaterialStatistics> materials;
  double min_angle = std::numeric_limits<double>::infinity();
  double sum_angle = 0;
  std::size_t below = 0;
  DihedralCounter dihedrals;
};

std::uint8_t angle_bin(double angle) {
  static_assert(QualityHistogram::angle_bins <= 256);
  return static_cast<std::uint8_t>(std::min(QualityHistogram::angle_bins - 1,
                                            static_cast<std::size_t>(angle / QualityHistogram::angle_step)));
}

/// Lower ends of all bins but the first, relative to the mean volume. Half steps are factors of sqrt(2); no
/// logarithm is needed.
std::array<double, QualityHistogram::volume_bins - 1> volume_limits() {
  std::array<double, QualityHistogram::volume_bins - 1> limits;
  for (std::size_t i = 0; i < limits.size(); ++i)
    limits[i] = std::ldexp(QualityHistogram::min_relative_volume * ((i + 1) % 2 ? std::sqrt(2.0) : 1.0),
                           static_cast<int>((i + 1) / 2));
  return limits;
}

/// Six times the volume: integer coordinates then add up without rounding.
double volume_six_times(const TetMesh& mesh, const Tet& t) {
  return orient3d_value(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]);
}

/// Histogram by smallest solid angle and by volume relative to the mean.
QualityHistogram histogram(const TetMesh& mesh, const std::vector<std::uint8_t>& bin_of_angle, double mean) {
  const auto limits = volume_limits();
  std::vector<QualityHistogram> parts(thread_count());
  parallel_chunks((mesh.tets.size() + statistics_grain - 1) / statistics_grain, [&](std::size_t p,
                                                                                    unsigned worker) {
    const std::size_t last = std::min(mesh.tets.size(), (p + 1) * statistics_grain);
    for (std::size_t t = p * statistics_grain; t < last; ++t) {
      const double relative = mean > 0 ? volume_six_times(mesh, mesh.tets[t]) / 6 / mean : 0.0;
      const auto bin =
          static_cast<std::size_t>(std::upper_bound(limits.begin(), limits.end(), relative) - limits.begin());
      ++parts[worker].counts[bin_of_angle[t]][bin];
    }
  });
  QualityHistogram all;
  for (const QualityHistogram& part : parts)
    for (std::size_t a = 0; a < QualityHistogram::angle_bins; ++a)
      for (std::size_t v = 0; v < QualityHistogram::volume_bins; ++v) all.counts[a][v] += part.counts[a][v];
  return all;
}

void count_interfaces(const TetMesh& mesh, MeshStatistics& out) {
  const std::vector<InterfaceTriangle>& triangles = mesh.interfaces;
  using Pairs = std::map<MaterialPair, InterfaceStatistics>;
  std::vector<Pairs> parts((triangles.size() + statistics_grain - 1) / statistics_grain);
  std::vector<std::uint64_t> edges(3 * triangles.size());  // smaller id in the upper 32 bits
  parallel_chunks(parts.size(), [&](std::size_t p, unsigned) {
    Pairs::value_type* last_pair = nullptr;
    const std::size_t last = std::min(triangles.size(), (p + 1) * statistics_grain);
    for (std::size_t i = p * statistics_grain; i < last; ++i) {
      const InterfaceTriangle& t = triangles[i];
      const Vec3& a = mesh.points[t.ids[0]];
      if (!last_pair || last_pair->first != t.pair()) last_pair = &*parts[p].try_emplace(t.pair()).first;
      ++last_pair->second.triangles;
      last_pair->second.area += 0.5 * (mesh.points[t.ids[1]] - a).cross(mesh.points[t.ids[2]] - a).norm();
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [low, high] = std::minmax(t.ids[k], t.ids[(k + 1) % 3]);
        edges[3 * i + k] = std::uint64_t{low} << 32 | high;
      }
    }
  });
  for (const Pairs& part : parts)
    for (const auto& [pair, statistics] : part) {
      out.interfaces[pair].triangles += statistics.triangles;
      out.interfaces[pair].area += statistics.area;
    }
  std::erase_if(out.interfaces, [](const auto& known) { return known.first.first == known.first.second; });
  out.sheets = sheet_statistics(mesh);
  parallel_sort(edges);
  for (std::size_t i = 0; i + 2 < edges.size(); ++i)
    out.junction_edges += edges[i] == edges[i + 2] && (i == 0 || edges[i - 1] != edges[i]);
}

}  // namespace

MeshStatistics mesh_statistics(const TetMesh& mesh, double threshold) {
  MeshStatistics out;
  out.tets = mesh.tets.size();
  out.points = mesh.points.size();
  count_interfaces(mesh, out);
  if (mesh.tets.empty()) return out;

  std::vector<std::uint8_t> bin_of_angle(mesh.tets.size());
  std::vector<PartStatistics> parts((mesh.tets.size() + statistics_grain - 1) / statistics_grain);
  parallel_chunks(parts.size(), [&](std::size_t p, unsigned) {
    PartStatistics& part = parts[p];
    MaterialStatistics* material = nullptr;
    MaterialTag tag = 0;
    const std::size_t last = std::min(mesh.tets.size(), (p + 1) * statistics_grain);
    for (std::size_t t = p * statistics_grain; t < last; ++t) {
      const Tet& v = mesh.tets[t];
      const std::array<Vec3, 4> x{mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]], mesh.points[v[3]]};
      const double volume = volume_six_times(mesh, v);
      double angle = orient3d(x[0], x[1], x[2], x[3]) > 0 ? min_solid_angle(x[0], x[1], x[2], x[3]) : 0.0;
      // Coordinates beyond 1e100 overflow; such a tet is useless, so its angle counts as 0.
      if (!std::isfinite(angle)) angle = 0;
      if (!material || tag != mesh.materials[t]) {
        tag = mesh.materials[t];
        material = &part.materials[tag];
      }
      ++material->tets;
      material->volume += volume;
      part.min_angle = std::min(part.min_angle, angle);
      part.sum_angle += angle;
      part.below += angle < threshold;
      part.dihedrals.add(x);
      bin_of_angle[t] = angle_bin(angle);
    }
  });

  PartStatistics all;
  for (const PartStatistics& part : parts) {
    for (const auto& [tag, material] : part.materials) {
      out.materials[tag].tets += material.tets;
      out.materials[tag].volume += material.volume;
    }
    all.min_angle = std::min(all.min_angle, part.min_angle);
    all.sum_angle += part.sum_angle;
    all.below += part.below;
    all.dihedrals.add(part.dihedrals);
  }
  for (auto& [tag, material] : out.materials) {
    out.volume += material.volume;
    material.volume /= 6;
  }
  out.volume /= 6;
  const auto n = static_cast<double>(out.tets);
  out.min_solid_angle = all.min_angle;
  out.mean_solid_angle = all.sum_angle / n;
  out.below_count = all.below;
  out.below_percent = 100 * static_cast<double>(all.below) / n;
  out.dihedrals = all.dihedrals.histogram();
  if (all.dihedrals.min() <= all.dihedrals.max()) {
    out.min_dihedral = all.dihedrals.min();
    out.max_dihedral = all.dihedrals.max();
  }

  out.histogram = histogram(mesh, bin_of_angle, out.volume / n);
  return out;
}

}  // namespace tetwright
