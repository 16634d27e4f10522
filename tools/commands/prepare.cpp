#include <utility>

#include "mesher/mesher.h"
#include "tools/commands/commands.h"
#include "tools/commands/output_paths.h"
#include "tools/commands/result.h"
#include "tools/commands/scan_input.h"
#include "tools/commands/second_order.h"
#include "tools/commands/simplification.h"

namespace tetwright {

ExitStatus run_prepare(const CommandLine& line) {
  CommandRun run(line);
  check_output_paths(line);
  DenseMesh dense = make_dense_mesh(read_scan(run), run);
  const TetMesh mesh =
      simplify_to_target(std::move(dense.mesh), dense.reference.get(), dense.surface.get(), run);
  make_second_order(mesh, follow(*dense.reference), run);
  // Memory that writing the mesh needs.
  dense.reference.reset();
  dense.surface.reset();
  if (line.write_sdf.empty()) dense.field.reset();
  return finish(mesh, dense.field.get(), run);
}

}  // namespace tetwright
