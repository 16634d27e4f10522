// SPDX-License-Identifier: Apache-2.0
#include "mesher/labels/label_films.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>
#include <tuple>

#include "common/geometry/morton.h"
#include "common/geometry/surface_tree.h"
#include "common/parallel/parallel_sort.h"
#include "mesher/sizing/triangle_points.h"
#include "mesher/tuning/label_tuning.h"

namespace tetwright {

namespace {

using Films = LabelTuning::Films;

/// Measures films at points of surfaces. Lattice coordinates.
class FilmProbe {
 public:
  FilmProbe(const LabelField& labels, const FilmOptions& options)
      : sampler_(labels.sampler()), volume_(labels.frame().volume()), options_(options) {}

  /// Halvings after which a cell is no larger than a film, and than the layer at most.
  int halvings(double thickness) const {
    return static_cast<int>(std::ceil(std::log2(Films::max_thickness / std::max(thickness, options_.layer))));
  }
  int halvings_to_layer() const { return halvings(0); }

  /// Whether an interface runs along a crease, within the layer.
  /// \param along unit tangent of the crease
  bool follows_interface(const Vec3& point, const Vec3& along) const {
    return std::all_of(std::begin(Films::beside), std::end(Films::beside), [&](double off) {
      const Vec3 at = point + off * along;
      return to_border(at) >= 0 && sampler_->nearest(at).margin <= options_.layer;
    });
  }

  /// Whether the border is nearer than films may be, with labels before it. Interfaces there would be left to
  /// the layer, but the border stays as it is.
  /// \param normal of length 1
  bool is_too_thin_at_border(const Vec3& point, const Vec3& normal) const {
    const double distance = to_border(point);
    if (distance <= LabelTuning::Border::slack || distance >= options_.min_film ||
        to_border(point + distance / Films::min_parallel * normal) >= 0)
      return false;
    return options_.keep_outside || sampler_->nearest(point + distance / 2 * normal).region != outside_region;
  }

  /// The thickness of a film, if there is one.
  /// \param normal of length 1
  std::optional<double> thickness(const Vec3& point, const Vec3& normal) const {
    double inside = options_.min_film;
    const Vec3 start = point + inside * normal;
    if (to_border(start) < 0) return {};
    const NearestRegion here = sampler_->nearest(start);
    // An outside that is not meshed has no film at the border, but gaps to labels.
    const bool is_meshed = here.region != outside_region || options_.keep_outside;
    const bool near_interface = inside + here.margin <= Films::max_thickness;
    const auto is_across = [&](double off) {
      const Vec3 at = point + off * normal;
      return to_border(at) < 0 ? is_meshed : near_interface && sampler_->nearest(at).region != here.region;
    };
    double across = 0;
    for (int k = 1; k <= Films::steps && across == 0; ++k) {
      const double off = options_.min_film + k * (Films::max_thickness - options_.min_film) / Films::steps;
      (is_across(off) ? across : inside) = off;
    }
    if (across == 0) return {};
    for (int k = 0; k < Films::bisections; ++k) {
      const double middle = (inside + across) / 2;
      (is_across(middle) ? across : inside) = middle;
    }
    const double distance =
        to_border(point + across * normal) < 0 ? std::abs(to_border(point)) : sampler_->nearest(point).margin;
    return distance >= Films::min_parallel * inside ? std::optional(inside) : std::nullopt;
  }

 private:
  /// Distance from the nearest side of the volume; negative beyond.
  double to_border(const Vec3& point) const {
    double nearest = HUGE_VAL;
    for (int a = 0; a < 3; ++a)
      nearest = std::min({nearest, point[a] - volume_.low[a], volume_.high[a] - point[a]});
    return nearest;
  }

  std::unique_ptr<FieldSampler> sampler_;
  CellBox volume_;
  FilmOptions options_;
};

/// A point around which cells are halved.
struct FilmPoint {
  MortonKey cell;  ///< of the size of the layer
  int halvings;    ///< 0: the film is thinner than cells become
  Vec3 at;         ///< lattice coordinates
};

/// Keeps one of the points in each cell, with the most halvings there.
void keep_one_in_each_cell(std::vector<FilmPoint>& points) {
  std::sort(points.begin(), points.end(), [](const FilmPoint& a, const FilmPoint& b) {
    return std::tuple(a.cell, -a.halvings, a.at[0], a.at[1], a.at[2]) <
           std::tuple(b.cell, -b.halvings, b.at[0], b.at[1], b.at[2]);
  });
  points.erase(std::unique(points.begin(), points.end(),
                           [](const FilmPoint& a, const FilmPoint& b) { return a.cell == b.cell; }),
               points.end());
}

/// Collects the points of all bodies.
class FilmSearch {
 public:
  FilmSearch(const LabelField& labels, const FilmOptions& options, const Progress* progress)
      : labels_(labels), options_(options), progress_(progress) {}

