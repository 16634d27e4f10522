// SPDX-License-Identifier: Apache-2.0
#include "mesher/labels/label_films.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include "common/parallel/parallel_sort.h"
#include "mesher/tuning/cell_tuning.h"
#include "mesher/tuning/label_tuning.h"

namespace tetwright {

namespace {

using Films = LabelTuning::Films;

/// Measures films at points of surfaces.
class FilmProbe {
 public:
  FilmProbe(const LabelField& labels, double layer)
      : sampler_(labels.sampler()), volume_(labels.frame().volume()), layer_(layer) {}

  /// Whether an interface runs along a crease, within the layer.
  /// \param along unit tangent of the crease
  bool follows_interface(const Vec3& point, const Vec3& along) const {
    return std::all_of(std::begin(Films::beside), std::end(Films::beside), [&](double off) {
      const Vec3 at = point + off * along;
      return is_in_volume(at) && sampler_->nearest(at).margin <= layer_;
    });
  }
  /// Halvings after which a cell is no larger than a film.
  int halvings(double thickness) const {
    return static_cast<int>(std::ceil(std::log2(Films::max_thickness / std::max(thickness, layer_))));
  }

  /// The thickness of a film, cells, if it is less than a cell and more than the layer.
  /// \param point, normal lattice coordinates; the normal has length 1
  std::optional<double> thickness(const Vec3& point, const Vec3& normal) const {
    const Vec3 start = point + layer_ * normal;
    if (!is_in_volume(start)) return {};
    const NearestRegion here = sampler_->nearest(start);
    // Where no interface is that near, only the border may be.
    const bool uniform = layer_ + here.margin > Films::max_thickness;
    for (int k = 1; k <= Films::steps; ++k) {
      const double off = layer_ + k * (Films::max_thickness - layer_) / Films::steps;
      const Vec3 at = point + off * normal;
      if (!is_in_volume(at)) return off;
      if (!uniform && sampler_->nearest(at).region != here.region)
        return sampler_->nearest(point).margin >= Films::min_parallel * off ? std::optional(off)
                                                                            : std::nullopt;
    }
    return {};
  }

 private:
  bool is_in_volume(const Vec3& point) const {
    for (int a = 0; a < 3; ++a)
      if (point[a] < volume_.low[a] || point[a] > volume_.high[a]) return false;
    return true;
  }

  std::unique_ptr<FieldSampler> sampler_;
  CellBox volume_;  ///< lattice units
  double layer_;    ///< cells
};

/// The points of a triangle in rows that are at most `spacing` apart.
template <class Visit>
void for_each_point(const Vec3& a, const Vec3& b, const Vec3& c, double spacing, const Visit& visit) {
  const auto steps = [&](const Vec3& edge) {
    return std::max(1, static_cast<int>(std::ceil(edge.norm() / spacing)));
  };
  const int n = steps(b - a), m = steps(c - a);
  for (int i = 0; i <= n; ++i)
    for (int k = 0; 1.0 * k * n <= 1.0 * (n - i) * m; ++k) visit(Vec3(a + (b - a) * i / n + (c - a) * k / m));
}

/// Ends of the edges between patches.
std::vector<std::array<Vec3, 2>> creases_of(const RepairedSurface& surface, const SurfacePatches& patches) {
  struct Side {
    Index low, high;
    std::uint16_t patch;
    auto operator<=>(const Side&) const = default;
  };
  std::vector<Side> sides;
  if (patches.any())
    for (std::size_t i = 0; i < surface.triangles.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [low, high] = std::minmax(surface.triangles[i][k], surface.triangles[i][(k + 1) % 3]);
        sides.push_back({low, high, patches.patches[i]});
      }
  std::sort(sides.begin(), sides.end());
  std::vector<std::array<Vec3, 2>> creases;
  for (std::size_t i = 1; i < sides.size(); ++i)
    if (sides[i].low == sides[i - 1].low && sides[i].high == sides[i - 1].high &&
        sides[i].patch != sides[i - 1].patch)
      creases.push_back({surface.points[sides[i].low], surface.points[sides[i].high]});
  return creases;
}

}  // namespace

std::vector<RefinementRegion> find_films(const MesherInput& bodies,
                                         const std::vector<SurfacePatches>& patches, const LabelField& labels,
                                         double layer) {
  const GridFrame& frame = labels.frame();
  // Cells around a point are halved up to a distance of one of them.
  const double spacing = 2 * layer;
  std::vector<RefinementRegion> all;
  const auto add = [&](std::size_t count, const auto& work) {
    const std::vector<RefinementRegion> found = parallel_collect<RefinementRegion>(
        0, count, CellGrains::elements,
        [&](std::size_t begin, std::size_t end, std::vector<RefinementRegion>& out) {
          const FilmProbe probe(labels, layer);
          const auto add_point = [&](const Vec3& point, int halvings) {
            if (halvings > 0) out.push_back({frame.to_input(point), halvings});
          };
          for (std::size_t i = begin; i < end; ++i) work(i, probe, add_point);
        });
    all.insert(all.end(), found.begin(), found.end());
  };
  for (std::size_t b = 0; b < bodies.bodies.size(); ++b) {
    const RepairedSurface& surface = bodies.bodies[b].surface;
    add(surface.triangles.size(), [&](std::size_t i, const FilmProbe& probe, const auto& add_point) {
      std::array<Vec3, 3> p;
      for (std::size_t k = 0; k < 3; ++k) p[k] = frame.to_grid(surface.points[surface.triangles[i][k]]);
      const Vec3 across = (p[1] - p[0]).cross(p[2] - p[0]);
      if (!(across.norm() > 0)) return;
      const Vec3 normal = across.normalized();
      for_each_point(p[0], p[1], p[2], spacing, [&](const Vec3& point) {
        const std::optional<double> film = probe.thickness(point, normal);
        if (!film) return;
        for (const double off : {0.0, *film}) add_point(point + off * normal, probe.halvings(*film));
      });
    });
    const std::vector<std::array<Vec3, 2>> creases = creases_of(surface, patches[b]);
    add(creases.size(), [&](std::size_t i, const FilmProbe& probe, const auto& add_point) {
      const Vec3 from = frame.to_grid(creases[i][0]), to = frame.to_grid(creases[i][1]);
      if (from == to) return;
      const int n = std::max(1, static_cast<int>(std::ceil((to - from).norm() / spacing)));
      for (int k = 0; k <= n; ++k) {
        const Vec3 point = from + (to - from) * k / n;
        if (probe.follows_interface(point, (to - from).normalized())) add_point(point, probe.halvings(0));
      }
    });
  }
  return all;
}

}  // namespace tetwright
