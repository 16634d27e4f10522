// SPDX-License-Identifier: Apache-2.0
#include "tools/report/stats_json.h"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tetwright/prepare_steps.h"
#include "tetwright/resources.h"
#include "tools/report/diagnostics_json.h"
#include "tools/report/face_sets_json.h"
#include "tools/report/features_json.h"
#include "tools/report/stage_times_json.h"
#include "tools/report/values_json.h"
#include "tools/report/volume_json.h"

namespace tetwright {

namespace {

nlohmann::json iteration_json(const IterationReport& it) {
  nlohmann::json operations = nlohmann::json::object(), rejections = nlohmann::json::object();
  for (std::size_t o = 0; o < operation_count; ++o) {
    const auto operation = static_cast<Operation>(o);
    const std::string name(operation_names[o]);
    operations[name] = {{"tried", it.counts.tried(operation)},
                        {"done", it.counts.of(operation, Outcome::done)}};
    nlohmann::json reasons = nlohmann::json::object();
    for (std::size_t r = 1; r < outcome_count; ++r)  // outcome 0 is `done`
      if (const auto n = it.counts.of(operation, static_cast<Outcome>(r)))
        reasons[std::string(outcome_names[r])] = n;
    rejections[name] = reasons;
  }
  return {{"kind", it.kind},
          {"tets_before", it.tets_before},
          {"tets_after", it.tets_after},
          {"tets_by_quality", it.tets_by_quality},
          {"cutoff", it.cutoff},
          {"percent", it.percent},
          {"largest_error", it.max_error},
          {"operations", operations},
          {"rejections", rejections},
          {"lock_conflicts", it.conflicts},
          {"repeats", it.repeats},
          {"batches", it.batches},
          {"skipped", 0},  // a key of the schema; always 0
          {"seconds", it.seconds}};
}

bool is_flat(const nlohmann::json& json) {
  return std::none_of(json.begin(), json.end(),
                      [](const nlohmann::json& item) { return item.is_structured(); });
}

/// Appends the text of a document: an indented line for each value, but one line for a list of plain values,
/// since histograms have hundreds of numbers. Bytes that are not UTF-8 become replacement characters.
void append_json(const nlohmann::json& json, std::size_t indent, std::string& out) {
  if (!json.is_structured() || json.empty() || (json.is_array() && is_flat(json))) {
    out += json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    return;
  }
  const bool object = json.is_object();
  out += object ? '{' : '[';
  bool first = true;
  for (const auto& [key, value] : json.items()) {
    out += first ? "\n" : ",\n";
    first = false;
    out.append(indent + 1, ' ');
    if (object) {
      append_json(key, 0, out);
      out += ": ";
    }
    append_json(value, indent + 1, out);
  }
  out += '\n';
  out.append(indent, ' ');
  out += object ? '}' : ']';
}

std::string json_text(const nlohmann::json& json) {
  std::string out;
  append_json(json, 0, out);
  return out;
}

std::string name_of(MaterialTag tag, const std::map<MaterialTag, std::string>& names) {
  const auto name = names.find(tag);
  return name == names.end() ? "" : name->second;
}

/// The second region is null for outside.
nlohmann::json pair_json(const MaterialPair& pair) {
  nlohmann::json other;
  if (pair.second) other = *pair.second;
  return nlohmann::json::array({pair.first, other});
}

nlohmann::json topology_json(const Topology& t, const std::map<MaterialTag, std::string>& names) {
  const auto solid = [](const Topology::Solid& s) {
    return nlohmann::json{{"components", s.components},
                          {"euler", s.euler},
                          {"boundary_components", s.boundary_components},
                          {"boundary_euler", s.boundary_euler}};
  };
  nlohmann::json j{{"domain", solid(t.domain)},
                   {"materials", nlohmann::json::array()},
                   {"interfaces", nlohmann::json::array()}};
  for (const auto& [tag, of_tag] : t.materials) {
    j["materials"].push_back(solid(of_tag));
    j["materials"].back()["tag"] = tag;
    j["materials"].back()["name"] = name_of(tag, names);
  }
  for (const auto& [pair, surface] : t.interfaces)
    j["interfaces"].push_back(
        {{"materials", pair_json(pair)}, {"components", surface.components}, {"euler", surface.euler}});
  for (const auto& [name, sheet] : t.sheets)
    j["sheets"].push_back({{"name", name}, {"components", sheet.components}, {"euler", sheet.euler}});
  if (t.touching_fans) j["touching_fans"] = *t.touching_fans;
  if (t.junction_curves)
    j["junction_curves"] = {{"components", t.junction_curves->components},
                            {"euler", t.junction_curves->euler},
                            {"branch_points", t.junction_curves->branch_points}};
  return j;
}

/// \param names names of the materials that have one
/// \param threshold solid angle with which the statistics were computed, steradians
nlohmann::json mesh_json(const MeshStatistics& m, const std::map<MaterialTag, std::string>& names,
                         double threshold) {
  nlohmann::json materials = nlohmann::json::array();
  for (const auto& [tag, material] : m.materials)
    materials.push_back(
        {{"tag", tag}, {"name", name_of(tag, names)}, {"tets", material.tets}, {"volume", material.volume}});
  nlohmann::json interfaces = nlohmann::json::array();
  for (const auto& [pair, interface] : m.interfaces) {
    interfaces.push_back(
        {{"materials", pair_json(pair)}, {"triangles", interface.triangles}, {"area", interface.area}});
  }
  nlohmann::json j = {{"tets", m.tets},
                      {"points", m.points},
                      {"interfaces", interfaces},
                      {"junction_edges", m.junction_edges},
                      {"materials", materials},
                      {"volume", m.volume},
                      {"min_solid_angle", m.min_solid_angle},
                      {"mean_solid_angle", m.mean_solid_angle},
                      {"threshold", threshold},
                      {"percent_below_threshold", m.below_percent},
                      {"min_dihedral", m.min_dihedral},
                      {"max_dihedral", m.max_dihedral},
                      {"histogram", m.histogram.counts}};
  for (const SheetStatistics& s : m.sheets)
    j["sheets"].push_back({{"name", s.name},
                           {"triangles", s.triangles},
                           {"area", s.area},
                           {"pieces", s.pieces},
                           {"border_length", s.border_length},
                           {"border_pieces", s.border_pieces}});
  return j;
}

nlohmann::json input_json(const PrepareReport& run) {
  nlohmann::json j = {
      {"files", run.inputs}, {"triangles", run.input_triangles}, {"points", run.input_points}};
  if (!run.material_field.empty()) j["material_field"] = run.material_field;
  if (const std::string& space = run.space_of_result(); !space.empty()) j["space"] = space;
  if (run.volume) j["volume"] = volume_json(*run.volume, run.material_colours);
  j["findings"] = nlohmann::json::array();
  for (const Diagnostic& d : run.diagnostics) {
    if (d.severity != Severity::note || d.file.empty()) continue;
    nlohmann::json finding = {
        {"file", d.file}, {"what", d.what}, {"count", std::max<std::size_t>(1, d.count)}, {"done", d.done}};
    if (!d.places.empty()) finding["place"] = place_json(d.places.front());
    j["findings"].push_back(finding);
  }
  return j;
}

nlohmann::json parts_json(std::size_t touching, std::size_t by_faces) {
  if (by_faces == LabelParts().by_faces) return nullptr;
  return {touching, by_faces};
}

nlohmann::json solid_json(const SolidNumbers& s) {
  return {
      {"volume", s.volume}, {"components", s.components}, {"handles", s.handles}, {"cavities", s.cavities}};
}

nlohmann::json solids_json(const std::vector<SolidComparison>& all) {
  nlohmann::json j = nlohmann::json::array();
  static constexpr const char* against[] = {"surface", "distances", "voxels"};
  for (const SolidComparison& f : all) {
    j.push_back({{"name", f.name},
                 {"tag", f.tag},
                 {"against", against[static_cast<std::size_t>(f.against)]},
                 {"expected", solid_json(f.expected)},
                 {"result", solid_json(f.result)},
                 {"same", f.same()},
                 {"certain", f.certain}});
    if (f.against == SolidComparison::Against::voxels) {
      nlohmann::json &expected = j.back()["expected"], &result = j.back()["result"];
      expected = {{"components", parts_json(f.expected.components, f.max_components)}};
      result = {{"components", f.result.components}};
      if (f.expected.volume > 0) expected["volume"] = f.expected.volume, result["volume"] = f.result.volume;
    }
    if (f.place) j.back()["place"] = place_json(*f.place);
  }
  return j;
}

nlohmann::json creases_json(const CreaseComparison& c) {
  return {{"length", c.length},
          {"max_distance", c.max_distance},
          {"p99_distance", c.p99_distance},
          {"place", place_json(c.place)},
          {"corners", c.corners},
          {"lost_corners", c.lost_corners},
          {"max_corner_distance", c.max_corner_distance},
          {"same", c.same()}};
}

nlohmann::json edge_lengths_json(const EdgeLengthReport& e, const RequestedSizes& sizes) {
  nlohmann::json j{{"edges", e.edges},
                   {"shortest", e.shortest},
                   {"longest", e.longest},
                   {"above_max", e.above_max.count},
                   {"below_min", e.below_min.count}};
  if (e.with_target_length > 0) {
    j["field"] = sizes.source->field();
    j["within_percent"] = 100 * e.within_share();
    j["median_ratio"] = e.median;
  }
  return j;
}

nlohmann::json deviation_json(const SurfaceDeviation& d) {
  return {{"lower", d.lower}, {"upper", d.upper}, {"place", place_json(d.place)}, {"rms", d.rms}};
}

nlohmann::json surface_json(const SurfaceComparison& c) {
  nlohmann::json j = {{"diagonal", c.diagonal},
                      {"outside_tets", c.outside_tets},
                      {"inverted", c.inverted},
                      {"open_edges", c.open_edges},
                      {"from_mesh", deviation_json(c.from_mesh)},
                      {"from_surface", deviation_json(c.from_surfaces)}};
  if (c.caps) {
    j["caps"] = deviation_json(c.caps->from_mesh);
    j["caps"]["area"] = c.caps->area;
    j["caps"]["share"] = c.caps->share;
  }
  if (c.solid)
    j["solid"] = {{"expected", solid_json(c.solid->expected)},
                  {"result", solid_json(c.solid->result)},
                  {"same", c.solid->same()}};
  // A distance that is infinite for lack of a counterpart becomes null.
  if (c.creases) j["creases"] = creases_json(*c.creases);
  if (c.mesh_creases) j["mesh_creases"] = creases_json(*c.mesh_creases);
  return j;
}

nlohmann::json patches_json(const std::vector<PatchComparison>& all) {
  nlohmann::json j = nlohmann::json::array();
  for (const PatchComparison& p : all)
    j.push_back({{"name", p.group.name},
                 {"number", p.group.number},
                 {"input_area", p.input_area},
                 {"area", p.area},
                 {"triangles", p.triangles}});
  return j;
}

nlohmann::json caps_json(const CapReport& report) {
  nlohmann::json j = {{"holes", report.holes},
                      {"flat", report.flat},
                      {"area", report.area},
                      {"share", report.boundary_area > 0 ? report.area / report.boundary_area : 0},
                      {"patches", nlohmann::json::array()}};
  for (const CapReport::Cap& cap : report.caps)
    j["patches"].push_back({{"name", cap.name},
                            {"triangles", cap.triangles},
                            {"area", cap.area},
                            {"centre", place_json(cap.centre)},
                            {"normal", place_json(cap.normal)},
                            {"named", cap.named},
                            {"flat", cap.flat},
                            {"crease", cap.sharp}});
  return j;
}

nlohmann::json contacts_json(const std::vector<ContactReport>& all) {
  nlohmann::json j = nlohmann::json::array();
  for (const ContactReport& c : all)
    j.push_back({{"first", c.first},
                 {"second", c.second},
                 {"area", c.area},
                 {"pieces", c.pieces},
                 {"largest_gap", c.largest_gap},
                 {"largest_overlap", c.largest_overlap}});
  return j;
}

nlohmann::json overlaps_json(const std::vector<OverlapReport>& all) {
  nlohmann::json j = nlohmann::json::array();
  for (const OverlapReport& o : all)
    j.push_back({{"first", o.first},
                 {"second", o.second},
                 {"volume", o.volume},
                 {"owner", o.owner},
                 {"place", place_json(o.place)}});
  return j;
}

nlohmann::json partition_json(const PartitionStatistics& partition) {
  nlohmann::json j = {{"imbalance", partition.imbalance},
                      {"cut_faces", partition.cut_faces},
                      {"each", nlohmann::json::array()}};
  for (const PartSize& part : partition.parts)
    j["each"].push_back({{"tets", part.tets},
                         {"points", part.points},
                         {"ghosts", part.ghosts},
                         {"neighbours", part.neighbours},
                         {"pieces", part.pieces}});
  return j;
}

/// Adds how the dense mesh was made to its statistics.
void add_mesher_json(const MesherReport& m, nlohmann::json& dense) {
  dense["cell_size"] = m.cell_size;
  dense["resolution"] = m.resolution;
  dense["cells"] = m.cells;
  dense["lattice_tets"] = m.lattice_tets;
  dense["refinement"] = m.refinement;
  dense["specks"] = m.isolated_vertices;
  dense["thin_parts"] = nlohmann::json::array();
  for (const ThinPartReport& t : m.thin_parts)
    dense["thin_parts"].push_back({{"name", t.name.empty() ? "outside" : t.name},
                                   {"places", t.places},
                                   {"first", place_json(t.first)},
                                   {"refined", t.refined}});
  dense["narrow_labels"] = {{"places", m.narrow_labels.places},
                            {"first", place_json(m.narrow_labels.first)},
                            {"at_border", m.narrow_labels.at_border},
                            {"first_at_border", place_json(m.narrow_labels.first_at_border)}};
  dense["filling_tets"] = m.filling_tets;
  dense["thickened_walls"] = {{"points", m.thickened.points},
                              {"offset", m.thickened.offset},
                              {"thickness", m.thickened.thickness},
                              {"place", place_json(m.thickened.place)}};
  dense["closed_gaps"] = nlohmann::json::array();
  for (const ClosedGapReport& g : m.closed_gaps)
    dense["closed_gaps"].push_back({{"material", g.name},
                                    {"kind", g.gap ? "gap" : "wall"},
                                    {"on_purpose", g.on_purpose},
                                    {"width", g.width},
                                    {"area", g.area},
                                    {"place", place_json(g.place)}});
}

nlohmann::json bricks_json(const BrickReport& bricks) {
  nlohmann::json json = {{"cells", bricks.cells},
                         {"count", bricks.bricks},
                         {"rounds", bricks.rounds},
                         {"repeated", bricks.repeated},
                         {"surfaces_kept", bricks.surfaces_kept},
                         {"resumed", bricks.resumed},
                         {"coarse_tets", bricks.coarse_tets},
                         {"scratch_bytes", static_cast<std::uint64_t>(bricks.scratch_bytes)}};
  if (!bricks.by_helpers.empty()) json["by_helpers"] = bricks.by_helpers;
  return json;
}

/// Diagnostics of the report, and the error if there is no result.
std::vector<Diagnostic> diagnostics_of(const CommandRun& ended) {
  std::vector<Diagnostic> all = ended.report.diagnostics;
  if (!ended.error.empty()) all.push_back({.code = error_code(ended.status), .what = ended.error});
  return all;
}

}  // namespace

std::size_t peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;  // Linux reports KiB
}

