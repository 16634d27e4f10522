// SPDX-License-Identifier: Apache-2.0

// Cells for a wanted number of tets. These rules of thumb need only be roughly right, but must not change
// with estimate_mesh(): they determine the mesh a user gets.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <utility>

#include "common/error.h"
#include "common/geometry/low_discrepancy.h"
#include "common/geometry/projection_tree.h"
#include "common/memory.h"
#include "common/message_text.h"
#include "common/parallel/parallel.h"
#include "common/parallel/parallel_sort.h"
#include "mesher/labels/label_faces.h"
#include "mesher/labels/label_field.h"
#include "mesher/mesh_estimate.h"

namespace tetwright {

namespace {

/// Dense tets of an adaptive mesh per squared finest cell of surface. The number tends to the first value
/// where the solid is thick, and is half of it where the solid is as thick as the second value, in finest
/// cells of volume per squared cell of surface. Fitted to scans at 32 to 256 cells: within 10 % there, up to
/// twice too high for flat ones.
constexpr double tets_per_area_thick = 29;
constexpr double half_full_thickness = 1.6;
/// Maximum number of lattice tets along the surface per dense tet wanted.
constexpr double max_lattice_per_dense = 4;
/// Thin layers take smaller cells, see field_thickness.h.
constexpr double cells_per_sheet = 1.5, min_refined = 0.125;
/// Dense tets per tet wanted in the end: fewer leave the simplifier no choice, more take time.
constexpr double surface_dense_per_target = 40, label_dense_per_target = 5;
/// Dense tets per tet wanted for surfaces with creases. Their patches may be narrower than a cell, and only
/// what cells resolve can be kept. Of nine parts at 10,000 tets, the two with strips of half a cell have, at
/// 100 instead of 40, half and a third of the distance from creases (99th percentile), and lose no corners.
constexpr double creased_dense_per_target = 100;
constexpr double max_dense_tets = 20e6;
constexpr int min_target_resolution = 32;
/// Dense tets of labels per face between two materials, as large as a squared cell; half as many per face to
/// the outside.
constexpr double tets_per_face = 45;
/// Finer cells resolve no more of the voxels.
constexpr int max_cells_per_voxel = 4;
/// Cells larger than a voxel, in voxels, largest first: powers of two, so that halved ones align with voxels.
/// Larger ones, halved max_refinement times, would not resolve a single voxel.
constexpr std::array<int, 2> large_cells{4, 2};
/// Dense tets per tet wanted in cells this large, and the share of those in cells of a voxel above which
/// large cells save too little to be worth their coarseness: where labels are thin cells are halved anyway.
constexpr double large_cells_dense_per_target = 20, max_share_of_voxel_cells = 0.5;
/// A ball of this many large cells loses 1 % of its volume to chords: measured, 0.27 (cell / radius)^2.
/// Labels of few voxels change more by smoothing.
constexpr double min_cells_of_part = 590, few_voxels = 1000;

/// Dense tets of surfaces with finest cells of edge `h`, input units.
double dense_tets(const MesherInput& input, double h) {
  double tets = 0;
  const auto add = [&](const RepairedSurface& s, double sides) {
    const double area = s.area / (h * h), volume = std::max(0.0, s.volume) / (h * h * h);
    if (!(area > 0)) return;
    const double thickness = volume / area;
    tets += sides * tets_per_area_thick * area * thickness / (thickness + half_full_thickness);
  };
  // A surface inside another body has tets on both sides.
  for (std::size_t b = 0; b < input.bodies.size(); ++b) add(input.bodies[b].surface, b == 0 ? 1 : 2);
  for (const MaterialLayer& layer : input.layers) {
    double sides = 2;
    for (double side = h; side > min_refined * h && layer.thickness < cells_per_sheet * side; side /= 2)
      sides *= 4;
    add(input.bodies[0].surface, sides);
  }
  return tets;
}

bool has_creases(const MesherInput& input, const FeatureAngle& angle) {
  if (angle.rule == FeatureAngle::Rule::off) return false;
  return std::any_of(input.bodies.begin(), input.bodies.end(), [&](const MesherInput::Body& b) {
    const RepairedSurface& s = b.surface;
    return !s.intersects_itself && find_patches(s.points, s.triangles, {angle, 0}, {}, b.file).any();
  });
}

/// Size of dense cells per edge length wanted: 1 / 2.5, so that the simplifier has a choice.
constexpr double cell_per_edge = 0.4;
/// Limit of the cells inside per edge length wanted: cells are halved until they are within it, so they are
/// about half of it on average.
constexpr double inner_cell_per_edge = 0.8;
/// Maximum number of cells along the longest side for wanted sizes; where smaller cells are wanted, cells are
/// halved and edges split.
constexpr double max_sized_resolution = 256;
/// Number of points on each surface at which sizes are evaluated.
constexpr double sized_places = 20000;

/// The fraction of a tolerance that a dense mesh may use up.
constexpr double dense_tolerance_share = 0.5;
/// Initial cells, in tolerances: smooth surfaces come within half of one.
constexpr double first_cell = 2;
/// Initial cells of surfaces with creases, in tolerances: flat faces need no smaller ones.
constexpr double first_cell_of_part = 12;
constexpr int min_tolerance_resolution = 64;
/// Factor on the estimated memory for cells so small that they resolve the input's facets: 1.8 for a bunny at
/// 780 cells along its longest side.
constexpr double faceted_memory = 2.5;
/// Distance within which surface and mesh correspond: cells, or tolerances if that is more.
constexpr double reach_cells = 2, reach_tolerances = 2;
constexpr int max_fine_rounds = 4, max_worse_rounds = 2;
/// Fraction of the tolerance that is good enough where halving cells locally gains nothing more: the
/// simplifier's samples can still be kept within the tolerance. Otherwise all cells become smaller.
constexpr double enough_share = 0.8;
constexpr double resolution_growth = 1.5;
constexpr int max_attempts = 12;
/// Smaller cells must reduce the largest distance below this fraction: it does not shrink at the border of a
/// hole.
constexpr double min_level_gain = 0.9;
constexpr std::size_t place_grain = 256;

/// Vertices and centroids of the triangles.
std::vector<Vec3> places_on(const ProjectionTree& surface) {
  std::vector<Vec3> places;
  std::vector<std::uint8_t> used(surface.points().size(), 0);
  for (const ProjectionTree::Item& t : surface.items()) {
    for (const Index p : t.corners)
      if (!std::exchange(used[p], 1)) places.push_back(surface.points()[p]);
    places.emplace_back((surface.corner(t, 0) + surface.corner(t, 1) + surface.corner(t, 2)) / 3);
  }
  return places;
}

/// Points where a dense mesh and its surface are too far from each other.
struct Misfit {
  /// With the halvings of cells that would suffice if distances fell in proportion.
  std::vector<RefinementRegion> places;
  double worst = 0;
};

/// Adds the points of one surface that are farther from the other than `allowed`. Points farther than `reach`
/// have no counterpart: a cap, a layer, the box of an outside.
void add_misfit(const ProjectionTree& from, const ProjectionTree& to, double allowed, double reach,
                Misfit& misfit) {
  struct Far {
    RefinementRegion place;
    double distance;
  };
  const std::vector<Vec3> places = places_on(from);
  const std::vector<Far> found = parallel_collect<Far>(
      0, places.size(), place_grain, [&](std::size_t begin, std::size_t end, std::vector<Far>& out) {
        for (std::size_t i = begin; i < end; ++i) {
          if (to.any_within(places[i], allowed)) continue;
          const auto hit = to.nearest_of(places[i], reach, [](const auto&) { return true; });
          if (!hit) continue;
          const double distance = (hit->point - places[i]).norm();
          const double halvings =
              std::clamp<double>(std::ceil(std::log2(distance / allowed)), 1, max_refinement);
          out.push_back({{places[i], static_cast<int>(halvings)}, distance});
        }
      });
  for (const Far& f : found) {
    misfit.places.push_back(f.place);
    misfit.worst = std::max(misfit.worst, f.distance);
  }
}

/// \param corners corners(face) gives the points of a triangle
template <class Face, class Corners>
ProjectionTree tree_of(const std::vector<Vec3>& points, const std::vector<Face>& faces,
                       const Corners& corners) {
  std::vector<ProjectionTree::Item> items;
  items.reserve(faces.size());
  for (const Face& f : faces) items.push_back({corners(f), {}});
  return {points, std::move(items)};
}

}  // namespace

int resolution_for_target(const MesherInput& input, std::size_t target_tets, const FeatureAngle& angle) {
  if (target_tets == 0) throw UsageError("the target must be at least one tet");
  const double longest = longest_side(input);
  const double per_target = has_creases(input, angle) ? creased_dense_per_target : surface_dense_per_target;
  const double dense = std::min(max_dense_tets, per_target * static_cast<double>(target_tets));
  double area = 0;
  for (const MesherInput::Body& b : input.bodies) area += b.surface.area;
  const auto enough = [&](int resolution) {
    const double h = longest / resolution;
    // A body thinner than a cell has few tets but a lattice as large as its surface: refining it would have
    // no end.
    const double lattice = tets_per_area_thick * area / (h * h);
    return std::floor(dense_tets(input, h)) >= dense || lattice >= max_lattice_per_dense * dense;
  };
  // Find the smallest sufficient one; the number of tets grows with the resolution.
  int low = min_target_resolution, high = max_resolution;
  while (low < high) {
    const int middle = (low + high) / 2;
    if (enough(middle))
      high = middle;
    else
      low = middle + 1;
  }
  return low;
}

namespace {

/// Points where a dense mesh and its surface are farther from each other than `allowed`.
Misfit misfit_of(const DenseMesh& dense, double allowed, double reach) {
  const ProjectionTree mesh = tree_of(dense.mesh.points, dense.mesh.interfaces,
                                      [](const InterfaceTriangle&t) { return t.ids; }),
                       surface = tree_of(dense.surface->points, dense.surface->triangles,
                                         [](const Triangle&t) { return t; });
  Misfit misfit;
  add_misfit(surface, mesh, allowed, reach, misfit);
  add_misfit(mesh, surface, allowed, reach, misfit);
  return misfit;
}

}  // namespace

DenseMesh mesh_within(const MesherInput& input, MesherOptions options, double tolerance, Progress* progress) {
  const double longest = longest_side(input);
  const double cells = std::ceil(longest / (first_cell * tolerance));
  options.voxel_size = 0;
  if (!(cells <= max_resolution)) {
    options.resolution = max_resolution;
    const MesherEstimate estimate = estimate_mesh(input, options);
    const double more = (cells / max_resolution) * (cells / max_resolution);
    char text[250];
    std::snprintf(
        text, sizeof text,
        "a tolerance of %.6g takes %.0f cells along the longest side, about %.3g tets and %.3g GB; at "
        "most %d cells are possible, for %.6g or more",
        tolerance, cells, more * static_cast<double>(estimate.tets),
        more * static_cast<double>(estimate.bytes) / 1e9, max_resolution,
        longest / (first_cell * max_resolution));
    throw UsageError(text);
  }
  // A given count takes more cells than the tolerance alone would: then the fraction that the simplifier's
  // samples can keep is enough.
  const bool counted = options.resolution > std::max<double>(min_tolerance_resolution, cells);
  options.resolution = std::max({min_tolerance_resolution, options.resolution, static_cast<int>(cells)});
  const MesherEstimate estimate = estimate_mesh(input, options);
  require_memory(faceted_memory * static_cast<double>(estimate.bytes),
                 "a tolerance of " + short_number(tolerance) + ", which takes about " +
                     short_number(static_cast<double>(estimate.tets)) + " tets,",
                 "give a larger one");
  // Otherwise thin walls would be thickened, and gaps closed, by up to a tolerance.
  if (!options.max_refinement) options.max_refinement = max_wall_refinement;
  const std::vector<RefinementRegion> refinement_regions = options.refinement_regions;  // for wanted sizes
  const double allowed = dense_tolerance_share * tolerance;
  const int coarse = std::max({min_tolerance_resolution, counted ? options.resolution : 0,
                               static_cast<int>(std::ceil(longest / (first_cell_of_part * tolerance)))});
  std::optional<DenseMesh> best;
  Misfit of_best;
  if (coarse < options.resolution && has_creases(input, options.feature_angle)) {
    MesherOptions large = options;
    large.resolution = coarse;
    DenseMesh dense = mesh_surfaces(input, large, progress);
    of_best =
        misfit_of(dense, allowed, std::max(reach_cells * longest / coarse, reach_tolerances * tolerance));
    if (of_best.places.empty()) return dense;
    best = std::move(dense);
  }
  int worse = 0;                                                 // rounds since the best one
  double level_worst = std::numeric_limits<double>::infinity();  // with all larger cells
  for (int round = 0, attempts = 0; attempts < max_attempts; ++attempts) {
    DenseMesh dense;
    try {
      dense = mesh_surfaces(input, options, progress);
    } catch (const OutputError&) {
      if (!best) throw;
      break;  // smaller cells would not fit in memory
    } catch (const OutOfTime&) {
      if (!best) throw;
      best->report.out_of_time = true;
      break;
    }
    Misfit misfit = misfit_of(
        dense, allowed, std::max(reach_cells * longest / options.resolution, reach_tolerances * tolerance));
    if (misfit.places.empty() || (counted && misfit.worst <= enough_share * tolerance)) return dense;
    ++worse;
    if (!best || misfit.worst < of_best.worst) {
      best = std::move(dense);
      of_best = misfit;
      worse = 0;
    }
    if (++round <= max_fine_rounds && worse < max_worse_rounds && !options.uniform) {
      // Where cells were halved before, once more.
      for (RefinementRegion& place : misfit.places)
        place.halvings = std::min(max_refinement, place.halvings + round - 1);
      options.refinement_regions.insert(options.refinement_regions.end(), misfit.places.begin(),
                                        misfit.places.end());
      continue;
    }
    if (of_best.worst <= enough_share * tolerance || of_best.worst > min_level_gain * level_worst) break;
    level_worst = of_best.worst;
    // Smaller cells everywhere.
    round = worse = 0;
    options.refinement_regions = refinement_regions;
    options.resolution = static_cast<int>(std::ceil(resolution_growth * options.resolution));
    if (options.resolution > max_resolution ||
        static_cast<double>(estimate_mesh(input, options).tets) > max_dense_tets)
      break;
  }
  return std::move(*best);
}

void choose_cells_for_sizes(const MesherInput& input, const SizeField* target_length, double max_edge,
                            MesherOptions& options) {
  const double longest = longest_side(input);
  const double max_cells = std::min<double>(max_resolution, max_sized_resolution);
  const auto need = [&](double cell) {
    options.resolution = std::max({options.resolution, min_target_resolution,
                                   static_cast<int>(std::min(max_cells, std::ceil(longest / cell)))});
  };
  if (!target_length && !std::isfinite(max_edge)) return;
  options.max_cell = [target_length, max_edge](const Vec3& place) {
    return inner_cell_per_edge * (target_length ? target_length->at(place) : max_edge);
  };
  if (!target_length) {
    need(cell_per_edge * max_edge);
    return;
  }
  struct SizedPlace {
    Vec3 place;
    double cell;
  };
  std::vector<SizedPlace> places;
  double area = 0, cells = 0;
  for (const MesherInput::Body& body : input.bodies) {
    const RepairedSurface& s = body.surface;
    const double area_each = s.area / sized_places;
    double due = 0.5;
    std::size_t drawn = 0;
    for (const Triangle& t : s.triangles) {
      const Vec3 &a = s.points[t[0]], u = s.points[t[1]] - a, v = s.points[t[2]] - a;
      const double of_triangle = u.cross(v).norm() / 2;
      for (due += of_triangle / area_each; due >= 1; --due) {
        const auto [x, y] = low_discrepancy_barycentric(drawn++);
        const Vec3 place = a + x * u + y * v;
        const double cell = cell_per_edge * target_length->at(place);
        places.push_back({place, cell});
        area += area_each;
        cells += area_each / (cell * cell);
      }
    }
  }
  if (places.empty()) return;
  // Choose the cell size that gives as many cells as the wanted sizes do, or a somewhat smaller one, so that
  // few cells have to be halved; never smaller than the smallest.
  const double smallest = std::min_element(places.begin(), places.end(), [](const auto& x, const auto& y) {
                            return x.cell < y.cell;
                          })->cell;
  options.resolution = 0;
  need(std::max(smallest, std::sqrt(area / cells)));
  const double base = longest / options.resolution;
  for (const SizedPlace& p : places)
    if (const double halvings = std::ceil(std::log2(base / p.cell) - 0.5); halvings >= 1)
      options.refinement_regions.push_back(
          {p.place, static_cast<int>(std::min<double>(halvings, max_refinement))});
}

double cell_size_for_target(const LabelInput& labels, std::size_t target_tets, const MesherOptions& options) {
  if (target_tets == 0) throw UsageError("the target must be at least one tet");
  const FaceAreas areas = face_areas(labels);
  const double voxel = voxel_size(labels), target = static_cast<double>(target_tets);
  const double smallest_cell = longest_side(labels) / max_resolution;
  // The number of tets is proportional to the inverse square of the cell size.
  const double at_voxel =
      std::max(1.0, std::floor(tets_per_face * (areas.inner + 0.5 * areas.outer) / (voxel * voxel)));
  const double finer = std::sqrt(label_dense_per_target * target / at_voxel);
  if (finer > 1)
    return std::max(voxel / std::min(finer, static_cast<double>(max_cells_per_voxel)), smallest_cell);

  const auto dense_tets_of = [&](double cell) {
    MesherOptions of_cell = options;
    of_cell.voxel_size = cell;
    return static_cast<double>(estimate_mesh(labels, of_cell).tets);
  };
  double smallest = std::numeric_limits<double>::max();  // of the labels' average parts, voxels
  for (const LabelMaterial& m : labels.materials)
    if (const auto voxels = static_cast<double>(m.voxels); voxels > few_voxels)
      smallest = std::min(smallest, voxels / static_cast<double>(m.parts.by_faces));
  smallest *= std::abs(labels.directions.determinant());
  std::optional<double> of_voxel_cells;
  for (const int cells : large_cells) {
    if (at_voxel / (cells * cells) < large_cells_dense_per_target * target || options.uniform) continue;
    const double cell = std::max(cells * voxel, smallest_cell);
    if (smallest < min_cells_of_part * cell * cell * cell) continue;
    if (!of_voxel_cells) of_voxel_cells = dense_tets_of(std::max(voxel, smallest_cell));
    if (dense_tets_of(cell) <= max_share_of_voxel_cells * *of_voxel_cells) return cell;
  }
  return std::max(voxel, smallest_cell);
}

double default_cell_size(const LabelInput& labels) {
  return std::max(voxel_size(labels), longest_side(labels) / max_resolution);
}

}  // namespace tetwright
