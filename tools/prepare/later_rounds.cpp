// SPDX-License-Identifier: Apache-2.0
#include "tools/prepare/later_rounds.h"

#include <utility>

#include "tetwright/error.h"
#include "tools/bricks/joined_parts.h"
#include "tools/prepare/brick_round.h"
#include "tools/tuning/brick_rounds_tuning.h"

namespace tetwright {

std::vector<std::size_t> meeting_in(const BrickStore& store, const Progress& progress) {
  std::vector<PartBoundary> boundaries;
  boundaries.reserve(store.count());
  for (std::size_t b = 0; b < store.count(); ++b) {
    progress.throw_if_stopped();
    boundaries.push_back(boundary_of(*store.part(b)));
  }
  return meeting_parts(boundaries);
}

BrickPart make_again(BrickPieces pieces, const BrickTask& task, const RoundsJob& job, Progress& progress) {
  CoarsenOptions coarsening = job.coarsening;
  coarsening.tets_for_final = BrickRoundsTuning::tets_for_final[static_cast<std::size_t>(task.round - 1)];
  return coarsen_pieces(std::move(pieces), task, job.density, job.field, coarsening, &progress);
}

GatheredMesh coarsen_again(BrickStore& first, const RoundsJob& job, std::map<MaterialTag, std::string> names,
                           PrepareRun& run) {
  BrickReport& report = *run.report.bricks;
  std::size_t shared_points = 0;
  std::unique_ptr<BrickStore> last;
  for (int round = 2; round <= job.plan.rounds; ++round) {
    BrickStore& before = last ? *last : first;
    const RegroupedBricks bricks(
        ShiftedBricks(job.labels, job.cell, job.plan.cells, round), before.count(),
        [&](std::size_t p) { return before.part(p); }, run.progress);
    if (round == 2) shared_points = bricks.shared_points();
    const auto pieces = [&](const BrickTask& task) { return bricks.pieces(task.brick, &run.progress); };
    auto next = std::make_unique<BrickStore>(bricks.boxes(), run.scratch.get(), round, report);
    BrickRound made(
        *next, bricks.tets(),
        {job.plan.workers, run.options.bricks.team,
         [&](const BrickTask& task) { return make_again(pieces(task), task, job, run.progress); }, pieces},
        report, run.progress);
    made.make_all();
    report.surfaces_kept += made.separate([&] { return meeting_in(*next, run.progress); });
    before.drop_meshes();
    last = std::move(next);
  }
  std::vector<BrickPart> parts = last->take(), originals = first.take(false);
  GatheredMesh gathered = gather(parts, originals, shared_points, std::move(names));
  TETWRIGHT_CHECK(gathered.meeting.empty());
  return gathered;
}

}  // namespace tetwright
