// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include "simplify/mesh/input_check.h"
#include "simplify/schedule/engine.h"
#include "simplify/schedule/tuned_schedule.h"
#include "simplify/tuning/coarsening_tuning.h"
#include "tetwright/error.h"
#include "tetwright/simplify.h"

namespace tetwright {

namespace {

using Coarsening = CoarseningTuning;

/// Number of boundary and interface faces with only frozen points.
std::size_t frozen_faces(const EditableMesh& mesh) {
  const std::vector<InterfaceFace> faces = mesh.interface_faces();
  return static_cast<std::size_t>(std::count_if(faces.begin(), faces.end(), [&](const InterfaceFace& f) {
    return std::all_of(f.ids.begin(), f.ids.end(), [&](Index p) { return mesh.frozen(p); });
  }));
}

}  // namespace

TetMesh coarsen(TetMesh mesh, const CoarsenOptions& options, SimplifyReport* report, Progress* progress) {
  if (!(options.target_tets > 0) || !std::isfinite(options.target_tets))
    throw UsageError("the target must be a number of tets above 0");
  if (!(options.tets_for_final >= 0) || !std::isfinite(options.tets_for_final))
    throw UsageError("the tets for each final one must be a number above 0, or 0 for the usual one");
  if (!(options.beta > 0) || !(options.gamma >= 0))
    throw UsageError("beta must be above 0 and gamma at least 0");
  check_mesh(mesh, options.frozen, options.name);
  Engine engine(std::move(mesh),
                {options.name, options.target_tets, options.beta, options.gamma, options.seed,
                 options.batch_size, ShapeObjective::both, options.reference, options.frozen, false},
                report, progress);
  engine.throw_if_stopped();
  merge_in_bulk(engine, options.target_tets, options.seed);
  engine.compact();
  const double for_each = options.tets_for_final > 0 ? options.tets_for_final : Coarsening::final_tets;
  const double target = std::ceil(for_each * options.target_tets) +
                        static_cast<double>(Coarsening::tets_for_frozen_face * frozen_faces(engine.mesh()));
  run_collapses(engine, options.target_tets, static_cast<std::size_t>(target), options.max_iterations);
  if (report) report->touching_points = engine.mesh().touching_points();
  return std::move(engine).take();
}

}  // namespace tetwright
