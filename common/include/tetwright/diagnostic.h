// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// How much a diagnostic matters.
enum class Severity : std::uint8_t {
  note,       ///< something was repaired or left out, or is worth knowing
  shortfall,  ///< the mesh is valid, but a request was not met
  warning,    ///< of `check`: the mesh is valid all the same
  error       ///< of `check`: the mesh is not valid; of a run: there is no result
};

/// Each kind of diagnostic; diagnostic_kinds() describes them.
enum class DiagnosticCode : std::uint8_t {
  // Requests that were not met.
  target_missed,
  angle_missed,
  tolerance_missed,
  surface_not_shown,
  edges_too_long,
  edges_too_short,
  sizes_missed,
  solid_changed,
  sheets_changed,
  thin_walls_changed,
  contacts_changed,
  creases_changed,
  patches_lost,
  labels_lost,
  labels_changed,
  time_limit_reached,
  cells_enlarged,
  interface_not_found,
  selection_empty,
  notes_not_allowed,
  // The result.
  angles_below_bound,
  target_too_small,
  tets_still_below,
  volume_changed,
  parts_touch,
  faces_not_parted,
  faces_regrouped,
  point_off_patch,
  gap_closed,
  wall_left_out,
  crease_patches_dropped,
  specks_dropped,
  not_compared,
  solid_uncertain,
  thin_parts,
  thin_parts_uncertain,
  values_outside,
  values_nearest,
  values_not_finite,
  points_outside,
  not_written,
  single_precision,
  names_changed,
  // Surfaces.
  points_merged,
  points_unused,
  triangles_collapsed,
  triangles_repeated,
  triangles_flat,
  edges_non_manifold,
  inner_walls_dropped,
  walls_kept_as_sheets,
  triangles_turned,
  holes_closed,
  base_added,
  sheet_thickened,
  surface_self_intersects,
  components_turned,
  components_unclear,
  components_alike,
  components_alternate,
  cavities_filled,
  components_separated,
  cells_separated,
  surfaces_joined,
  surfaces_not_joined,
  names_qualified,
  patches_joined,
  bodies_overlap,
  bodies_not_joined,
  sheet_cut_off,
  sheet_on_faces,
  partition_ends,
  // Segmented volumes.
  no_outside,
  spacing_assumed,
  spacing_replaced,
  islands_merged,
  islands_all_small,
  masks_overlap,
  masks_empty,
  space_converted,
  space_unknown,
  volume_enlarged,
  body_off_labels,
  narrow_labels,
  surface_space_unknown,
  mesh_space_unused,
  // Tet meshes.
  tet_points_merged,
  tets_collapsed,
  tets_turned,
  tets_inverted,
  patch_faces_lost,
  interfaces_joined,
  sides_apart,
  // Files.
  input_dropped,
  input_restored,
  // Findings of `check`: first those of check_mesh().
  materials_missing,
  index_out_of_range,
  coordinates_not_finite,
  degenerate_tets,
  duplicate_tets,
  unused_points,
  inverted,
  face_over_shared,
  boundary_edges_not_two,
  boundary_points_non_manifold,
  point_star_split,
  self_intersections,
  sheet_faces_misplaced,
  topology_differs,
  tolerance_exceeded,
  // Runs without a result.
  usage,
  input,
  nothing_to_mesh,
  output,
  internal,
  interrupted
};

/// Decides when a shortfall becomes a note.
enum class Yields : std::uint8_t {
  never,
  to_acceptance,            ///< --accept-changes
  to_acceptance_or_purpose  ///< that, and gaps or walls that were closed or left out because it was asked
};

struct DiagnosticKind {
  DiagnosticCode code;
  const char* name;  ///< "target-missed"; stays the same from version to version
  Severity severity;
  Yields yields = Yields::never;
  /// False: the result differs from an estimate, which may itself be wrong, or was asked for. Never counts as
  /// a note for --strict.
  bool certain = true;
  const char* title;  ///< a few words for lists
  const char* message =
      "";  ///< pattern of the line, with N, D and NAME for values; findings of `check`: the line
  const char* cause;
  const char* remedy;  ///< what the user can do
};

/// All kinds, in the order of DiagnosticCode.
std::span<const DiagnosticKind> diagnostic_kinds();
const DiagnosticKind& kind_of(DiagnosticCode code);
/// "note", "shortfall", "warning", "error"
const char* name_of(Severity severity);

/// Something that a user should know about an input or a result.
struct Diagnostic {
  DiagnosticCode code;
  Severity severity = kind_of(code).severity;
  std::string file = {};  ///< that it is about; empty: the result
  std::string what = {};  ///< with a count the plural of what is counted, "repeated triangles"; else a clause
  std::size_t count = 0;  ///< 0: `what` says all
  std::string done = {};  ///< what was done about it
  std::string remedy = {};                         ///< what the user can do
  std::optional<double> asked = {}, reached = {};  ///< of a request, in its unit
  std::string limited_by = {};                     ///< what prevented more
  std::vector<Vec3> places = {};                   ///< the first ones, input units
};

/// "12 repeated triangles (one of each kept)"; without the file.
std::string diagnostic_text(const Diagnostic& diagnostic);

}  // namespace tetwright
