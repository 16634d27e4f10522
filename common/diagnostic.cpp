// SPDX-License-Identifier: Apache-2.0
#include "tetwright/diagnostic.h"

#include <array>

namespace tetwright {

namespace {

constexpr std::array kinds = std::to_array<DiagnosticKind>({
    {DiagnosticCode::target_missed, "target-missed", Severity::shortfall, Yields::never,
     "number of tets not reached"},
    {DiagnosticCode::angle_missed, "angle-missed", Severity::shortfall, Yields::never,
     "smallest solid angle not reached"},
    {DiagnosticCode::tolerance_missed, "tolerance-missed", Severity::shortfall, Yields::never,
     "tolerance not proven"},
    {DiagnosticCode::surface_not_shown, "surface-not-shown", Severity::shortfall, Yields::never,
     "part of the surface not in the mesh"},
    {DiagnosticCode::edges_too_long, "edges-too-long", Severity::shortfall, Yields::never,
     "edges above the largest length"},
    {DiagnosticCode::edges_too_short, "edges-too-short", Severity::shortfall, Yields::never,
     "edges below the smallest length"},
    {DiagnosticCode::sizes_missed, "sizes-missed", Severity::shortfall, Yields::never,
     "edge lengths unlike the size field"},
    {DiagnosticCode::solid_changed, "solid-changed", Severity::shortfall, Yields::to_acceptance_or_purpose,
     "another solid than the input's"},
    {DiagnosticCode::thin_walls_changed, "thin-walls-changed", Severity::shortfall, Yields::to_acceptance,
     "thin walls or gaps changed"},
    {DiagnosticCode::creases_changed, "creases-changed", Severity::shortfall,
     Yields::to_acceptance_or_purpose, "creases or corners moved"},
    {DiagnosticCode::patches_lost, "patches-lost", Severity::shortfall, Yields::to_acceptance_or_purpose,
     "named patches lost"},
    {DiagnosticCode::labels_lost, "labels-lost", Severity::shortfall, Yields::never, "labels lost"},
    {DiagnosticCode::time_limit_reached, "time-limit-reached", Severity::shortfall, Yields::never,
     "ended by the time limit"},
    {DiagnosticCode::cells_enlarged, "cells-enlarged", Severity::shortfall, Yields::never,
     "larger cells for want of memory"},
    {DiagnosticCode::notes_not_allowed, "notes-not-allowed", Severity::shortfall, Yields::never,
     "notes with --strict"},
    {DiagnosticCode::angles_below_bound, "angles-below-bound", Severity::note, Yields::never,
     "solid angles below the bound"},
    {DiagnosticCode::tets_still_below, "tets-still-below", Severity::note, Yields::never,
     "tets that could not be improved"},
    {DiagnosticCode::volume_changed, "volume-changed", Severity::note, Yields::never,
     "volume of a material changed"},
    {DiagnosticCode::parts_touch, "parts-touch", Severity::note, Yields::never,
     "parts that touch without a common face"},
    {DiagnosticCode::gap_closed, "gap-closed", Severity::note, Yields::never, "gap closed on purpose"},
    {DiagnosticCode::wall_left_out, "wall-left-out", Severity::note, Yields::never,
     "wall left out on purpose"},
    {DiagnosticCode::crease_patches_dropped, "crease-patches-dropped", Severity::note, Yields::never,
     "patches too small for their sharp edges"},
    {DiagnosticCode::specks_dropped, "specks-dropped", Severity::note, Yields::never, "specks left out"},
    {DiagnosticCode::not_compared, "not-compared", Severity::note, Yields::never,
     "solid not compared with its input"},
    {DiagnosticCode::solid_uncertain, "solid-uncertain", Severity::note, Yields::never,
     "solid differs from an estimate", false},
    {DiagnosticCode::thin_parts, "thin-parts", Severity::note, Yields::never, "parts thin for the cells"},
    {DiagnosticCode::thin_parts_uncertain, "thin-parts-uncertain", Severity::note, Yields::never,
     "parts thin for the cells, kept by an estimate", false},
    {DiagnosticCode::not_written, "not-written", Severity::note, Yields::never,
     "something the output format cannot hold"},
    {DiagnosticCode::names_changed, "names-changed", Severity::note, Yields::never,
     "names or numbers changed for the output format"},
    {DiagnosticCode::points_merged, "points-merged", Severity::note, Yields::never, "equal points merged"},
    {DiagnosticCode::points_unused, "points-unused", Severity::note, Yields::never, "unused points left out"},
    {DiagnosticCode::triangles_collapsed, "triangles-collapsed", Severity::note, Yields::never,
     "triangles with equal corners left out"},
    {DiagnosticCode::triangles_repeated, "triangles-repeated", Severity::note, Yields::never,
     "repeated triangles left out"},
    {DiagnosticCode::triangles_flat, "triangles-flat", Severity::note, Yields::never,
     "triangles without area"},
    {DiagnosticCode::edges_non_manifold, "edges-non-manifold", Severity::note, Yields::never,
     "edges of more than two triangles"},
    {DiagnosticCode::inner_walls_dropped, "inner-walls-dropped", Severity::note, Yields::never,
     "inner walls left out"},
    {DiagnosticCode::triangles_turned, "triangles-turned", Severity::note, Yields::never,
     "triangles turned over"},
    {DiagnosticCode::holes_closed, "holes-closed", Severity::note, Yields::never, "holes closed"},
    {DiagnosticCode::surface_self_intersects, "surface-self-intersects", Severity::note, Yields::never,
     "surface intersects itself"},
    {DiagnosticCode::components_turned, "components-turned", Severity::note, Yields::never,
     "components turned outwards"},
    {DiagnosticCode::components_unclear, "components-unclear", Severity::note, Yields::never,
     "components without a clear outside"},
    {DiagnosticCode::components_alike, "components-alike", Severity::note, Yields::never,
     "enclosed components taken as solid"},
    {DiagnosticCode::components_alternate, "components-alternate", Severity::note, Yields::never,
     "enclosed components taken in turns"},
    {DiagnosticCode::cavities_filled, "cavities-filled", Severity::note, Yields::never, "cavities filled"},
    {DiagnosticCode::components_separated, "components-separated", Severity::note, Yields::never,
     "enclosed components as materials of their own"},
    {DiagnosticCode::names_qualified, "names-qualified", Severity::note, Yields::never,
     "names that several bodies have"},
    {DiagnosticCode::no_outside, "no-outside", Severity::note, Yields::never, "volume without outside"},
    {DiagnosticCode::islands_merged, "islands-merged", Severity::note, Yields::never, "small islands merged"},
    {DiagnosticCode::islands_all_small, "islands-all-small", Severity::note, Yields::never,
     "only small islands"},
    {DiagnosticCode::tet_points_merged, "tet-points-merged", Severity::note, Yields::never,
     "repeated points merged"},
    {DiagnosticCode::tets_collapsed, "tets-collapsed", Severity::note, Yields::never,
     "collapsed tets left out"},
    {DiagnosticCode::tets_turned, "tets-turned", Severity::note, Yields::never, "tets turned"},
    {DiagnosticCode::tets_inverted, "tets-inverted", Severity::note, Yields::never, "flat or negative tets"},
    {DiagnosticCode::patch_faces_lost, "patch-faces-lost", Severity::note, Yields::never,
     "faces of patches lost"},
    {DiagnosticCode::input_dropped, "input-dropped", Severity::note, Yields::never,
     "content of the file left out"},
    {DiagnosticCode::input_restored, "input-restored", Severity::note, Yields::never,
     "content of the file found again"},
    {DiagnosticCode::materials_missing, "materials-missing", Severity::error, Yields::never,
     "materials missing"},
    {DiagnosticCode::index_out_of_range, "index-out-of-range", Severity::error, Yields::never,
     "points that do not exist"},
    {DiagnosticCode::coordinates_not_finite, "coordinates-not-finite", Severity::error, Yields::never,
     "coordinates that are not finite"},
    {DiagnosticCode::degenerate_tets, "degenerate-tets", Severity::error, Yields::never,
     "tets with a repeated vertex"},
    {DiagnosticCode::duplicate_tets, "duplicate-tets", Severity::error, Yields::never, "repeated tets"},
    {DiagnosticCode::unused_points, "unused-points", Severity::warning, Yields::never, "unused points"},
    {DiagnosticCode::inverted, "inverted", Severity::error, Yields::never, "inverted or flat tets"},
    {DiagnosticCode::face_over_shared, "face-over-shared", Severity::error, Yields::never,
     "faces of more than two tets"},
    {DiagnosticCode::boundary_edges_not_two, "boundary-edges-not-two", Severity::error, Yields::never,
     "non-manifold boundary edges"},
    {DiagnosticCode::boundary_points_non_manifold, "boundary-points-non-manifold", Severity::error,
     Yields::never, "non-manifold boundary points"},
    {DiagnosticCode::point_star_split, "point-star-split", Severity::error, Yields::never,
     "tets that touch in a point"},
    {DiagnosticCode::self_intersections, "self-intersections", Severity::error, Yields::never,
     "intersecting triangles"},
    {DiagnosticCode::topology_differs, "topology-differs", Severity::error, Yields::never,
     "another topology"},
    {DiagnosticCode::tolerance_exceeded, "tolerance-exceeded", Severity::error, Yields::never,
     "not within the tolerance"},
    {DiagnosticCode::usage, "usage", Severity::error, Yields::never, "wrong call"},
    {DiagnosticCode::input, "input", Severity::error, Yields::never, "bad input"},
    {DiagnosticCode::nothing_to_mesh, "nothing-to-mesh", Severity::error, Yields::never, "nothing to mesh"},
    {DiagnosticCode::output, "output", Severity::error, Yields::never, "no output"},
    {DiagnosticCode::internal, "internal", Severity::error, Yields::never, "a bug in tetwright"},
    {DiagnosticCode::interrupted, "interrupted", Severity::error, Yields::never, "interrupted"},
});

constexpr bool in_order() {
  for (std::size_t i = 0; i < kinds.size(); ++i)
    if (static_cast<std::size_t>(kinds[i].code) != i) return false;
  return kinds.back().code == DiagnosticCode::interrupted;
}
static_assert(in_order());

}  // namespace

std::span<const DiagnosticKind> diagnostic_kinds() { return kinds; }

const DiagnosticKind& kind_of(DiagnosticCode code) { return kinds[static_cast<std::size_t>(code)]; }

const char* name_of(Severity severity) {
  switch (severity) {
    case Severity::note:
      return "note";
    case Severity::shortfall:
      return "shortfall";
    case Severity::warning:
      return "warning";
    case Severity::error:
      return "error";
  }
  return "";
}

std::string diagnostic_text(const Diagnostic& d) {
  std::string text = d.count > 0 ? std::to_string(d.count) + " " + d.what : d.what;
  if (!d.done.empty()) text += " (" + d.done + ")";
  if (d.severity == Severity::shortfall && !d.remedy.empty()) text += "; " + d.remedy;
  return text;
}

}  // namespace tetwright
