#include <utility>

#include "common/mesh/field_transfer.h"
#include "tools/commands/commands.h"
#include "tools/commands/output_paths.h"
#include "tools/commands/result.h"
#include "tools/commands/second_order.h"
#include "tools/commands/simplification.h"
#include "tools/commands/tet_input.h"

namespace tetwright {

ExitStatus run_simplify(const CommandLine& line) {
  CommandRun run(line);
  check_output_paths(line);
  TetInput input = read_tets(run);
  const std::optional<SurfaceToFollow> surface = followed_interfaces(input.mesh, run);
  TetMesh mesh = simplify_to_target(std::move(input.mesh), nullptr, nullptr, run);
  if (surface) make_second_order(mesh, *surface, run);
  if (input.with_fields) transfer_fields(*input.with_fields, mesh);
  input.with_fields.reset();
  return finish(mesh, nullptr, run);
}

}  // namespace tetwright
