// SPDX-License-Identifier: Apache-2.0

// Cell sizes for a target number of tets. These rules of thumb need only be roughly right, but must not
// change with estimate_mesh(), since they determine the mesh.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <utility>

#include "common/geometry/low_discrepancy.h"
#include "common/geometry/projection_tree.h"
#include "common/message_text.h"
#include "common/parallel/parallel_sort.h"
#include "mesher/labels/label_faces.h"
#include "mesher/labels/label_field.h"
#include "mesher/mesh_estimate.h"
#include "mesher/tuning/cell_tuning.h"
#include "mesher/tuning/distance_tuning.h"
#include "mesher/tuning/domain_tuning.h"
#include "mesher/tuning/estimate_tuning.h"
#include "tetwright/error.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

using LabelCells = CellTuning::LabelCells;
using TargetCount = CellTuning::TargetCount;
using TargetLengths = CellTuning::TargetLengths;
using ToleranceCells = CellTuning::ToleranceCells;

/// Dense tets of surfaces with finest cells of edge `h`, input units.
double dense_tets(const MesherInput& input, double h) {
  double tets = 0;
  const auto add = [&](const RepairedSurface& s, double sides) {
    const double area = s.area / (h * h), volume = std::max(0.0, s.volume) / (h * h * h);
    if (!(area > 0)) return;
    const double thickness = volume / area;
    tets += sides * EstimateTuning::Surfaces::tets_per_area * area * thickness /
            (thickness + EstimateTuning::Surfaces::half_full_thickness);
  };
  // A surface inside another body has tets on both sides.
  for (std::size_t b = 0; b < input.bodies.size(); ++b) add(input.bodies[b].surface, b == 0 ? 1 : 2);
  for (const MaterialLayer& layer : input.layers) {
    double sides = 2;
    for (double side = h;
         side > TargetCount::min_refined * h && layer.thickness < DistanceTuning::Sheets::min_cells * side;
         side /= 2)
      sides *= 4;
    add(input.bodies[0].surface, sides);
  }
  return tets;
}

bool has_creases(const MesherInput& input, const FeatureAngle& angle) {
  if (angle.rule == FeatureAngle::Rule::off) return false;
  return std::any_of(input.bodies.begin(), input.bodies.end(), [&](const MesherInput::Body& b) {
    const RepairedSurface& s = b.surface;
    return find_patches(s.points, s.triangles, {angle, 0}, {}, b.file).any();
  });
}

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
  /// With the number of halvings of cells that would suffice if distances fell in proportion.
  std::vector<RefinementRegion> places;
  double worst = 0;
};

