// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "tetwright/loop_times.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/mesher.h"
#include "tetwright/mesher_input.h"
#include "tetwright/prepare.h"
#include "tetwright/progress.h"
#include "tetwright/resources.h"
#include "tetwright/surface_mesh.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

struct BrickPlan;

/// Measures the time since its construction, and the part of it in loops, if the thread counts them.
class Stopwatch {
 public:
  LoopTimes loops() const { return loop_times() - loops_before_; }
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  LoopTimes loops_before_ = loop_times();
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Kinds of runs.
enum class Task {
  prepare,   ///< scans to a simulation mesh
  mesh,      ///< scans to a dense mesh
  simplify,  ///< a tet mesh to one with fewer tets
  improve,   ///< better shapes at about the same number of tets
  values     ///< values of images on a tet mesh that stays as it is
};
/// Name of the task's command, such as "prepare".
const char* name_of(Task task);

/// State shared by the steps of one run; meshes are passed from step to step. Construction starts the limits
/// on time and memory, which apply to the constructing thread.
struct PrepareRun {
  /// \param to may contain findings already
  /// \pre `of`, `shown` and `to` outlive the run.
  PrepareRun(Task what, const PrepareOptions& of, Progress& shown, PrepareReport& to);
  /// Restores the previous deadline of `shown`.
  ~PrepareRun();
  PrepareRun(const PrepareRun&) = delete;
  PrepareRun& operator=(const PrepareRun&) = delete;

  /// Seconds until the time limit; 0 if it has passed, infinite if there is none.
  double seconds_left() const;
  /// Reserves `seconds` before the time limit for comparing and writing the mesh. The earliest deadline of
  /// all calls applies.
  void reserve_time(double seconds);

