// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "tetwright/mesh_quality.h"
#include "tetwright/mesher.h"
#include "tetwright/mesher_input.h"
#include "tetwright/prepare.h"
#include "tetwright/progress.h"
#include "tetwright/resources.h"
#include "tetwright/surface_mesh.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

class Stopwatch {
 public:
  /// Since construction.
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// The kinds of results that can be asked for.
enum class Task {
  prepare,   ///< scans to a simulation mesh
  mesh,      ///< scans to a dense mesh
  simplify,  ///< a tet mesh to one of fewer tets
  improve    ///< better shapes at about the same count
};
/// "prepare"
const char* name_of(Task task);

/// The state that the steps of one result share. The meshes themselves are handed from step to step. Limits
/// on time and memory begin when it is made, and hold for the thread that makes it.
struct PrepareRun {
  /// All arguments must outlive it. `to` may have findings already.
  PrepareRun(Task what, const PrepareOptions& of, Progress& shown, PrepareReport& to);

  /// Until the limit; 0 where it has passed, infinite where there is none.
  double seconds_left() const;
  /// Work on the mesh ends this many seconds before the limit, or earlier if it was told so before: what
  /// comparing and writing the mesh are expected to take.
  void reserve_time(double seconds);

  Task task;
  const PrepareOptions& options;
  MemoryLimit memory_limit;
  Stopwatch since_start;
  Progress& progress;
  double seconds_waited = 0;  ///< for streams
  PrepareReport& report;
  std::optional<MidsideNodes> midside;  ///< of the result, with order 2
};

/// Adds to the diagnostics what a reader dropped from `file`. Items that are restored from the mesh are added
/// only if `with_restored`.
void report_dropped(const std::vector<Dropped>& dropped, const std::string& file, PrepareReport& report,
                    bool with_restored = true);

/// Scans: surfaces, or one segmented volume.
using ScanInput = std::variant<MesherInput, LabelInput>;

/// Reads the inputs and makes them ready for meshing; reports what was found in them. Throws UsageError for
/// inputs and options that do not go together, and what the readers throw.
ScanInput read_scan(std::vector<Input> inputs, PrepareRun& run);

/// A tet mesh to be simplified or improved.
struct TetInput {
  TetMesh mesh;  ///< coherently oriented, without fields
  /// The mesh with its fields, if it has any, for transfer_fields().
  std::optional<TetMesh> with_fields;
};

/// Reads a tet mesh, repairs what other programs write differently (see make_coherent()), and
/// reports what was found. Throws UsageError for a file of another kind or a target above the count of the
/// mesh, InputError if the file cannot be read or no tet is left.
TetInput read_tets(Input from, PrepareRun& run);

/// Meshes the input at the resolution that is asked for or that the target needs. Its field and reference are
/// null where nothing more is made of them. Throws as mesh_surfaces() and mesh_labels() do.
DenseMesh make_dense_mesh(ScanInput input, PrepareRun& run);

/// The diagonal of a mesh's bounding box, input units.
double diagonal_of(const TetMesh& mesh);

/// A tolerance in input units. Throws UsageError where it is smaller than distances are known.
double tolerance_of(const Length& asked, double diagonal);

/// Simplifies to the target and the tolerance that are asked for.
/// Points are projected onto `reference`, surfaces fitted to `surface` and kept near it; what is null is the
/// mesh's own. Throws as simplify() does.
TetMesh simplify_to_target(TetMesh mesh, const ReferenceSurface* reference, const TriangleMesh* surface,
                           PrepareRun& run);

/// Improves the shapes of a mesh as it is asked for. Tets that stay below ShapeOptions::only_below are a
/// finding. Throws as improve() does.
TetMesh improve_shapes(TetMesh mesh, PrepareRun& run);

/// With order 2 makes the midside nodes of the result, on the surface that it follows where tets stay
/// valid, and reports how many; else does nothing.
void make_second_order(const TetMesh& result, const SurfaceToFollow& surface, PrepareRun& run);

/// Returns the surface that second-order elements of a tet mesh follow: its interfaces, which are copied.
/// Nothing unless order 2 asks for them.
std::optional<SurfaceToFollow> followed_interfaces(const TetMesh& input, const PrepareRun& run);

enum class NotesOf : std::uint8_t { all, certain };
/// The notes, a line each; the first has all that are about files. Empty if there are none.
std::vector<std::string> notes_of(const PrepareReport& report, NotesOf which = NotesOf::all);

/// The requests that were not met, a line each.
std::vector<std::string> shortfalls_of(const PrepareReport& report);

/// Decides which diagnostics are notes and which are shortfalls: the only place that does. Each begins as its
/// kind says (diagnostic_kinds()); kinds that yield become notes where changes are accepted or were asked
/// for; where notes are not allowed, a shortfall says so. May be called again once more were added.
void decide_severities(const AcceptanceOptions& acceptance, PrepareReport& report);

/// Whether gaps were closed or walls left out because it was asked for.
bool changed_on_purpose(const PrepareReport& report);

/// Compares a result with what was asked for and with what was there before: fills `run.report`. `mesh` has
/// its interfaces.
void assess(const TetMesh& mesh, PrepareRun& run);

/// prepare(), mesh_scans(), simplify_mesh() or improve_mesh() for a caller that reads the report of `run`
/// after an exception, too: it says what was found until then, and stays there. Uses the threads of its
/// caller, see with_threads().
Prepared carry_out(std::vector<Input> inputs, PrepareRun& run);

/// Throws UsageError for options that do not go together, or lack what the task needs.
void check_options(Task task, const PrepareOptions& options);

}  // namespace tetwright