/// Adds the points of one surface that are farther from the other than `allowed`. Points farther than `reach`
/// have no counterpart: they are on a cap, a layer or the box of a meshed outside.
void add_misfit(const ProjectionTree& from, const ProjectionTree& to, double allowed, double reach,
                Misfit& misfit) {
  struct Far {
    RefinementRegion place;
    double distance;
  };
  const std::vector<Vec3> places = places_on(from);
  const std::vector<Far> found = parallel_collect<Far>(
      0, places.size(), CellGrains::compared_points,
      [&](std::size_t begin, std::size_t end, std::vector<Far>& out) {
        for (std::size_t i = begin; i < end; ++i) {
          if (to.any_within(places[i], allowed)) continue;
          const auto hit = to.nearest_of(places[i], reach, [](const auto&) { return true; });
          if (!hit) continue;
          const double distance = (hit->point - places[i]).norm();
          const double halvings = std::clamp<double>(std::ceil(std::log2(distance / allowed)), 1,
                                                     DomainTuning::Refinement::max_levels);
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
  const double per_target = has_creases(input, angle) ? TargetCount::creased_dense_per_target
                                                      : TargetCount::surface_dense_per_target;
  const double dense = std::min(TargetCount::max_dense_tets, per_target * static_cast<double>(target_tets));
  double area = 0;
  for (const MesherInput::Body& b : input.bodies) area += b.surface.area;
  const auto enough = [&](int resolution) {
    const double h = longest / resolution;
    // A body thinner than a cell has few tets but a lattice in proportion to its surface: the resolution
    // would grow without bound.
    const double lattice = EstimateTuning::Surfaces::tets_per_area * area / (h * h);
    return std::floor(dense_tets(input, h)) >= dense || lattice >= TargetCount::max_lattice_per_dense * dense;
  };
  // Find the smallest sufficient resolution; the number of tets grows with it.
  int low = TargetCount::min_resolution, high = DomainTuning::Frames::max_resolution;
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
  const double cells = std::ceil(longest / (ToleranceCells::first_cell * tolerance));
  options.voxel_size = 0;
  if (!(cells <= DomainTuning::Frames::max_resolution)) {
    options.resolution = DomainTuning::Frames::max_resolution;
    const MesherEstimate estimate = estimate_mesh(input, options);
    const double more =
        (cells / DomainTuning::Frames::max_resolution) * (cells / DomainTuning::Frames::max_resolution);
    char text[250];
    std::snprintf(
        text, sizeof text,
        "a tolerance of %.6g takes %.0f cells along the longest side, about %.3g tets and %.3g GB; at "
        "most %d cells are possible, for %.6g or more",
        tolerance, cells, more * static_cast<double>(estimate.tets),
        more * static_cast<double>(estimate.bytes) / 1e9, DomainTuning::Frames::max_resolution,
        longest / (ToleranceCells::first_cell * DomainTuning::Frames::max_resolution));
    throw UsageError(text);
  }
  // If the target count requires more cells than the tolerance alone, the fraction that the simplifier's
  // samples can keep is enough.
  const bool counted = options.resolution > std::max<double>(ToleranceCells::min_resolution, cells);
  options.resolution =
      std::max({ToleranceCells::min_resolution, options.resolution, static_cast<int>(cells)});
  const MesherEstimate estimate = estimate_mesh(input, options);
  require_memory(EstimateTuning::Memory::faceted_factor * static_cast<double>(estimate.bytes),
                 "a tolerance of " + short_number(tolerance) + ", which takes about " +
                     short_number(static_cast<double>(estimate.tets)) + " tets,",
                 "give a larger one");
  // Otherwise thin walls would be thickened, and gaps closed, by up to a tolerance.
  if (!options.max_refinement) options.max_refinement = max_wall_refinement;
  const std::vector<RefinementRegion> refinement_regions = options.refinement_regions;  // for sizes
  const double allowed = ToleranceCells::dense_share * tolerance;
  const int coarse =
      std::max({ToleranceCells::min_resolution, counted ? options.resolution : 0,
                static_cast<int>(std::ceil(longest / (ToleranceCells::first_cell_of_part * tolerance)))});
  std::optional<DenseMesh> best;
  Misfit of_best;
  if (coarse < options.resolution && has_creases(input, options.feature_angle)) {
    MesherOptions large = options;
    large.resolution = coarse;
    DenseMesh dense = mesh_surfaces(input, large, progress);
    of_best = misfit_of(dense, allowed,
                        std::max(ToleranceCells::reach_cells * longest / coarse,
                                 ToleranceCells::reach_tolerances * tolerance));
    if (of_best.places.empty()) return dense;
    best = std::move(dense);
  }
  int worse = 0;                                                 // rounds since the best one
  double level_worst = std::numeric_limits<double>::infinity();  // with all larger cells
  for (int round = 0, attempts = 0; attempts < ToleranceCells::max_attempts; ++attempts) {
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
    Misfit misfit = misfit_of(dense, allowed,
                              std::max(ToleranceCells::reach_cells * longest / options.resolution,
                                       ToleranceCells::reach_tolerances * tolerance));
    if (misfit.places.empty() || (counted && misfit.worst <= ToleranceCells::enough_share * tolerance))
      return dense;
    ++worse;
    if (!best || misfit.worst < of_best.worst) {
      best = std::move(dense);
      of_best = misfit;
      worse = 0;
    }
    if (++round <= ToleranceCells::max_fine_rounds && worse < ToleranceCells::max_worse_rounds &&
        !options.uniform) {
      // Halve cells that were halved before once more.
      for (RefinementRegion& place : misfit.places)
        place.halvings = std::min(DomainTuning::Refinement::max_levels, place.halvings + round - 1);
      options.refinement_regions.insert(options.refinement_regions.end(), misfit.places.begin(),
                                        misfit.places.end());
      continue;
    }
    if (of_best.worst <= ToleranceCells::enough_share * tolerance ||
        of_best.worst > ToleranceCells::min_level_gain * level_worst)
      break;
    level_worst = of_best.worst;
    // Use smaller cells everywhere.
    round = worse = 0;
    options.refinement_regions = refinement_regions;
    options.resolution = static_cast<int>(std::ceil(ToleranceCells::resolution_growth * options.resolution));
    if (options.resolution > DomainTuning::Frames::max_resolution ||
        static_cast<double>(estimate_mesh(input, options).tets) > TargetCount::max_dense_tets)
      break;
  }
  return std::move(*best);
}

void choose_cells_for_sizes(const MesherInput& input, const SizeField* target_length, double max_edge,
                            MesherOptions& options) {
  const double longest = longest_side(input);
  const double max_cells =
      std::min<double>(DomainTuning::Frames::max_resolution, TargetLengths::max_resolution);
  const auto need = [&](double cell) {
    options.resolution = std::max({options.resolution, TargetCount::min_resolution,
                                   static_cast<int>(std::min(max_cells, std::ceil(longest / cell)))});
  };
  if (!target_length && !std::isfinite(max_edge)) return;
  options.max_cell = [target_length, max_edge](const Vec3& place) {
    return TargetLengths::inner_cell_per_edge * (target_length ? target_length->at(place) : max_edge);
  };
  if (!target_length) {
    need(TargetLengths::cell_per_edge * max_edge);
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
    const double area_each = s.area / TargetLengths::samples;
    double due = 0.5;
    std::size_t drawn = 0;
    for (const Triangle& t : s.triangles) {
      const Vec3 &a = s.points[t[0]], u = s.points[t[1]] - a, v = s.points[t[2]] - a;
      const double of_triangle = u.cross(v).norm() / 2;
      for (due += of_triangle / area_each; due >= 1; --due) {
        const auto [x, y] = low_discrepancy_barycentric(drawn++);
        const Vec3 place = a + x * u + y * v;
        const double cell = TargetLengths::cell_per_edge * target_length->at(place);
        places.push_back({place, cell});
        area += area_each;
        cells += area_each / (cell * cell);
      }
    }
  }
  if (places.empty()) return;
  // Choose the cell size that gives as many cells as the target lengths do, or a somewhat smaller one so that
  // few cells have to be halved, but not smaller than the smallest.
  const double smallest = std::min_element(places.begin(), places.end(), [](const auto& x, const auto& y) {
                            return x.cell < y.cell;
                          })->cell;
  options.resolution = 0;
  need(std::max(smallest, std::sqrt(area / cells)));
  const double base = longest / options.resolution;
  for (const SizedPlace& p : places)
    if (const double halvings = std::ceil(std::log2(base / p.cell) - 0.5); halvings >= 1)
      options.refinement_regions.push_back(
          {p.place, static_cast<int>(std::min<double>(halvings, DomainTuning::Refinement::max_levels))});
}

double cell_size_for_target(const LabelInput& labels, std::size_t target_tets, const MesherOptions& options) {
  if (target_tets == 0) throw UsageError("the target must be at least one tet");
  const FaceAreas areas = face_areas(labels);
  const double voxel = voxel_size(labels), target = static_cast<double>(target_tets);
  const double smallest_cell = longest_side(labels) / DomainTuning::Frames::max_resolution;
  // The number of tets is proportional to the inverse square of the cell size.
  const double at_voxel = std::max(
      1.0, std::floor(LabelCells::tets_per_face * (areas.inner + 0.5 * areas.outer) / (voxel * voxel)));
  const double finer = std::sqrt(TargetCount::label_dense_per_target * target / at_voxel);
  if (finer > 1)
    return std::max(voxel / std::min(finer, static_cast<double>(LabelCells::max_per_voxel)), smallest_cell);

  const auto dense_tets_of = [&](double cell) {
    MesherOptions of_cell = options;
    of_cell.voxel_size = cell;
    return static_cast<double>(estimate_mesh(labels, of_cell).tets);
  };
  // Min over the labels of the mean size of their parts; voxels, then input units cubed.
  double smallest = std::numeric_limits<double>::max();
  for (const LabelMaterial& m : labels.materials)
    if (const auto voxels = static_cast<double>(m.voxels); voxels > LabelCells::few_voxels)
      smallest = std::min(smallest, voxels / static_cast<double>(m.parts.by_faces));
  smallest *= std::abs(labels.directions.determinant());
  std::optional<double> of_voxel_cells;
  for (const int cells : LabelCells::large_cells) {
    if (at_voxel / (cells * cells) < LabelCells::large_cells_dense_per_target * target || options.uniform)
      continue;
    const double cell = std::max(cells * voxel, smallest_cell);
    if (smallest < LabelCells::min_cells_of_part * cell * cell * cell) continue;
    if (!of_voxel_cells) of_voxel_cells = dense_tets_of(std::max(voxel, smallest_cell));
    if (dense_tets_of(cell) <= LabelCells::max_share_of_voxel_cells * *of_voxel_cells) return cell;
  }
  return std::max(voxel, smallest_cell);
}

double default_cell_size(const LabelInput& labels) {
  return std::max(voxel_size(labels), longest_side(labels) / DomainTuning::Frames::max_resolution);
}

double default_cell_size(const ImplantedVolume& volume) { return default_cell_size(volume.labels); }

double cell_size_for_target(const ImplantedVolume& volume, std::size_t target_tets,
                            const MesherOptions& options) {
  return std::min(cell_size_for_target(volume.labels, target_tets, options),
                  LabelCells::max_with_bodies * voxel_size(volume.labels));
}

}  // namespace tetwright