  Task task;
  const PrepareOptions& options;
  MemoryLimit memory_limit;
  HeldMemory held;  ///< by images and masks of ValueOptions
  Stopwatch since_start;
  Progress& progress;
  const Progress::Clock::time_point deadline_before;
  double seconds_waited = 0;  ///< spent waiting for streams
  PrepareReport& report;
  std::optional<MidsideNodes> midside;   ///< midside nodes of the result, with order 2
  std::shared_ptr<const CapFaces> caps;  ///< of the surfaces; null without holes
  /// The dense mesh of a volume in bricks, as far as its coarsened mesh no longer shows it.
  std::optional<OriginalMesh> original;
  std::shared_ptr<const BrickScratch> scratch;  ///< Prepared::scratch
  /// Labels of the segmented volume, with ValueOptions::own_label.
  std::shared_ptr<const LabelVolume> value_labels;
};

/// Adds diagnostics for contents that a reader dropped.
///
/// \param file name of the input in messages
/// \param with_restored false: skip contents that are restored from the mesh
void report_dropped(const std::vector<Dropped>& dropped, const std::string& file, PrepareReport& report,
                    bool with_restored = true);

/// A scan: surfaces, a segmented volume, or both.
using ScanInput = std::variant<MesherInput, LabelInput, ImplantedVolume>;

/// Reads and repairs the inputs for meshing, and reports findings.
///
/// \throws UsageError if inputs and options cannot be combined
/// \throws InputError in the cases of the readers
ScanInput read_scan(std::vector<Input> inputs, PrepareRun& run);

/// A tet mesh to be simplified or improved.
struct TetInput {
  TetMesh mesh;  ///< consistently oriented, without fields
  /// The mesh with its fields, for transfer_fields(); std::nullopt if it has none.
  std::optional<TetMesh> with_fields;
  std::vector<InterfaceToPart> joined;  ///< parted interfaces of the file, joined in the mesh
};

/// Joins the parted interfaces of a tet mesh that was read, since everything else needs them joined, and
/// reports them. Wedges that belong to none are reported as dropped.
///
/// \param read changed
/// \param file name of the input in messages
/// \return for part_interfaces()
std::vector<InterfaceToPart> join_read_interfaces(ReadTetMesh& read, const std::string& file,
                                                  PrepareReport& report);

/// Reads a tet mesh, makes it coherent (see make_coherent()), and reports findings.
///
/// \throws UsageError if the file is of another kind, or the target exceeds the mesh's number of tets
/// \throws InputError if the file cannot be read or no tet is left
TetInput read_tets(Input from, PrepareRun& run);

/// Reads a tet mesh that stays as it is, finds its boundary and interfaces, and measures it.
///
/// \throws UsageError if the file is of another kind
/// \throws InputError if the file cannot be read
TetMesh read_tets_unchanged(Input from, PrepareRun& run);

/// Meshes the input at the requested resolution, or otherwise at the one that the target requires.
///
/// A volume in bricks: the coarsened mesh, and PrepareRun::original.
/// \return the mesh; its field and reference are null if no later step uses them
/// \throws UsageError if options for cells cannot be combined
/// \throws Error in the cases of mesh_surfaces() and mesh_labels()
DenseMesh make_dense_mesh(ScanInput input, PrepareRun& run);

/// Meshes and coarsens a segmented volume in bricks. Sets PrepareRun::original and the report of the dense
/// mesh.
///
/// \param options the cells
/// \param dense_tets estimate for the dense mesh
/// \param plan the bricks
/// \return the coarsened mesh
/// \throws Error in the cases of mesh_labels(); OutputError if memory or scratch space would not suffice
/// \throws HelperFinished in a member of BrickOptions::team that does not lead
DenseMesh mesh_bricks(LabelInput labels, const MesherOptions& options, double dense_tets,
                      const BrickPlan& plan, PrepareRun& run);

/// Removes the files of finished bricks, now that the result is safe. Nothing happens without any.
void remove_bricks(Prepared& result) noexcept;

/// The first option that bricks cannot serve, such as "--uniform"; null if there is none.
const char* conflict_with_bricks(const PrepareOptions& options);

/// Diagonal of a mesh's bounding box, input units.
double diagonal_of(const TetMesh& mesh);

/// Tolerance in input units.
///
/// \param diagonal diagonal of the bounding box, input units
/// \throws UsageError if it is below 100 times the accuracy of distances
double tolerance_of(const Length& asked, double diagonal);

/// Simplifies a mesh to the requested target and tolerance.
///
/// \param reference points are projected onto it; null: the mesh's own surface
/// \param surface surface to which faces are fitted and which they must follow within the tolerance; null:
///   the mesh's own
/// \throws Error in the cases of simplify()
TetMesh simplify_to_target(TetMesh mesh, const ReferenceSurface* reference, const TriangleMesh* surface,
                           PrepareRun& run);

/// Improves the shapes of a mesh as requested by ShapeOptions. Reports tets that stay below
/// ShapeOptions::only_below.
///
/// \throws Error in the cases of improve()
TetMesh improve_shapes(TetMesh mesh, PrepareRun& run);

/// Creates and counts the midside nodes of the result if the order is 2. Nodes lie on `surface` if the tets
/// stay valid.
void make_second_order(const TetMesh& result, const SurfaceToFollow& surface, PrepareRun& run);

/// Surface that second-order elements of a tet mesh follow: a copy of its interfaces. std::nullopt if the
/// order is 1.
std::optional<SurfaceToFollow> followed_interfaces(const TetMesh& input, const PrepareRun& run);

enum class NotesOf : std::uint8_t { all, certain };
/// Notes, one line each; the first line combines all notes about files.
std::vector<std::string> notes_of(const PrepareReport& report, NotesOf which = NotesOf::all);

/// Requests that were not met, one line each.
std::vector<std::string> shortfalls_of(const PrepareReport& report);

/// Sets the severity of all diagnostics; no other function does. Each diagnostic has the severity of its kind
/// (diagnostic_kinds()), except that kinds that yield become notes if changes are accepted or were requested.
/// If AcceptanceOptions::strict forbids notes, a shortfall reports that. May be called again after
/// diagnostics were added.
void decide_severities(const AcceptanceOptions& acceptance, PrepareReport& report);

/// Whether gaps were closed or walls left out on request.
bool changed_on_purpose(const PrepareReport& report);

/// Compares a result with the request and the input, and fills `run.report`.
///
/// \pre `mesh` has its interfaces.
void assess(const TetMesh& mesh, PrepareRun& run);

/// Runs prepare(), mesh_scans(), simplify_mesh(), improve_mesh() or add_values() with the threads of the
/// caller (see with_threads()). The report stays in `run`, so that findings can be read even after an
/// exception.
Prepared carry_out(std::vector<Input> inputs, PrepareRun& run);

/// Checks the options of a task.
///
/// \throws UsageError if options cannot be combined, or an option that the task requires is missing
void check_options(Task task, const PrepareOptions& options);

}  // namespace tetwright
