// SPDX-License-Identifier: Apache-2.0
#include "tools/report/diagnostics_json.h"

namespace tetwright {

namespace {

/// Name of an unmet request in "shortfall". These names are older than the codes and equivalent to them.
const char* request_name(DiagnosticCode code) {
  switch (code) {
    case DiagnosticCode::target_missed:
      return "target_tets";
    case DiagnosticCode::angle_missed:
      return "min_solid_angle";
    case DiagnosticCode::tolerance_missed:
      return "tolerance";
    case DiagnosticCode::surface_not_shown:
      return "surface_shown";
    case DiagnosticCode::edges_too_long:
      return "max_edge";
    case DiagnosticCode::edges_too_short:
      return "min_edge";
    case DiagnosticCode::sizes_missed:
      return "size_field";
    case DiagnosticCode::solid_changed:
      return "fidelity";
    case DiagnosticCode::sheets_changed:
      return "sheets";
    case DiagnosticCode::thin_walls_changed:
      return "thin_walls";
    case DiagnosticCode::contacts_changed:
      return "contacts";
    case DiagnosticCode::creases_changed:
      return "creases";
    case DiagnosticCode::patches_lost:
      return "patches";
    case DiagnosticCode::labels_lost:
    case DiagnosticCode::labels_changed:
      return "labels";
    case DiagnosticCode::time_limit_reached:
      return "time_limit";
    case DiagnosticCode::cells_enlarged:
      return "memory_limit";
    default:
      return "notes";
  }
}

}  // namespace

nlohmann::json place_json(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

nlohmann::json diagnostics_json(const std::vector<Diagnostic>& all) {
  nlohmann::json j = nlohmann::json::array();
  for (const Diagnostic& d : all) {
    nlohmann::json places = nlohmann::json::array();
    for (const Vec3& p : d.places) places.push_back(place_json(p));
    j.push_back({{"code", kind_of(d.code).name},
                 {"severity", name_of(d.severity)},
                 {"message", diagnostic_text(d)},
                 {"places", places}});
    if (!d.file.empty()) j.back()["file"] = d.file;
    if (d.count > 0) j.back()["count"] = d.count;
    if (d.asked) j.back()["asked"] = *d.asked;
    if (d.reached) j.back()["reached"] = *d.reached;
    if (!d.limited_by.empty()) j.back()["limited_by"] = d.limited_by;
  }
  return j;
}

nlohmann::json shortfall_json(const std::vector<Diagnostic>& all) {
  nlohmann::json j = nlohmann::json::array();
  for (const Diagnostic& d : all)
    if (d.severity == Severity::shortfall)
      j.push_back({{"what", request_name(d.code)},
                   {"asked", d.asked.value_or(0)},
                   {"reached", d.reached.value_or(0)},
                   {"held_back_by", d.limited_by}});
  return j;
}

}  // namespace tetwright
