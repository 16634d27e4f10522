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
  /// \return the distance from the border if so
  std::optional<double> too_thin_at_border(const Vec3& point, const Vec3& normal) const {
    const double distance = to_border(point);
    if (distance <= LabelTuning::Border::slack ||
        distance >= std::min(options_.min_film, Films::max_thickness) ||
        to_border(point + distance / Films::min_parallel * normal) >= 0)
      return {};
    const bool is_meshed =
        options_.keep_outside || sampler_->nearest(point + distance / 2 * normal).region != outside_region;
    return is_meshed ? std::optional(distance) : std::nullopt;
  }

  /// The thickness of a film, if there is one.
  /// \param normal of length 1
  std::optional<double> thickness(const Vec3& point, const Vec3& normal) const {
    if (options_.layer >= Films::max_thickness) return {};
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

enum class FilmPointKind : std::uint8_t { to_halve, on_body };

/// A point around which cells are halved, or a point of a body at a film.
struct FilmPoint {
  FilmPointKind kind;
  MortonKey cell;  ///< of the size of the layer
  int halvings;
  Vec3 at;  ///< lattice coordinates
};

/// Keeps one point of each kind in each cell, with the most halvings there.
void keep_one_in_each_cell(std::vector<FilmPoint>& points) {
  std::sort(points.begin(), points.end(), [](const FilmPoint& a, const FilmPoint& b) {
    return std::tuple(a.kind, a.cell, -a.halvings, a.at[0], a.at[1], a.at[2]) <
           std::tuple(b.kind, b.cell, -b.halvings, b.at[0], b.at[1], b.at[2]);
  });
  points.erase(std::unique(points.begin(), points.end(),
                           [](const FilmPoint& a, const FilmPoint& b) {
                             return a.kind == b.kind && a.cell == b.cell;
                           }),
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
        const auto is_taken = [&](double thickness) {
          const Vec3 within = frame.to_input(point + thickness / 2 * normal);
          return std::any_of(others.begin(), others.end(),
                             [&](const SurfaceTree* other) { return other->winding_number(within) > 0.5; });
        };
        if (const auto gap = probe.too_thin_at_border(point, normal); gap && !is_taken(*gap))
          add(FilmPointKind::on_body, point, LabelFilms::too_many_halvings);
        const std::optional<double> film = probe.thickness(point, normal);
        if (!film || is_taken(*film)) return;
        const int halvings = probe.halvings(*film);
        if (halvings <= 0) return;
        add(FilmPointKind::on_body, point, halvings);
        for (const double off : {0.0, *film}) add(FilmPointKind::to_halve, point + off * normal, halvings);
      });
    });
  }
  void search_creases(const RepairedSurface& surface, const SurfacePatches& patches) {
    if (!patches.any() || options_.layer >= Films::max_thickness) return;
    const GridFrame& frame = labels_.frame();
    const SurfaceCreases creases = find_creases(surface.points, surface.triangles, patches.patches);
    search(creases.segments.size(), [&](std::size_t i, const FilmProbe& probe, const auto& add) {
      const auto [first, last] = creases.segments[i].ends;
      const Vec3 from = frame.to_grid(surface.points[first]), to = frame.to_grid(surface.points[last]);
      if (from == to) return;
      const int n = std::max(1, static_cast<int>(std::ceil((to - from).norm() / spacing())));
      for (int k = 0; k <= n; ++k) {
        const Vec3 point = from + (to - from) * k / n;
        if (probe.follows_interface(point, (to - from).normalized()))
          add(FilmPointKind::to_halve, point, probe.halvings_to_layer());
      }
    });
  }
  LabelFilms take() {
    keep_one_in_each_cell(points_);
    LabelFilms films;
    for (const FilmPoint& p : points_)
      (p.kind == FilmPointKind::to_halve ? films.finer : films.on_bodies)
          .push_back({labels_.frame().to_input(p.at), p.halvings});
    return films;
  }

 private:
  /// Cells around a point are halved up to a distance of one of them, and one of the smallest is a layer.
  double spacing() const { return 2 * options_.layer; }

  /// \param work is called with an item, a probe, and a function that adds a point of a kind with its
  ///   halvings
  template <class Work>
  void search(std::size_t count, const Work& work) {
    const std::vector<FilmPoint> found = parallel_collect<FilmPoint>(
        0, count, LabelGrains::films, [&](std::size_t begin, std::size_t end, std::vector<FilmPoint>& out) {
          if (progress_) progress_->throw_if_stopped();
          const FilmProbe probe(labels_, options_);
          const auto add = [&](FilmPointKind kind, const Vec3& point, int halvings) {
            std::array<int, 3> cell;
            for (int a = 0; a < 3; ++a)
              cell[a] = std::max(0, static_cast<int>(std::floor(point[a] / options_.layer)));
            out.push_back({kind, morton_encode(cell[0], cell[1], cell[2]), halvings, point});
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

NarrowLabelsReport unresolved_films(const LabelFilms& films, const GridFrame& voxels,
                                    std::initializer_list<const RefinementRegions*> finer) {
  NarrowLabelsReport report;
  for (const RefinementRegion& film : films.on_bodies) {
    const bool at_border = film.halvings == LabelFilms::too_many_halvings;
    const Vec3 at = voxels.to_grid(film.place);
    if (!at_border && std::any_of(finer.begin(), finer.end(), [&](const RefinementRegions* cells) {
          return cells->splits(at, film.halvings - 1);
        }))
      continue;
    if ((at_border ? report.at_border : report.places)++ == 0)
      (at_border ? report.first_at_border : report.first) = film.place;
  }
  return report;
}

}  // namespace tetwright