std::string stats_json(const CommandRun& ended) {
  const CommandLine& line = ended.line;
  const PrepareReport& run = ended.report;
  nlohmann::json j;
  j["version"] = TETWRIGHT_VERSION;
  j["command"] = name_of(line.command);
  j["status"] = static_cast<int>(ended.status);
  if (!ended.error.empty()) j["error"] = {{"message", ended.error}, {"stage", ended.stage}};
  j["notes"] = notes_of(run);
  j["threads"] = thread_count();
  j["seed"] = line.options.seed;
  if (run.simplify) {
    j["objective"] = name_of(line.options.shapes.objective);
    if (line.command == Command::improve) {
      j["only_below"] = line.options.shapes.only_below.value_or(0);
      j["free_count"] = line.options.shapes.free_count;
    } else {
      j["schedule"] = name_of(line.options.schedule.kind);
    }
  }
  j["input"] = input_json(run);
  if (run.dense) j["dense"] = mesh_json(*run.dense, run.material_names, line.options.shapes.bound());
  if (run.mesher) add_mesher_json(*run.mesher, j["dense"]);
  for (const MinTets& m : run.min_tets)
    j["min_tets"].push_back({{"name", m.name}, {"tets", m.tets}, {"thickness", m.thickness}});
  if (run.bricks) j["dense"]["bricks"] = bricks_json(*run.bricks);
  j["result"] =
      run.result ? mesh_json(*run.result, run.material_names, line.options.shapes.bound()) : nlohmann::json();
  if (run.simplify) j["result"]["held_by_input"] = run.input_limited;
  if (run.mesher) j["fidelity"] = solids_json(run.solids);
  if (!run.features.empty()) j["features"] = features_json(run.features);
  if (!run.patches.empty()) j["patches"] = patches_json(run.patches);
  if (run.caps) j["caps"] = caps_json(*run.caps);
  if (!run.contacts.empty()) j["contacts"] = contacts_json(run.contacts);
  if (!run.overlaps.empty()) j["overlaps"] = overlaps_json(run.overlaps);
  if (run.deviation)
    j["tolerance"] = {{"distance", run.tolerance},
                      {"held", run.deviation->upper() <= run.tolerance && run.lost_area() == 0},
                      {"from_mesh", deviation_json(run.deviation->from_mesh)},
                      {"from_surface", deviation_json(run.deviation->from_surface)},
                      {"apart_area", run.deviation->apart_area},
                      {"hidden_area", run.deviation->hidden_area}};
  if (run.second_order)
    j["second_order"] = {{"surface_edges", run.second_order->edges},
                         {"on_surface", run.second_order->on_surface},
                         {"part_way", run.second_order->part_way},
                         {"straight", run.second_order->straight}};
  if (!run.selected.empty()) j["selections"] = selections_json(run.selected);
  if (!run.parted.empty()) j["parted"] = parted_json(run.parted);
  if (!run.values.empty()) j["values"] = values_json(run.values);
  if (!run.bins.empty()) j["bins"] = bins_json(run.bins);
  if (ended.embedding) j["embedding"] = embedding_json(*ended.embedding);
  if (ended.parts) j["parts"] = partition_json(*ended.parts);
  if (ended.pieces_by_helpers) j["parts"]["by_helpers"] = *ended.pieces_by_helpers;
  if (ended.hdf5_ranks) j["parts"]["hdf5_ranks"] = *ended.hdf5_ranks;
  if (run.edge_lengths) j["edge_lengths"] = edge_lengths_json(*run.edge_lengths, run.sizes);
  if (run.crease_comparison) j["creases"] = creases_json(*run.crease_comparison);
  j["iterations"] = nlohmann::json::array();
  if (run.simplify)
    for (const IterationReport& it : run.simplify->iterations) j["iterations"].push_back(iteration_json(it));
  j["seconds"] = seconds_json(run);
  j["loops"] = loops_json(run);
  j["peak_bytes"] = peak_bytes();
  j["shortfall"] = shortfall_json(run.diagnostics);
  j["diagnostics"] = diagnostics_json(diagnostics_of(ended));
  return json_text(j);
}

