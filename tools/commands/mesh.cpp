#include "simplify/simplify.h"
#include "tools/commands/commands.h"
#include "tools/commands/output_paths.h"
#include "tools/commands/result.h"
#include "tools/commands/scan_input.h"
#include "tools/commands/second_order.h"

namespace tetwright {

ExitStatus run_mesh(const CommandLine& line) {
  CommandRun run(line);
  check_output_paths(line);
  DenseMesh dense = make_dense_mesh(read_scan(run), run);
  if (run.report.tolerance > 0) run.report.deviation = deviation(dense.mesh, *dense.surface);
  if (dense.reference) make_second_order(dense.mesh, follow(*dense.reference), run);
  dense.reference.reset();  // memory that writing the mesh needs
  return finish(dense.mesh, dense.field.get(), run);
}

}  // namespace tetwright
