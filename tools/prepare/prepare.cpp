// SPDX-License-Identifier: Apache-2.0
#include "tetwright/prepare.h"

#include <bit>
#include <string>
#include <utility>

#include "common/message_text.h"
#include "common/parallel/host_threads.h"
#include "tetwright/error.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/prepare_steps.h"
#include "tetwright/simplify.h"
#include "tools/prepare/input_changes.h"
#include "tools/prepare/interface_parting.h"
#include "tools/prepare/selected_faces.h"
#include "tools/prepare/value_input.h"
#include "tools/prepare/value_rules.h"

namespace tetwright {

namespace {

/// Boundary and interfaces of a mesh as a surface.
TriangleMesh surface_of(const TetMesh& mesh) {
  TriangleMesh surface;
  std::vector<Index> number(mesh.points.size(), no_index);
  for (const InterfaceTriangle& t : mesh.interfaces.empty() ? find_interfaces(mesh) : mesh.interfaces) {
    for (const Index p : t.ids) {
      if (number[p] != no_index) continue;
      number[p] = static_cast<Index>(surface.points.size());
      surface.points.push_back(mesh.points[p]);
    }
    surface.triangles.push_back({number[t.ids[0]], number[t.ids[1]], number[t.ids[2]]});
  }
  return surface;
}

/// Makes the current surface of the mesh the reference, if KeepOptions::reference is set.
void refer_to(const TetMesh& mesh, const char* name, const PrepareRun& run, Prepared& result) {
  if (!run.options.keep.reference) return;
  result.reference = std::make_shared<const TriangleMesh>(surface_of(mesh));
  result.reference_name = name;
}

ScanInput read_scan_with_images(std::vector<Input> inputs, const ValueInputs& images, PrepareRun& run) {
  ScanInput scan = read_scan(std::move(inputs), run);
  check_images_meet(images, box_of_scan(scan),
                    run.options.cells.keep_outside ? std::vector<MaterialTag>() : materials_of_scan(scan),
                    run);
  return scan;
}

Prepared mesh_from_scans(std::vector<Input> inputs, const ValueInputs& images, PrepareRun& run) {
  Prepared result;
  DenseMesh dense = make_dense_mesh(read_scan_with_images(std::move(inputs), images, run), run);
  // The result for a segmented volume is compared with its dense mesh.
  if (!dense.surface)
    refer_to(run.original ? run.original->surface : dense.mesh, "the dense mesh", run, result);
  SurfaceToFollow surface = follow(*dense.reference);
  if (run.options.order >= 2) follow_sheets(surface, dense.mesh);
  result.mesh = simplify_to_target(std::move(dense.mesh), dense.reference.get(), dense.surface.get(), run);
  run.original.reset();
  if (dense.surface) find_moved_boundary(result.mesh, *dense.surface, run);
  make_second_order(result.mesh, surface, run);
  dense.reference.reset();  // frees memory for comparing and writing the mesh
  if (dense.surface && run.options.keep.reference) {
    result.reference = std::move(dense.surface);
    result.reference_name = "the input";
  }
  if (run.options.keep.field) result.field = std::move(dense.field);
  return result;
}

Prepared dense_mesh_from_scans(std::vector<Input> inputs, const ValueInputs& images, PrepareRun& run) {
  Prepared result;
  DenseMesh dense = make_dense_mesh(read_scan_with_images(std::move(inputs), images, run), run);
  if (run.report.tolerance > 0) {
    run.progress.begin_stage("compare");
    run.report.deviation = deviation(dense.mesh, *dense.surface, &run.progress);
  }
  if (dense.reference) make_second_order(dense.mesh, follow(*dense.reference), run);
  if (dense.surface && run.options.keep.reference) {
    result.reference = std::move(dense.surface);
    result.reference_name = "the input";
  }
  result.mesh = std::move(dense.mesh);
  result.field = std::move(dense.field);
  return result;
}

Prepared mesh_from_tets(std::vector<Input> inputs, const ValueInputs& images, PrepareRun& run,
                        std::vector<InterfaceToPart>& joined) {
  Prepared result;
  TetInput input = read_tets(std::move(inputs.front()), run);
  joined = std::move(input.joined);
  Box3 box;
  for (const Vec3& p : input.mesh.points) box.add(p);
  check_images_meet(images, box, {}, run);
  if (input.with_fields) check_field_names(*input.with_fields, run);
  inputs.clear();
  const std::optional<SurfaceToFollow> surface = followed_interfaces(input.mesh, run);
  refer_to(input.mesh, "the mesh before", run, result);
  result.mesh = run.task == Task::improve ? improve_shapes(std::move(input.mesh), run)
                                          : simplify_to_target(std::move(input.mesh), nullptr, nullptr, run);
  if (surface) make_second_order(result.mesh, *surface, run);
  if (input.with_fields) transfer_fields(*input.with_fields, result.mesh);
  return result;
}

Prepared carry_out_within(Task task, std::vector<Input> inputs, const PrepareOptions& options,
                          Progress* progress) {
  Progress silent;
  Prepared result;
  with_threads_of_host(options.limits.threads, [&] {
    PrepareReport report;
    PrepareRun run(task, options, progress ? *progress : silent, report);
    result = carry_out(std::move(inputs), run);
    remove_bricks(result);
    result.report = std::move(report);
  });
  return result;
}

Prepared unchanged_tets(std::vector<Input> inputs, PrepareRun& run) {
  Prepared result;
  result.mesh = read_tets_unchanged(std::move(inputs.front()), run);
  return result;
}

}  // namespace

Prepared carry_out(std::vector<Input> inputs, PrepareRun& run) {
  check_options(run.task, run.options);
  if (inputs.empty()) throw UsageError("there is no input; give at least one");
  run.report.inputs.clear();
  for (const Input& input : inputs) run.report.inputs.push_back(input.name);
  Prepared result;
  ValueInputs images = read_value_inputs(run);
  std::vector<InterfaceToPart> joined;
  const bool of_scans = run.task == Task::prepare || run.task == Task::mesh;
  try {
    result = run.task == Task::prepare  ? mesh_from_scans(std::move(inputs), images, run)
             : run.task == Task::mesh   ? dense_mesh_from_scans(std::move(inputs), images, run)
             : run.task == Task::values ? unchanged_tets(std::move(inputs), run)
                                        : mesh_from_tets(std::move(inputs), images, run, joined);
  } catch (const OutOfTime&) {
    throw OutOfTime("out of time: after the " + short_number(run.options.limits.seconds.value_or(0)) +
                    " s of --time-limit there was no mesh yet (in stage '" + run.progress.stage() +
                    "'), and nothing was written; " +
                    (run.scratch ? "the same call goes on from the finished bricks, or give more time"
                                 : "give more time") +
                    (of_scans ? ", or larger cells by a lower --resolution" : ""));
  }
  // Comparing and returning the mesh has no deadline.
  run.progress.set_deadline(Progress::no_deadline);
  if (run.task != Task::values) assess(result.mesh, run);
  // The borders of caps follow faces: they are no curves of the mesh for anything that comes before.
  // A dense mesh is simplified later, and the simplifier would keep them.
  if (run.caps)
    run.report.caps = run.caps->name(result.mesh, run.task == Task::mesh ? CapNaming::sharp : CapNaming::all);
  take_values(std::move(images), result, run);
  if (run.task != Task::values) {
    select_faces_of(result, run);
    part_result(result, joined, run);
  }
  result.mesh.space = run.report.space_of_result();
  result.midside = std::move(run.midside);
  result.scratch = std::move(run.scratch);
  run.progress.throw_if_stopped();
  return result;
}

Prepared prepare(std::vector<Input> scans, const PrepareOptions& options, Progress* progress) {
  return carry_out_within(Task::prepare, std::move(scans), options, progress);
}

Prepared mesh_scans(std::vector<Input> scans, const PrepareOptions& options, Progress* progress) {
  return carry_out_within(Task::mesh, std::move(scans), options, progress);
}

Prepared simplify_mesh(Input mesh, const PrepareOptions& options, Progress* progress) {
  std::vector<Input> one;
  one.push_back(std::move(mesh));
  return carry_out_within(Task::simplify, std::move(one), options, progress);
}

Prepared improve_mesh(Input mesh, const PrepareOptions& options, Progress* progress) {
  std::vector<Input> one;
  one.push_back(std::move(mesh));
  return carry_out_within(Task::improve, std::move(one), options, progress);
}

Prepared add_values(Input mesh, const PrepareOptions& options, Progress* progress) {
  std::vector<Input> one;
  one.push_back(std::move(mesh));
  return carry_out_within(Task::values, std::move(one), options, progress);
}

namespace {

void check_bricks(Task task, const PrepareOptions& options) {
  if (task != Task::prepare)
    throw UsageError("only 'prepare' makes bricks; leave out --bricks for '" + std::string(name_of(task)) +
                     "'");
  if (const char* const other = conflict_with_bricks(options))
    throw UsageError(std::string("--bricks does not work with ") + other + "; leave out one of them");
  const int cells = options.bricks.cells;
  if (cells < min_brick_cells || cells > max_brick_cells ||
      !std::has_single_bit(static_cast<unsigned>(cells)))
    throw UsageError("--bricks must be a power of two from " + std::to_string(min_brick_cells) + " to " +
                     std::to_string(max_brick_cells) + ", not " + std::to_string(cells));
}

/// Rejects names such as "LPS", which would be taken for an unknown system.
void check_space(const char* option, const std::string& space) {
  const std::string known = "right-anterior-superior";
  TriangleMesh nothing;
  nothing.space = space;
  if (!space.empty() && space != known && !change_space(nothing, known))
    throw UsageError(std::string(option) + ": " + in_quotes(space) +
                     " is no anatomical coordinate system; give left-posterior-superior or " + known);
}

}  // namespace

const char* conflict_with_bricks(const PrepareOptions& options) {
  const SizeOptions& sizes = options.sizes;
  if (options.cells.uniform) return "--uniform";
  if (options.target.tolerance) return "--tolerance";
  if (sizes.field) return "--size-field";
  if (sizes.min_edge) return "--min-edge";
  if (sizes.max_edge) return "--max-edge";
  if (options.schedule.kind == Schedule::paper) return "--schedule paper";
  return nullptr;
}

void check_options(Task task, const PrepareOptions& options) {
  const SizeOptions& sizes = options.sizes;
  const TargetOptions& target = options.target;
  const bool simplifies = task == Task::prepare || task == Task::simplify;
  if (simplifies && !target.tets && !target.tolerance && !sizes.field)
    throw UsageError(
        "--target-tets is required; give the number of tets to reach, --tolerance, or --size-field");
  if (simplifies) {
    if (sizes.grading && !sizes.field)
      throw UsageError("--grading is for the edge lengths of a size field; give --size-field FILE");
    if (options.schedule.kind == Schedule::paper && (sizes.field || sizes.min_edge || sizes.max_edge))
      throw UsageError(
          "--schedule paper does not bound edges; leave out --size-field, --min-edge and --max-edge, or "
          "--schedule");
  }
  if (task == Task::simplify && !options.bodies.surface_space.empty() && !sizes.field)
    throw UsageError("--surface-space is for a size field; give --size-field FILE");
  if (target.tolerance && options.schedule.kind == Schedule::paper)
    throw UsageError("--schedule paper does not bound distances; leave out --tolerance, or --schedule");
  if (const std::optional<double>& p = options.images.outside_probability; p && !(*p >= 0 && *p <= 1))
    throw UsageError("--outside-probability " + short_number(*p) +
                     " is no probability; give a number from 0 to 1 (for other values --iso)");
  check_space("--mesh-space", options.mesh_space);
  check_space("--surface-space", options.bodies.surface_space);
  check_value_options(task, options.values);
  check_parting(options);
  if (options.bricks.use == BrickOptions::Use::always) check_bricks(task, options);
  const BrickOptions& bricks = options.bricks;
  if (bricks.use == BrickOptions::Use::never && (!bricks.scratch.empty() || bricks.rounds > 0))
    throw UsageError(std::string(bricks.scratch.empty() ? "--brick-rounds" : "--scratch") +
                     " is for bricks; leave out either it or --bricks off");
  if (bricks.rounds < 0 || bricks.rounds > max_brick_rounds)
    throw UsageError("--brick-rounds must be from 1 to " + std::to_string(max_brick_rounds) + ", not " +
                     std::to_string(bricks.rounds));
  if (options.order != 1 && options.order != 2) throw UsageError("the order of elements must be 1 or 2");
  if (options.cells.resolution && options.cells.size)
    throw UsageError("give --resolution or --voxel-size, not both");
}

}  // namespace tetwright
