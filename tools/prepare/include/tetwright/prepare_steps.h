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
  /// Seconds since construction.
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// The kinds of results.
enum class Task {
  prepare,   ///< scans to a simulation mesh
  mesh,      ///< scans to a dense mesh
  simplify,  ///< a tet mesh to one of fewer tets
  improve    ///< better shapes at about the same count
};
/// The name of its command, "prepare".
const char* name_of(Task task);

/// State shared by the steps of one result; meshes are passed from step to step. Its construction starts the
/// limits on time and memory, which hold for the constructing thread.
struct PrepareRun {
  /// \param to may have findings already
  /// \pre `of`, `shown` and `to` outlive the run.
  PrepareRun(Task what, const PrepareOptions& of, Progress& shown, PrepareReport& to);
  /// Gives `shown` back the deadline that it had before.
  ~PrepareRun();
  PrepareRun(const PrepareRun&) = delete;
  PrepareRun& operator=(const PrepareRun&) = delete;

  /// Seconds until the time limit; 0 if it has passed, infinite if there is none.
  double seconds_left() const;
  /// Reserves `seconds` before the limit for comparing and writing the mesh. The earliest deadline of all
  /// calls holds.
  void reserve_time(double seconds);

  Task task;
  const PrepareOptions& options;
  MemoryLimit memory_limit;
  Stopwatch since_start;
  Progress& progress;
  const Progress::Clock::time_point deadline_before;
  double seconds_waited = 0;  ///< waiting for streams
  PrepareReport& report;
  std::optional<MidsideNodes> midside;  ///< of the result, with order 2
};

/// Adds diagnostics for items that a reader dropped.
///
/// \param file names the input in messages
/// \param with_restored false: skips items that are restored from the mesh
void report_dropped(const std::vector<Dropped>& dropped, const std::string& file, PrepareReport& report,
                    bool with_restored = true);

/// Scans: surfaces, or one segmented volume.
using ScanInput = std::variant<MesherInput, LabelInput>;

/// Reads and repairs the inputs for meshing, and reports findings.
///
/// \throws UsageError if inputs and options do not go together
/// \throws InputError as the readers
ScanInput read_scan(std::vector<Input> inputs, PrepareRun& run);

/// A tet mesh to simplify or improve.
struct TetInput {
  TetMesh mesh;  ///< coherently oriented, without fields
  /// The mesh with its fields, for transfer_fields(); std::nullopt if it has none.
  std::optional<TetMesh> with_fields;
};

/// Reads a tet mesh, makes it coherent (see make_coherent()), and reports findings.
///
/// \throws UsageError if the file is of another kind, or the target is above the mesh's number of tets
/// \throws InputError if the file cannot be read or no tet is left
TetInput read_tets(Input from, PrepareRun& run);

/// Meshes the input at the requested resolution, or else at the one that the target needs.
///
/// \return the mesh; its field and reference are null if no later step uses them
/// \throws UsageError if options of cells do not go together
/// \throws Error as mesh_surfaces() and mesh_labels()
DenseMesh make_dense_mesh(ScanInput input, PrepareRun& run);

/// The diagonal of a mesh's bounding box, input units.
double diagonal_of(const TetMesh& mesh);

/// The tolerance in input units.
///
/// \param diagonal of the bounding box, input units
/// \throws UsageError if it is below 100 times the accuracy of distances
double tolerance_of(const Length& asked, double diagonal);

/// Simplifies a mesh to the requested target and tolerance.
///
/// \param reference points are projected onto it; null: the mesh's own surface
/// \param surface surfaces are fitted to it and kept within the tolerance; null: the mesh's own
/// \throws Error as simplify()
TetMesh simplify_to_target(TetMesh mesh, const ReferenceSurface* reference, const TriangleMesh* surface,
                           PrepareRun& run);

/// Improves the shapes of a mesh as ShapeOptions request. Reports tets that stay below
/// ShapeOptions::only_below.
///
/// \throws Error as improve()
TetMesh improve_shapes(TetMesh mesh, PrepareRun& run);

/// Makes and counts the midside nodes of the result if the order is 2. Nodes lie on `surface` where the tets
/// stay valid.
void make_second_order(const TetMesh& result, const SurfaceToFollow& surface, PrepareRun& run);

/// The surface that second-order elements of a tet mesh follow: a copy of its interfaces. std::nullopt if the
/// order is 1.
std::optional<SurfaceToFollow> followed_interfaces(const TetMesh& input, const PrepareRun& run);

enum class NotesOf : std::uint8_t { all, certain };
/// The notes, one line each; the first line joins all notes on files.
std::vector<std::string> notes_of(const PrepareReport& report, NotesOf which = NotesOf::all);

/// The requests that were not met, one line each.
std::vector<std::string> shortfalls_of(const PrepareReport& report);

/// Sets the severity of all diagnostics; the only function that does. Each has the severity of its kind
/// (diagnostic_kinds()), except that kinds that yield become notes if changes are accepted or were requested.
/// If AcceptanceOptions::strict forbids notes, a shortfall says so. May be called again after diagnostics
/// were added.
void decide_severities(const AcceptanceOptions& acceptance, PrepareReport& report);

/// Whether gaps were closed or walls left out as requested.
bool changed_on_purpose(const PrepareReport& report);

/// Compares a result with the request and the input, and fills `run.report`.
///
/// \pre `mesh` has its interfaces.
void assess(const TetMesh& mesh, PrepareRun& run);

/// Runs prepare(), mesh_scans(), simplify_mesh() or improve_mesh(), with the threads of its caller (see
/// with_threads()). The report stays in `run`, so that findings can be read even after an exception.
Prepared carry_out(std::vector<Input> inputs, PrepareRun& run);

/// Checks the options of a task.
///
/// \throws UsageError if options do not go together, or one that the task needs is missing
void check_options(Task task, const PrepareOptions& options);

}  // namespace tetwright
