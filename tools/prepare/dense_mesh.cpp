// SPDX-License-Identifier: Apache-2.0
#include "tetwright/prepare_steps.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <thread>
#include <utility>

#include "common/images/grid_box.h"
#include "mesher/mesh_estimate.h"
#include "tetwright/error.h"
#include "tetwright/resources.h"
#include "tools/bricks/brick_estimate.h"
#include "tools/bricks/brick_scratch.h"
#include "tools/prepare/edge_sizes_input.h"
#include "tools/prepare/expected_time.h"
#include "tools/prepare/gap_opening.h"
#include "tools/prepare/implant_input.h"
#include "tools/prepare/small_target.h"

namespace tetwright {

namespace {

/// Options that do not depend on the kind of input.
MesherOptions common_options(const PrepareRun& run) {
  const CellOptions& cells = run.options.cells;
  MesherOptions options;
  options.voxel_size = cells.size.value_or(0);
  options.uniform = cells.uniform;
  options.adaptivity = cells.adaptivity;
  options.keep_outside = cells.keep_outside;
  options.feature_angle = run.options.feature_angle;
  if (cells.resolution) options.resolution = *cells.resolution;
  // Measured: the simplifier's tets with all data that belong to them.
  constexpr double simplifier_bytes = 110;
  options.later_bytes_per_tet =
      run.task == Task::prepare ? simplifier_bytes : run.options.limits.later_bytes_per_tet;
  return options;
}

/// Most estimates of memory are within this factor.
constexpr double estimate_margin = 1.25;

/// How an input can be meshed with cells of some size.
struct Need {
  MesherEstimate whole;
  double bytes = 0;  ///< memory, in bricks if there are any
  BrickPlan bricks;  ///< without cells: none
};

/// Enlarges cells whose size was not requested until the memory that they need is available.
/// \param need of options, a Need
template <class Scan, class NeedOf>
Need fit_memory(const Scan& input, const NeedOf& need, MesherOptions& options, PrepareRun& run) {
  constexpr double growth = 1.25;
  constexpr double min_fitted_resolution = 16;  // a body is not recognisable with fewer cells
  const double available = available_memory() / estimate_margin;
  const Need wanted = need(options);
  if (wanted.bytes <= available) return wanted;
  const auto cell = [&](const MesherOptions& o) {
    return o.voxel_size > 0 ? o.voxel_size : longest_side(input) / o.resolution;
  };
  MesherOptions larger = options;
  Need needed = wanted;
  do {
    if (options.voxel_size > 0)
      larger.voxel_size *= growth;
    else
      larger.resolution = static_cast<int>(larger.resolution / growth);
    if (longest_side(input) / cell(larger) < min_fitted_resolution)
      return wanted;  // rejected later, with numbers
    needed = need(larger);
  } while (needed.bytes > available);
  run.report.coarser = {cell(options), cell(larger), wanted.bytes};
  options = larger;
  return needed;
}

DenseMesh mesh_input(const MesherInput& surfaces, PrepareRun& run) {
  const CellOptions& cells = run.options.cells;
  const TargetOptions& target = run.options.target;
  MesherOptions options = common_options(run);
  if (cells.uniform && cells.max_refinement.value_or(0) > 0)
    throw UsageError("--uniform has cells of one size; leave out --max-refinement, or --uniform");
  if (run.options.bricks.use == BrickOptions::Use::always || !run.options.bricks.scratch.empty() ||
      run.options.bricks.rounds > 0)
    throw UsageError("--bricks, --brick-rounds and --scratch are for segmented volumes; leave them out");
  if (!surfaces.layers.empty() && cells.min_thickness)
    throw UsageError("--min-thickness does not work with layers; leave out --layer, or --min-thickness");
  const double diagonal = (surfaces.high - surfaces.low).norm();
  read_sizes(run, {surfaces.low, surfaces.high});
  for (const MesherInput::Body& body : surfaces.bodies) require_sizes_at(run, body.surface.points);
  options.max_refinement = cells.max_refinement;
  options.min_gap = in_input_units(cells.min_gap, diagonal);
  options.min_thickness = in_input_units(cells.min_thickness, diagonal);
  const bool choose = !cells.resolution && !cells.size;
  const RequestedSizes& sizes = run.report.sizes;
  if (choose && target.tets && !cells.max_refinement)
    options.max_thin_tets = thin_tets_of_target(static_cast<double>(*target.tets));
  if (choose && target.tets)
    options.resolution = resolution_for_target(surfaces, *target.tets, run.options.feature_angle);
  if (choose && run.task == Task::prepare)
    choose_cells_for_sizes(surfaces, sizes.target_length.get(), sizes.limits.max_edge, options);
  const auto need = [&](const MesherOptions& of) {
    const MesherEstimate whole = estimate_mesh(surfaces, of);
    return Need{whole, static_cast<double>(whole.bytes), {}};
  };
  if (choose) fit_memory(surfaces, need, options, run);
  if (target_decides(run)) compare_with_target(min_tets(surfaces), run);
  if (!target.tolerance) {
    DenseMesh dense = mesh_surfaces(surfaces, options, &run.progress);
    run.report.gap_opening = find_gap_opening(surfaces, dense.report, run.options);
    return dense;
  }
  run.report.tolerance = tolerance_of(*target.tolerance, diagonal);
  if (!choose) return mesh_surfaces(surfaces, options, &run.progress);
  if (!target.tets && !sizes.target_length && !std::isfinite(sizes.limits.max_edge)) options.resolution = 0;
  return mesh_within(surfaces, options, run.report.tolerance, &run.progress);
}

/// How a volume is meshed: whole if it fits, otherwise in the largest bricks that fit.
Need need_of(const LabelInput& labels, const MesherOptions& options, const PrepareRun& run) {
  const BrickOptions& asked = run.options.bricks;
  Need need{estimate_mesh(labels, options), 0, {}};
  need.bytes = static_cast<double>(need.whole.bytes);
  // A folder with bricks of an earlier call decides.
  const BrickDivision before = division_of_job(asked.scratch);
  const int cells = asked.use == BrickOptions::Use::always      ? asked.cells
                    : asked.use == BrickOptions::Use::automatic ? before.cells
                                                                : 0;
  const double available = available_memory() / estimate_margin;
  const bool fits = need.bytes <= available && static_cast<double>(need.whole.tets) <= max_tets_to_simplify;
  if (cells == 0 && (asked.use == BrickOptions::Use::never || run.task != Task::prepare ||
                     conflict_with_bricks(run.options) || fits))
    return need;
  const BrickEstimator estimate(labels, options, static_cast<double>(need.whole.tets),
                                *run.options.target.tets, !asked.scratch.empty(), asked.team != nullptr);
  const int rounds = asked.rounds > 0 ? asked.rounds : before.cells == cells ? before.rounds : 0;
  const BrickPlan plan = estimate.choose({cells, rounds}, available);
  const double bytes = estimate(plan).memory;
  if (cells > 0 || bytes < need.bytes) {
    need.bytes = bytes;
    need.bricks = plan;
  }
  return need;
}

DenseMesh mesh_input(LabelInput& labels, PrepareRun& run) {
  const CellOptions& cells = run.options.cells;
  const TargetOptions& target = run.options.target;
  MesherOptions options = common_options(run);
  const bool choose = !cells.resolution && !cells.size;
  if (choose)
    options.voxel_size = run.task == Task::prepare && target.tets
                             ? cell_size_for_target(labels, *target.tets, options)
                             : default_cell_size(labels);
  const auto need_for = [&](const MesherOptions& of) { return need_of(labels, of, run); };
  const Need need = choose                      ? fit_memory(labels, need_for, options, run)
                    : run.task == Task::prepare ? need_for(options)
                                                : Need();
  if (run.task == Task::prepare)
    run.progress.announce(expected_time_line(
        {static_cast<double>(need.whole.tets), static_cast<double>(target.tets.value_or(0)),
         static_cast<double>(labels.voxel_count())},
        std::min(thread_count(), std::max(1u, std::thread::hardware_concurrency()))));
  read_sizes(run, box_of_voxels(labels.size, labels.origin, labels.directions));
  if (target_decides(run)) compare_with_target(min_tets(labels), run);
  if (target.tolerance && run.task == Task::mesh)
    throw UsageError(
        "--tolerance of 'mesh' is for surfaces; for a volume use 'prepare --tolerance', which bounds the "
        "distance from the dense mesh");
  const BrickOptions& bricks = run.options.bricks;
  if (need.bricks.cells == 0 && (!bricks.scratch.empty() || bricks.rounds > 0))
    run.progress.announce("the volume is meshed whole, so that " +
                          std::string(bricks.scratch.empty() ? "--brick-rounds is"
                                      : bricks.rounds > 0    ? "--scratch and --brick-rounds are"
                                                             : "--scratch is") +
                          " not used; --bricks CELLS makes bricks all the same");
  if (need.bricks.cells > 0)
    return mesh_bricks(std::move(labels), options, static_cast<double>(need.whole.tets), need.bricks, run);
  DenseMesh dense = mesh_labels(labels, options, &run.progress);
  if (target.tolerance) run.report.tolerance = tolerance_of(*target.tolerance, diagonal_of(dense.mesh));
  return dense;
}

DenseMesh mesh_input(ImplantedVolume& volume, PrepareRun& run) {
  const CellOptions& cells = run.options.cells;
  const TargetOptions& target = run.options.target;
  if (run.options.bricks.use == BrickOptions::Use::always || !run.options.bricks.scratch.empty() ||
      run.options.bricks.rounds > 0)
    throw UsageError(
        "--bricks, --brick-rounds and --scratch do not work with surfaces in a segmented volume; leave them "
        "out");
  if (target.tolerance && run.task == Task::mesh)
    throw UsageError("--tolerance of 'mesh' is for surfaces alone; leave it out");
  if (cells.uniform && cells.max_refinement.value_or(0) > 0)
    throw UsageError("--uniform has cells of one size; leave out --max-refinement, or --uniform");
  MesherOptions options = common_options(run);
  const MesherInput& bodies = volume.bodies;
  const double diagonal = (bodies.high - bodies.low).norm();
  options.max_refinement = cells.max_refinement;
  options.min_gap = in_input_units(cells.min_gap, diagonal);
  options.min_thickness = in_input_units(cells.min_thickness, diagonal);
  const bool choose = !cells.resolution && !cells.size;
  if (choose && target.tets && !cells.max_refinement)
    options.max_thin_tets = thin_tets_of_target(static_cast<double>(*target.tets));
  if (choose)
    options.voxel_size = run.task == Task::prepare && target.tets
                             ? cell_size_for_target(volume, *target.tets, options)
                             : default_cell_size(volume);
  const auto need = [&](const MesherOptions& of) {
    const MesherEstimate whole = estimate_mesh(volume, of);
    return Need{whole, static_cast<double>(whole.bytes), {}};
  };
  // Larger cells than two voxels are impossible beside bodies: then the memory does not suffice.
  if (choose) fit_memory(volume.labels, need, options, run);
  if (choose) options.voxel_size = std::min(options.voxel_size, 2 * default_cell_size(volume));
  Box3 box = box_of_voxels(volume.labels.size, volume.labels.origin, volume.labels.directions);
  box.add(bodies.low);
  box.add(bodies.high);
  read_sizes(run, box);
  if (target_decides(run)) compare_with_target(min_tets(volume), run);
  DenseMesh dense = mesh_implanted(volume, options, &run.progress);
  report_carving(*dense.report.carved, *run.report.volume);
  if (target.tolerance) run.report.tolerance = tolerance_of(*target.tolerance, diagonal_of(dense.mesh));
  return dense;
}

/// Points of tets that are not outside.
std::vector<Vec3> inner_points(const TetMesh& mesh) {
  std::vector<std::uint8_t> used(mesh.points.size(), 0);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    if (mesh.materials[t] != outside_tag)
      for (const Index p : mesh.tets[t]) used[p] = 1;
  std::vector<Vec3> points;
  for (std::size_t p = 0; p < used.size(); ++p)
    if (used[p]) points.push_back(mesh.points[p]);
  return points;
}

}  // namespace

DenseMesh make_dense_mesh(ScanInput input, PrepareRun& run) {
  const Stopwatch watch;
  DenseMesh dense = std::visit([&](auto& scan) { return mesh_input(scan, run); }, input);
  if (run.task == Task::mesh) {
    if (run.options.order < 2) dense.reference.reset();
    if (!run.options.keep.field) dense.field.reset();
  }
  // If the field does not cover the outside, the nearest sizes are used there.
  require_sizes_at(run, run.options.cells.keep_outside ? inner_points(dense.mesh) : dense.mesh.points);
  run.caps = std::move(dense.caps);
  run.report.features = dense.report.features;
  run.report.creases = std::move(dense.report.creases);
  run.report.mesher = std::move(dense.report);
  run.report.seconds_mesh = watch.seconds();
  run.report.loops_mesh = watch.loops();
  // Fraction of the meshing time needed to compare and write the mesh: 5 s of 20 (4.3 million tets of
  // dragon_vrip_res2.ply, --resolution 200).
  constexpr double finishing_share = 0.25;
  run.reserve_time(finishing_share * run.report.seconds_mesh);
  input = {};  // frees gigabytes of a large volume
  if (!run.original) run.report.dense = mesh_statistics(dense.mesh, run.options.shapes.bound());
  return dense;
}

}  // namespace tetwright
