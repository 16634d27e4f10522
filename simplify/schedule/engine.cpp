// SPDX-License-Identifier: Apache-2.0
#include "simplify/schedule/engine.h"

#include <utility>

#include "simplify/tuning/tuning.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

using Grains = SimplifyTuning::Grains;
using Slots = SimplifyTuning::Slots;

SurfaceProjection projection_for(const EditableMesh& mesh, const std::optional<OriginalSurface>& original,
                                 const ReferenceSurface* reference) {
  if (!original) return {mesh, reference};
  return {mesh, original->points, original->faces, reference, [](Index) { return true; }};
}

}  // namespace

Engine::Engine(TetMesh&& mesh, const Options& options, SimplifyReport* report, Progress* progress)
    : constrained_(std::move(mesh), options.name, options.frozen, options.fix_boundary, options.keep_volumes,
                   options.original ? &options.original->volumes : nullptr),
      first_tets_(options.original ? options.original->tets : mesh_.live_tets()),
      original_(options.original ? std::optional(take_surface(mesh_, *options.original)) : std::nullopt),
      projection_(projection_for(mesh_, original_, options.reference)),
      samples_(constrained_),
      runner_(mesh_, grid_, constrained_.ledger, options.seed, options.batch_size, progress),
      recorder_(mesh_, runner_, report, progress),
      progress_(progress) {
  rules.objective.quality = TetQuality::for_target(mesh_.total_volume(), options.target_tets, options.beta);
  rules.objective.shape = options.objective;
  rules.error.gamma = options.gamma;
  // Patches and sheets must be preserved from the first collapse on. Without them, only improvement needs the
  // projection.
  if (projection_.has_patches() || projection_.has_sheets())
    rules.project_onto(projection_, mesh_.diagonal());
}

TetMesh Engine::take() && {
  constrained_.keep_patches();
  return std::move(mesh_).to_mesh();
}

void Engine::merge_points(const PointMerging& options) {
  const std::vector<double> before = region_volumes(mesh_);
  if (!tetwright::merge_points(mesh_, options, progress_)) return;
  const std::vector<double> after = region_volumes(mesh_);
  std::vector<VolumeChange> changes;
  for (std::size_t r = 0; r < after.size(); ++r)
    changes.push_back({static_cast<RegionId>(r), after[r] - before[r]});
  constrained_.ledger.commit(changes);
}

void Engine::keep_surface(const TriangleMesh* surface, bool measured) {
  samples_.keep_surface(surface, std::exchange(original_, std::nullopt), measured);
}

void Engine::compact() {
  const bool first = !std::exchange(compacted_, true);
  if (!first) constrained_.keep_patches();
  const std::size_t spare = mesh_.live_tets() / Slots::spare_inverse + Slots::min_spare;
  SlotNumbers numbers;
  mesh_.compact(spare, spare / 2, &numbers);
  if (first) {
    grid_.build(mesh_);
  } else {
    grid_.rebuild(mesh_, numbers.points);
  }
  // An embedded mesh stays embedded, since every operation preserves this.
  if (first) rules.embedded = mesh_.all_positive() && grid_.embedded();
}

void Engine::set_sizes(const SizeField* target_length, double min_edge, double max_edge) {
  sizes_.emplace(target_length, min_edge, max_edge, mesh_.diagonal(), mesh_.space());
  rules.sizes = rules.objective.sizes = &*sizes_;
}

void Engine::assign_samples(double edge) {
  compact();
  samples_.assign(edge, rules);
}

void Engine::compact_if_sparse() {
  if (mesh_.dead_share() > Slots::compact_above) compact();
}

void Engine::rate_all() {
  parallel_for(0, mesh_.tet_slots(), Grains::slots, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto t = static_cast<Index>(i);
      const Tet& p = mesh_.points(t);
      if (p[0] == no_index) continue;
      mesh_.set_quality(t, rules.objective(mesh_.position(p[0]), mesh_.position(p[1]), mesh_.position(p[2]),
                                           mesh_.position(p[3])));
    }
  });
}

void Engine::begin_improvement() {
  rules.objective.kind = Objective::Kind::shape;
  rules.acceptance.worse_probability = 0;
  rules.project_onto(projection_, mesh_.diagonal());
  compact();
  rate_all();
}

}  // namespace tetwright
