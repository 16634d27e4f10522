// SPDX-License-Identifier: Apache-2.0
#include <zlib.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "common/message_text.h"
#include "mesher/brick_mesher.h"
#include "mesher/field_mesher.h"
#include "mesher/images/material_image.h"
#include "mesher/labels/label_faces.h"
#include "mesher/volume_field.h"
#include "tetwright/error.h"
#include "tetwright/prepare_steps.h"
#include "tetwright/resources.h"
#include "tools/bricks/brick_bytes.h"
#include "tools/bricks/brick_estimate.h"
#include "tools/bricks/brick_part.h"
#include "tools/bricks/brick_scratch.h"
#include "tools/bricks/brick_store.h"
#include "tools/bricks/gathered_mesh.h"
#include "tools/bricks/process_team.h"
#include "tools/prepare/brick_round.h"
#include "tools/prepare/later_rounds.h"

namespace tetwright {

namespace {

/// Volume of all voxels that are meshed, input units cubed.
double meshed_volume(const LabelInput& labels, bool keep_outside) {
  double voxels = 0;
  for (const LabelMaterial& m : labels.materials) voxels += static_cast<double>(m.voxels);
  if (keep_outside) voxels = 1.0 * labels.size[0] * labels.size[1] * labels.size[2];
  return voxels * std::abs(labels.directions.determinant());
}

CoarsenOptions coarsen_options(const PrepareOptions& asked, const std::string& name) {
  CoarsenOptions options;
  options.beta = asked.schedule.beta;
  options.gamma = asked.schedule.gamma;
  options.max_iterations = asked.shapes.max_iterations;
  options.seed = asked.seed;
  options.name = name;
  return options;
}

/// Flags of the materials that the dense mesh has, for validate_materials_left().
std::vector<std::uint8_t> materials_there(const MaterialField& field, const MeshStatistics& dense) {
  std::vector<std::uint8_t> there;
  for (const FieldRegion& region : field.regions()) there.push_back(dense.materials.count(region.tag) > 0);
  return there;
}

/// Checksum of the values and options of an image.
std::string checksum(const MaterialImage& image) {
  uLong sum = crc32_z(0, nullptr, 0);
  const auto add = [&](const auto& values) {
    sum = crc32_z(sum, reinterpret_cast<const Bytef*>(values.data()), values.size() * sizeof(values[0]));
  };
  for (const std::vector<float>& channel : image.channels()) add(channel);
  add(image.thresholds());
  add(image.offsets());
  if (image.outside()) add(std::array{*image.outside()});
  return std::to_string(sum);
}

/// Checksum of the regions of all voxels.
std::string checksum(const RegionGrid& regions) {
  std::vector<RegionIndex> slice(static_cast<std::size_t>(regions.size()[0]) *
                                 static_cast<std::size_t>(regions.size()[1]));
  uLong sum = 0;
  for (int z = 0; z < regions.size()[2]; ++z) {
    regions.read_slices(z, z + 1, slice);
    sum = crc32_z(sum, reinterpret_cast<const Bytef*>(slice.data()), slice.size() * sizeof(RegionIndex));
  }
  return std::to_string(sum);
}

std::string numbers(std::initializer_list<double> values) {
  std::string text;
  for (const double value : values) {
    std::array<char, 32> buffer;
    text +=
        (text.empty() ? "" : " ") +
        std::string(buffer.data(), std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr);
  }
  return text;
}

/// Everything that determines the bricks.
BrickJob describe(const LabelInput& labels, const MesherOptions& options, const BrickPlan& plan,
                  const PrepareRun& run) {
  const PrepareOptions& asked = run.options;
  const Eigen::Matrix3d& d = labels.directions;
  std::string tags;
  for (const LabelMaterial& m : labels.materials) tags += (tags.empty() ? "" : " ") + std::to_string(m.tag);
  return {{"tetwright", TETWRIGHT_VERSION},
          {"format of bricks", std::to_string(brick_format)},
          {"voxels", numbers({1.0 * labels.size[0], 1.0 * labels.size[1], 1.0 * labels.size[2]})},
          {"origin", numbers({labels.origin[0], labels.origin[1], labels.origin[2]})},
          {"directions",
           numbers({d(0, 0), d(1, 0), d(2, 0), d(0, 1), d(1, 1), d(2, 1), d(0, 2), d(1, 2), d(2, 2)})},
          {"labels", tags},
          {"checksum of the voxels", checksum(labels.regions)},
          {"checksum of the image", labels.image ? checksum(*labels.image) : "none"},
          {bricks_option, std::to_string(plan.cells)},
          {rounds_option, std::to_string(plan.rounds)},
          {"--target-tets", std::to_string(*asked.target.tets)},
          {"cell size", numbers({cell_size(labels, options)})},
          {"--adaptivity", numbers({options.adaptivity})},
          {"--keep-outside", options.keep_outside ? "yes" : "no"},
          {"--min-solid-angle", numbers({asked.shapes.bound()})},
          {"--max-iterations", std::to_string(asked.shapes.max_iterations)},
          {"--beta", numbers({asked.schedule.beta})},
          {"--gamma", numbers({asked.schedule.gamma})},
          {"--seed", std::to_string(asked.seed)}};
}

/// Numbers of faces in each brick, which the time that it takes follows.
std::vector<std::size_t> work_in(const std::vector<CellBox>& boxes, const BoxFaces& faces) {
  std::vector<std::size_t> work;
  const CellBox& first = boxes.front();
  for (const CellBox& box : boxes) {
    std::array<std::size_t, 3> at;
    for (int a = 0; a < 3; ++a)
      at[a] =
          std::min(faces.boxes[a] - 1, static_cast<std::size_t>(box.low[a] / (first.high[a] - first.low[a])));
    work.push_back(faces.counts[(at[2] * faces.boxes[1] + at[1]) * faces.boxes[0] + at[0]]);
  }
  return work;
}

std::string gigabytes(double bytes) {
  std::array<char, 32> text;
  // Two digits, and no exponent.
  const double value = bytes / gigabyte;
  std::snprintf(text.data(), text.size(), value < 1 ? "%.2f GB" : value < 10 ? "%.1f GB" : "%.0f GB", value);
  return text.data();
}

/// Checks that memory and scratch space suffice, and says how much of them is expected to be used.
void check_space(const BrickEstimator& estimate, const BrickPlan& plan, const BrickScratch* scratch,
                 const PrepareRun& run) {
  const BrickEstimate needed = estimate(plan);
  const std::string what = "bricks of " + std::to_string(plan.cells) + " cells" +
                           (plan.rounds > 1 ? " in " + std::to_string(plan.rounds) + " rounds" : "");
  if (std::isinf(needed.memory))
    throw OutputError("the mesh from " + what +
                      " would have more than 2^30 tets; give fewer by --target-tets" +
                      std::string(plan.cells > min_brick_cells ? ", or smaller --bricks" : ""));
  require_memory(needed.memory, what,
                 std::string("give other --bricks, larger cells or fewer tets") +
                     (scratch ? "" : ", or a folder for finished bricks by --scratch"));
  run.progress.announce(
      what + " need about " + gigabytes(needed.memory) + " of memory" +
      (scratch ? " and " + gigabytes(needed.scratch) + " in " + run.options.bricks.scratch : ""));
  if (!scratch) return;
  const double space = scratch->free_bytes() + scratch->used_bytes();
  if (needed.scratch > space)
    throw OutputError(run.options.bricks.scratch + ": the bricks would take about " +
                      gigabytes(needed.scratch) + ", and there is room for " + gigabytes(space) +
                      "; free some, or give --scratch another folder");
}

/// Names of the materials that have one.
std::map<MaterialTag, std::string> names_of(const MaterialField& field) {
  std::map<MaterialTag, std::string> names;
  for (const FieldRegion& region : field.regions())
    if (!region.name.empty()) names[region.tag] = region.name;
  return names;
}

}  // namespace

void remove_bricks(Prepared& result) noexcept {
  if (result.scratch) result.scratch->remove();
  result.scratch.reset();
}

DenseMesh mesh_bricks(LabelInput labels, const MesherOptions& options, double dense_tets,
                      const BrickPlan& plan, PrepareRun& run) {
  DenseMesh made;
  MesherReport& report = made.report;
  BrickReport& bricks = run.report.bricks.emplace();
  bricks.cells = plan.cells;
  bricks.rounds = plan.rounds;
  ProcessTeam* const team = run.options.bricks.team;
  const bool leads = !team || team->is_leader();
  const BrickJob job = describe(labels, options, plan, run);
  if (!run.options.bricks.scratch.empty() && leads)
    run.scratch = std::make_shared<BrickScratch>(run.options.bricks.scratch, job);
  if (run.scratch && run.options.bricks.when_kept) run.options.bricks.when_kept();
  if (leads)
    check_space(BrickEstimator(labels, options, dense_tets, *run.options.target.tets, run.scratch != nullptr,
                               team != nullptr),
                plan, run.scratch.get(), run);
  if (team) {
    std::string text;
    // The leader decides about rounds: a member knows neither its memory nor its folder.
    for (const auto& [name, value] : job)
      if (name != rounds_option) text.append(name).append("=").append(value).append("\n");
    team->begin(text, run.progress);
  }
  Stages stages(&run.progress);
  stages.begin("signed distances");
  VolumeField volume = make_volume_field(labels, options, report, &run.progress);
  const BoxFaces faces =
      faces_of_boxes(labels, voxels_of_bricks(labels, cell_size(labels, options), plan.cells));
  labels.regions = {};  // the field has what is needed of them
  report.seconds_sdf = stages.seconds();
  report.loops_sdf = stages.loops();
  const BrickMesher mesher(std::move(volume), options, report, &run.progress);
  made.field = mesher.field();

  stages.begin("bricks");
  const std::vector<CellBox> boxes = mesher.bricks(plan.cells << report.refinement);
  const double density =
      static_cast<double>(*run.options.target.tets) / meshed_volume(labels, options.keep_outside);
  const CoarsenOptions coarsening = coarsen_options(run.options, run.report.inputs.front());
  const bool again = plan.rounds > 1;
  const auto make = [&](const BrickTask& task) {
    return make_brick_part(mesher, boxes[task.brick], task, density, coarsening, run.options.shapes.bound(),
                           &run.progress);
  };
  const RoundsJob rounds{labels, cell_size(labels, options), plan, density, coarsening, made.field};
  if (!leads) {
    team->help([&](const std::string& order) {
      BrickRequest asked = brick_request(order, "message of rank 0");
      return to_bytes(asked.task.round == 1
                          ? make(asked.task)
                          : make_again(std::move(asked.pieces), asked.task, rounds, run.progress));
    });
    throw HelperFinished();
  }
  bricks.bricks = boxes.size();
  BrickStore store(boxes, run.scratch.get(), 1, bricks);
  BrickRound round(store, work_in(boxes, faces),
                   {plan.workers, team, make, [](const BrickTask&) { return BrickPieces(); }}, bricks,
                   run.progress);
  if (again) round.thin_surfaces();
  bricks.repeated = make_bricks(mesher, boxes, round.borders(), [&](const std::vector<BrickOrder>& orders) {
    std::vector<BrickTask> tasks;
    tasks.reserve(orders.size());
    for (const BrickOrder& order : orders) tasks.push_back({order.brick, order.halo, false});
    round.make(tasks);
  });
  GatheredMesh gathered;
  if (!again) {
    bricks.surfaces_kept = round.separate([&] {
      std::vector<BrickPart> parts = store.take();
      gathered = gather(parts, names_of(*made.field));
      std::vector<std::size_t> meeting = std::move(gathered.meeting);
      if (!meeting.empty()) {
        gathered = {};
        store.put_back(std::move(parts));
      }
      return meeting;
    });
  } else {
    bricks.surfaces_kept = round.separate([&] { return meeting_in(store, run.progress); });
    stages.begin("coarsen again");
    gathered = coarsen_again(store, rounds, names_of(*made.field), run);
  }
  if (team) team->end();
  report.cells = gathered.leaves;
  report.lattice_tets = gathered.lattice_tets;
  report.isolated_vertices = gathered.isolated_vertices;
  validate_materials_left(labels, materials_there(*made.field, gathered.dense));
  made.mesh = std::move(gathered.mesh);
  bricks.coarse_tets = made.mesh.tets.size();
  run.report.dense = std::move(gathered.dense);
  run.original = std::move(gathered.original);
  name_border_patches(run.original->surface.interfaces, made.field->frame(), made.mesh);
  made.reference = reference_of(run.original->surface, made.field);
  return made;
}

}  // namespace tetwright
