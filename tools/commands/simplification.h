#pragma once

#include "common/reference_surface.h"
#include "common/tet_mesh.h"
#include "tools/commands/command_run.h"

namespace tetwright {

/// Simplifies to --target-tets with the options of `run.line`, for `prepare` and `simplify`. Points are
/// projected onto `surface` unless that is null. Throws as simplify() does.
TetMesh simplify_to_target(TetMesh mesh, const ReferenceSurface* surface, CommandRun& run);

}  // namespace tetwright
