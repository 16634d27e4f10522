// SPDX-License-Identifier: Apache-2.0
#include "tetwright/compare.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "common/parallel/parallel_sort.h"

namespace tetwright {

namespace {

constexpr std::size_t tet_grain = 8192;

std::vector<std::pair<Index, Index>> edges_of(const TetMesh& mesh) {
  using Edge = std::pair<Index, Index>;
  std::vector<Edge> edges = parallel_collect<Edge>(
      0, mesh.tets.size(), tet_grain, [&](std::size_t begin, std::size_t end, std::vector<Edge>& out) {
        for (std::size_t t = begin; t < end; ++t)
          for (const auto& e : tet_edges)
            out.push_back(std::minmax({mesh.tets[t][e[0]], mesh.tets[t][e[1]]}));
      });
  parallel_sort_unique(edges);
  return edges;
}

/// Target length of the field, but at most that of the source, since the field is sampled on a grid.
double wanted_at(const Vec3& place, const SizeField& target_length, const SizeSource& source) {
  const SizeLimits& limits = target_length.limits();
  const double of_field = target_length.at(place);
  const std::optional<WantedLength> given = source.at(place);
  if (!given) return of_field;
  return std::min(of_field, std::clamp(given->length, limits.min_edge, limits.max_edge) +
                                limits.grading * given->distance);
}

}  // namespace

EdgeLengthReport compare_edge_lengths(const TetMesh& mesh, const SizeField* target_length,
                                      const SizeSource* source, double min_edge, double max_edge) {
  EdgeLengthReport report;
  std::vector<double> ratios;
  const auto offend = [](EdgeLengthReport::Offender& worst, double length, const Vec3& place, bool worse) {
    ++worst.count;
    if (worst.count > 1 && !worse) return;
    worst.length = length;
    worst.place = place;
  };
  for (const auto& [a, b] : edges_of(mesh)) {
    const Vec3 middle = (mesh.points[a] + mesh.points[b]) / 2;
    const double length = (mesh.points[a] - mesh.points[b]).norm();
    report.shortest = report.edges == 0 ? length : std::min(report.shortest, length);
    report.longest = std::max(report.longest, length);
    ++report.edges;
    if (length > max_edge) offend(report.above_max, length, middle, length > report.above_max.length);
    if (length < min_edge) offend(report.below_min, length, middle, length < report.below_min.length);
    if (!target_length) continue;
    ratios.push_back(length / wanted_at(middle, *target_length, *source));
    report.within += ratios.back() <= edge_length_factor && ratios.back() >= 1 / edge_length_factor;
  }
  report.with_target_length = ratios.size();
  if (ratios.empty()) return report;
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  report.median = *middle;
  return report;
}

}  // namespace tetwright