std::string check_json(const CommandRun& ended, const CheckReport& check) {
  const CommandLine& line = ended.line;
  const PrepareReport& run = ended.report;
  nlohmann::json j = {{"valid", check.valid()}, {"findings", nlohmann::json::array()}};
  for (const MeshFinding& f : check.findings) {
    nlohmann::json places = nlohmann::json::array();
    for (const MeshPlace& place : f.places) {
      places.push_back({{"text", place.text}, {"points", place.points}});
      if (place.at) places.back()["at"] = place_json(*place.at);
    }
    const int number = static_cast<int>(f.code) - static_cast<int>(DiagnosticCode::materials_missing) + 1;
    j["findings"].push_back({{"number", number},
                             {"name", mesh_finding_name(f)},
                             {"severity", name_of(kind_of(f.code).severity)},
                             {"what", kind_of(f.code).message},
                             {"count", f.count},
                             {"places", places}});
  }
  std::vector<Diagnostic> diagnostics = diagnostics_of(check);
  diagnostics.insert(diagnostics.end(), run.diagnostics.begin(), run.diagnostics.end());
  j["diagnostics"] = diagnostics_json(diagnostics);
  if (check.measurable) {
    j["mesh"] = mesh_json(*run.result, run.material_names, line.options.shapes.bound());
    j["topology"] = topology_json(*check.topology, run.material_names);
  }
  if (check.topology_before) j["topology_before"] = topology_json(*check.topology_before, run.material_names);
  if (check.topology_differences) j["topology_differences"] = *check.topology_differences;
  if (check.surface) j["surface"] = surface_json(*check.surface);
  if (check.tolerance > 0)
    j["tolerance"] = {{"distance", check.tolerance}, {"held", check.within_tolerance()}};
  return json_text(j);
}

}  // namespace tetwright
