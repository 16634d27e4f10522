// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/mesh/midside_nodes.h"
#include "common/progress.h"
#include "common/tet_mesh.h"
#include "common/triangle_mesh.h"
#include "mesher/mesher.h"
#include "tools/prepare/inputs.h"
#include "tools/prepare/options.h"
#include "tools/prepare/report.h"

namespace tetwright {

/// A mesh, and all that is known about it.
struct Prepared {
  TetMesh mesh;                         ///< input units, with its interface triangles
  std::optional<MidsideNodes> midside;  ///< with order 2
  PrepareReport report;                 ///< what was found and done, and what falls short
  /// The surface that the mesh is compared with: the input's, or the boundary and interfaces of the dense
  /// mesh of a segmented volume, or those of the tet mesh before. Null unless KeepOptions::reference.
  std::shared_ptr<const TriangleMesh> reference;
  std::string reference_name;  ///< "the input", "the dense mesh" or "the mesh before"
  /// The signed distances that were meshed, for write_fields(). Null unless KeepOptions::field, and for tet
  /// meshes.
  std::shared_ptr<const MaterialField> field;

  /// The notes, and the requests that were not met.
  const std::vector<Diagnostic>& diagnostics() const { return report.diagnostics; }
  bool falls_short() const { return report.falls_short(); }
};

/// Turns scans (surfaces, level sets, or one segmented volume) into a mesh for simulation: chooses the cells,
/// meshes, simplifies to the target, improves the shapes, and compares the result with the input. What the
/// program's command of this name does, with the same bytes for the same options.
///
/// Writes to no standard stream, and to no file. Uses `options.limits.threads` threads and leaves the limits
/// of oneTBB as they are. May be called from several threads at a time, with the same results as one after
/// the other. `progress` may be null; cancelling it ends the call within a second.
///
/// Throws UsageError (options), InputError (inputs), NothingToMeshError, OutputError (it would not fit in
/// memory), OutOfTime (there was no mesh yet) and Interrupted.
Prepared prepare(std::vector<Input> scans, const PrepareOptions& options = {}, Progress* progress = nullptr);

/// The dense mesh of scans. Otherwise as prepare().
Prepared mesh_scans(std::vector<Input> scans, const PrepareOptions& options = {},
                    Progress* progress = nullptr);

/// A tet mesh of fewer tets. Otherwise as prepare().
Prepared simplify_mesh(Input mesh, const PrepareOptions& options = {}, Progress* progress = nullptr);

/// Better shapes at about the same count. Otherwise as prepare().
Prepared improve_mesh(Input mesh, const PrepareOptions& options = {}, Progress* progress = nullptr);

}  // namespace tetwright
