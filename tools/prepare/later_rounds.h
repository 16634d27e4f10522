// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "mesher/domain/material_field.h"
#include "tetwright/mesher_input.h"
#include "tetwright/prepare_steps.h"
#include "tools/bricks/brick_estimate.h"
#include "tools/bricks/brick_store.h"
#include "tools/bricks/gathered_mesh.h"
#include "tools/bricks/regrouped_bricks.h"

namespace tetwright {

/// The bricks of a store whose boundaries meet (meeting_parts()).
/// \throws Interrupted, OutOfTime
std::vector<std::size_t> meeting_in(const BrickStore& store, const Progress& progress);

/// A job in several rounds.
struct RoundsJob {
  const LabelInput& labels;
  double cell;  ///< edge of a finest cell, input units
  const BrickPlan& plan;
  double density;  ///< final tets per volume, input units
  const CoarsenOptions& coarsening;
  std::shared_ptr<const MaterialField> field;
};

/// Makes a brick of a round after the first from its pieces.
/// \throws Interrupted, OutOfTime
BrickPart make_again(BrickPieces pieces, const BrickTask& task, const RoundsJob& job, Progress& progress);

/// Carries out the rounds after the first, and joins the parts of the last one.
/// \param first the parts of the first round; moved out of memory
/// \param names of the materials
/// \return no bricks meet
/// \throws Interrupted, OutOfTime, OutputError
GatheredMesh coarsen_again(BrickStore& first, const RoundsJob& job, std::map<MaterialTag, std::string> names,
                           PrepareRun& run);

}  // namespace tetwright
