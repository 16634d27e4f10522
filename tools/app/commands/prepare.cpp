// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "mesher/mesher.h"
#include "tools/app/commands/commands.h"
#include "tools/app/commands/report_file.h"
#include "tools/app/commands/scan_input.h"
#include "tools/app/commands/second_order.h"
#include "tools/app/commands/simplification.h"

namespace tetwright {

CommandResult run_prepare(CommandRun& run) {
  DenseMesh dense = make_dense_mesh(read_scan(run), run);
  // Of a segmented volume the dense mesh is what shapes are compared with.
  const TriangleMesh dense_surface = dense.surface ? TriangleMesh() : surface_for_report(dense.mesh, run);
  TetMesh mesh = simplify_to_target(std::move(dense.mesh), dense.reference.get(), dense.surface.get(), run);
  make_second_order(mesh, follow(*dense.reference), run);
  if (dense.surface)
    measure_distances(mesh, *dense.surface, "the input", run);
  else
    measure_distances(mesh, dense_surface, "the dense mesh", run);
  // Memory that writing the mesh needs.
  dense.reference.reset();
  dense.surface.reset();
  if (run.line.write_sdf.empty()) dense.field.reset();
  return {std::move(mesh), std::move(dense.field)};
}

}  // namespace tetwright
