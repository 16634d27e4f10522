// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "common/mesh/field_transfer.h"
#include "tools/app/commands/commands.h"
#include "tools/app/commands/report_file.h"
#include "tools/app/commands/second_order.h"
#include "tools/app/commands/simplification.h"
#include "tools/app/commands/tet_input.h"

namespace tetwright {

CommandResult run_simplify(CommandRun& run) {
  TetInput input = read_tets(run);
  const std::optional<SurfaceToFollow> surface = followed_interfaces(input.mesh, run);
  const TriangleMesh before = surface_for_report(input.mesh, run);
  TetMesh mesh = simplify_to_target(std::move(input.mesh), nullptr, nullptr, run);
  measure_distances(mesh, before, "the mesh before", run);
  if (surface) make_second_order(mesh, *surface, run);
  if (input.with_fields) transfer_fields(*input.with_fields, mesh);
  input.with_fields.reset();
  return {std::move(mesh), nullptr};
}

}  // namespace tetwright