  /// \param others surfaces of the other bodies, in which there are no labels
  void search_faces(const RepairedSurface& surface, const std::vector<const SurfaceTree*>& others) {
    const GridFrame& frame = labels_.frame();
    search(surface.triangles.size(), [&](std::size_t i, const FilmProbe& probe, const auto& add) {
      std::array<Vec3, 3> corners;
      for (std::size_t k = 0; k < 3; ++k) corners[k] = frame.to_grid(surface.points[surface.triangles[i][k]]);
      const Vec3 across = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
      if (!(across.norm() > 0)) return;
      const Vec3 normal = across.normalized();
      for_each_point(corners, spacing(), [&](const Vec3& point) {
        if (probe.is_too_thin_at_border(point, normal)) add(point, 0);
        const std::optional<double> film = probe.thickness(point, normal);
        if (!film) return;
        const Vec3 within = frame.to_input(point + *film / 2 * normal);
        if (std::any_of(others.begin(), others.end(),
                        [&](const SurfaceTree* other) { return other->winding_number(within) > 0.5; }))
          return;
        if (const int halvings = probe.halvings(*film); halvings > 0)
          for (const double off : {0.0, *film}) add(point + off * normal, halvings);
      });
    });
  }
  void search_creases(const RepairedSurface& surface, const SurfacePatches& patches) {
    if (!patches.any()) return;
    const GridFrame& frame = labels_.frame();
    const SurfaceCreases creases = find_creases(surface.points, surface.triangles, patches.patches);
    search(creases.segments.size(), [&](std::size_t i, const FilmProbe& probe, const auto& add) {
      const auto [first, last] = creases.segments[i].ends;
      const Vec3 from = frame.to_grid(surface.points[first]), to = frame.to_grid(surface.points[last]);
      if (from == to) return;
      const int n = std::max(1, static_cast<int>(std::ceil((to - from).norm() / spacing())));
      for (int k = 0; k <= n; ++k) {
        const Vec3 point = from + (to - from) * k / n;
        if (probe.follows_interface(point, (to - from).normalized())) add(point, probe.halvings_to_layer());
      }
    });
  }
  LabelFilms take() {
    keep_one_in_each_cell(points_);
    LabelFilms films;
    films.finer.reserve(points_.size());
    for (const FilmPoint& p : points_) {
      const Vec3 at = labels_.frame().to_input(p.at);
      if (p.halvings > 0)
        films.finer.push_back({at, p.halvings});
      else
        films.too_thin.push_back(at);
    }
    return films;
  }

 private:
  /// Cells around a point are halved up to a distance of one of them, and one of the smallest is a layer.
  double spacing() const { return 2 * options_.layer; }

  /// \param work is called with an item, a probe, and a function that adds a point with its halvings
  template <class Work>
  void search(std::size_t count, const Work& work) {
    const std::vector<FilmPoint> found = parallel_collect<FilmPoint>(
        0, count, LabelGrains::films, [&](std::size_t begin, std::size_t end, std::vector<FilmPoint>& out) {
          if (progress_) progress_->throw_if_stopped();
          const FilmProbe probe(labels_, options_);
          const auto add = [&](const Vec3& point, int halvings) {
            std::array<int, 3> cell;
            for (int a = 0; a < 3; ++a)
              cell[a] = std::max(0, static_cast<int>(std::floor(point[a] / options_.layer)));
            out.push_back({morton_encode(cell[0], cell[1], cell[2]), halvings, point});
          };
          for (std::size_t i = begin; i < end; ++i) work(i, probe, add);
          keep_one_in_each_cell(out);
        });
    points_.insert(points_.end(), found.begin(), found.end());
  }

  const LabelField& labels_;
  FilmOptions options_;
  const Progress* progress_;
  std::vector<FilmPoint> points_;
};

}  // namespace

LabelFilms find_films(const MesherInput& bodies, const std::vector<SurfacePatches>& patches,
                      const LabelField& labels, const FilmOptions& options, const Progress* progress) {
  if (options.layer >= Films::max_thickness) return {};
  std::vector<SurfaceTree> trees;
  if (bodies.bodies.size() > 1)
    for (const MesherInput::Body& body : bodies.bodies)
      trees.emplace_back(body.surface.points, body.surface.triangles);
  FilmSearch search(labels, options, progress);
  for (std::size_t b = 0; b < bodies.bodies.size(); ++b) {
    std::vector<const SurfaceTree*> others;
    for (std::size_t other = 0; other < trees.size(); ++other)
      if (other != b) others.push_back(&trees[other]);
    search.search_faces(bodies.bodies[b].surface, others);
    search.search_creases(bodies.bodies[b].surface, patches[b]);
  }
  return search.take();
}

}  // namespace tetwright
