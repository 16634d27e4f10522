// SPDX-License-Identifier: Apache-2.0
#include "tools/report/page/page.h"

#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/io/encodings/base64.h"
#include "tetwright/mesh_quality.h"
#include "tools/report/page/charts.h"
#include "tools/report/page/embedded.h"
#include "tools/report/page/entries.h"
#include "tools/report/page/html_text.h"
#include "tools/report/page/tables.h"

namespace tetwright {

namespace {

/// The template with what stands for each `{{name}}`. What is put in is not looked at again.
std::string filled_in(std::string_view text, const std::map<std::string_view, std::string>& parts) {
  std::size_t size = text.size();
  for (const auto& [name, part] : parts) size += part.size();
  std::string out;
  out.reserve(size);
  for (;;) {
    const std::size_t open = text.find("{{");
    out += text.substr(0, open);
    if (open == std::string_view::npos) return out;
    const std::size_t close = text.find("}}", open);
    out += parts.at(text.substr(open + 2, close - open - 2));
    text.remove_prefix(close + 2);
  }
}

std::vector<ChartMesh> chart_meshes(const CommandLine& line, const PrepareReport& run) {
  std::vector<ChartMesh> meshes;
  const bool changed = line.command != Command::mesh && line.command != Command::check;
  if (changed && run.dense)
    meshes.push_back({line.command == Command::prepare ? "dense mesh" : "before", &*run.dense});
  if (run.result) meshes.push_back({changed ? "result" : "mesh", &*run.result});
  return meshes;
}

nlohmann::json materials_json(const PageMesh& page, const PrepareReport& run) {
  nlohmann::json materials = nlohmann::json::array();
  for (const MaterialTag tag : page.materials) {
    const auto name = run.material_names.find(tag);
    materials.push_back(
        {{"tag", tag},
         {"name", name == run.material_names.end() ? "material " + std::to_string(tag) : name->second}});
    if (const auto colour = run.material_colours.find(tag); colour != run.material_colours.end())
      materials.back()["colour"] = colour->second;
  }
  return materials;
}

void add_marks(const std::vector<PageEntry>& entries, nlohmann::json& marks) {
  for (const PageEntry& entry : entries)
    for (const Vec3& p : entry.places)
      marks.push_back({{"place", {p.x(), p.y(), p.z()}}, {"text", entry.text}});
}

/// Data for the script besides the arrays.
std::string description(const PageMesh& page, const PrepareReport& run, const PageEntries& entries) {
  nlohmann::json marks = nlohmann::json::array();
  add_marks(entries.short_of, marks);
  add_marks(entries.found, marks);
  add_marks(entries.worst, marks);
  const Vec3& o = page.points.origin;
  const nlohmann::json j = {{"whole", page.whole},
                            {"layers", page.layers},
                            {"points", page.point_count},
                            {"tets", page.tet_count},
                            {"triangles", page.triangle_count},
                            {"index_bytes", page.index_bytes},
                            {"material_bytes", page.material_bytes},
                            {"materials", materials_json(page, run)},
                            {"origin", {o.x(), o.y(), o.z()}},
                            {"step", page.points.step},
                            {"solid_angle_max", regular_solid_angle},
                            {"dihedral_max", regular_dihedral},
                            {"distance_max", page.max_distance},
                            {"distance_from", page.distance_from},
                            {"marks", marks}};
  constexpr bool ascii_only = true;
  return script_json(j.dump(-1, ' ', ascii_only, nlohmann::json::error_handler_t::replace));
}

/// The arrays, each in an element of its own, so that the browser hands out one long text for each.
std::string arrays(const PageMesh& page) {
  std::string out;
  const auto add = [&](const char* name, const std::string& bytes) {
    if (bytes.empty()) return;
    out.append("<script type=\"text/plain\" id=\"").append(name).append("\">");
    append_base64(out, bytes);
    out += "</script>\n";
  };
  add("points", page.points.bytes);
  add("tets", page.tets);
  add("tags", page.tags);
  add("solid", page.solid);
  add("dihedral", page.dihedral);
  add("layer", page.layer);
  add("triangles", page.triangles);
  add("sides", page.sides);
  add("distance", page.distance);
  return out;
}

/// Notice on the parts of a large mesh that the page leaves out; empty if it shows the whole mesh.
std::string not_shown(const PageMesh& page, const TetMesh& mesh) {
  if (page.whole) return "";
  std::string out = "The mesh has " + grouped_number(mesh.tets.size()) +
                    " tets, too many for a page, which shows the boundary and the interfaces";
  if (page.coarsened) out += ", coarsened to " + grouped_number(page.triangle_count) + " triangles";
  out += ", and whole tets only along cuts through the middle";
  const char* axes[] = {"x", "y", "z"};
  std::string missing;
  for (std::size_t a = 0; a < 3; ++a)
    if (!page.layers[a]) missing += (missing.empty() ? "" : ", ") + std::string(axes[a]);
  if (!missing.empty()) out += " (not across " + missing + ", where they are too many)";
  return "<p class=\"notice\">" + html_text(out + ". Histograms and statistics are of all tets.") + "</p>";
}

std::string section(const char* heading, const std::string& content) {
  return content.empty() ? "" : std::string("<section><h2>") + heading + "</h2>" + content + "</section>";
}

std::string lists(const PageEntries& entries) {
  std::size_t mark = 1;
  std::string out;
  if (!entries.short_of.empty()) out += section("Shortfalls", entries_list(entries.short_of, mark));
  if (!entries.found.empty()) out += section("Findings", entries_list(entries.found, mark));
  if (!entries.worst.empty()) out += section("Worst shapes", entries_list(entries.worst, mark));
  return out;
}

std::string title_of(const CommandLine& line, const PrepareReport& run) {
  const bool named = !line.outputs.mesh.empty() && line.outputs.mesh != "-";
  const std::string& file = named || run.inputs.empty() ? line.outputs.mesh : run.inputs.front();
  return file.substr(file.find_last_of('/') + 1);
}

}  // namespace

std::string report_page(const CommandLine& line, const PrepareReport& run, const TetMesh& mesh,
                        const SurfaceDistances* distances, const CheckReport* check,
                        const PageLimits& limits) {
  const PageMesh page = page_mesh(mesh, distances, limits);
  const PageEntries entries = page_entries(run, mesh, check);
  const std::vector<ChartMesh> meshes = chart_meshes(line, run);
  return filled_in(
      embedded::page_html,
      {{"title", html_text(title_of(line, run))},
       {"call", html_text("tetwright" + line.arguments)},
       {"version", TETWRIGHT_VERSION},
       {"not_shown", not_shown(page, mesh)},
       {"lists", lists(entries)},
       {"figures", meshes.empty() ? "" : figures_table(meshes, line.options.shapes.bound())},
       {"materials", run.result ? materials_table(run) : ""},
       {"quality", quality_charts(meshes)},
       {"angles", solid_angle_chart(meshes) + dihedral_chart(meshes)},
       {"iterations", run.simplify ? section("Iterations", iterations_chart(run.simplify->iterations)) : ""},
       {"style", std::string(embedded::page_css)},
       {"three", std::string(embedded::three_js)},
       {"scripts",
        std::string(embedded::mesh_js) + std::string(embedded::view_js) + std::string(embedded::page_js)},
       {"description", description(page, run, entries)},
       {"arrays", arrays(page)}});
}

}  // namespace tetwright
