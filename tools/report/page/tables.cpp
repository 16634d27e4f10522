// SPDX-License-Identifier: Apache-2.0
#include "tools/report/page/tables.h"

#include <functional>

#include "common/message_text.h"
#include "tools/report/page/html_text.h"

namespace tetwright {

namespace {

/// A row of figures, one for each mesh.
struct Row {
  std::string name;
  std::function<std::string(const MeshStatistics&)> value;
};

std::vector<Row> rows(double threshold) {
  constexpr int angle_decimals = 4, percent_decimals = 3;
  return {
      {"tets", [](const MeshStatistics& m) { return grouped_number(m.tets); }},
      {"points", [](const MeshStatistics& m) { return grouped_number(m.points); }},
      {"materials", [](const MeshStatistics& m) { return grouped_number(m.materials.size()); }},
      {"volume", [](const MeshStatistics& m) { return short_number(m.volume); }},
      {"smallest solid angle, sr",
       [](const MeshStatistics& m) { return fixed_number(m.min_solid_angle, angle_decimals); }},
      {"mean of the smallest solid angles, sr",
       [](const MeshStatistics& m) { return fixed_number(m.mean_solid_angle, angle_decimals); }},
      {"tets below " + short_number(threshold) + " sr, %",
       [](const MeshStatistics& m) { return fixed_number(m.below_percent, percent_decimals); }},
      {"smallest dihedral angle, degrees",
       [](const MeshStatistics& m) { return fixed_number(m.min_dihedral, 1); }},
      {"largest dihedral angle, degrees",
       [](const MeshStatistics& m) { return fixed_number(m.max_dihedral, 1); }},
  };
}

std::string cell(const std::string& text) { return "<td>" + html_text(text) + "</td>"; }

std::string mark_button(std::size_t number, const Vec3& place) {
  const std::string n = std::to_string(number);
  return " <button type=\"button\" class=\"mark\" data-mark=\"" + n + "\" title=\"Show the location " +
         place_text(place) + "\">" + n + "</button>";
}

/// Cause and remedy, as the guide has them, without its marks for code.
std::string explanation(const DiagnosticKind& kind) {
  std::string text = std::string(kind.cause) + " " + kind.remedy;
  std::erase(text, '`');
  return text;
}

}  // namespace

std::string figures_table(std::span<const ChartMesh> meshes, double threshold) {
  std::string out = "<table><thead><tr><th></th>";
  for (const ChartMesh& m : meshes) out += "<th scope=\"col\">" + html_text(m.name) + "</th>";
  out += "</tr></thead><tbody>";
  for (const Row& row : rows(threshold)) {
    out += "<tr><th scope=\"row\">" + html_text(row.name) + "</th>";
    for (const ChartMesh& m : meshes) out += cell(row.value(*m.statistics));
    out += "</tr>";
  }
  return out + "</tbody></table>";
}

std::string materials_table(const PrepareReport& run) {
  std::string out =
      "<table><thead><tr><th scope=\"col\">material</th><th scope=\"col\">tag</th><th "
      "scope=\"col\">tets</th><th scope=\"col\">volume</th></tr></thead><tbody>";
  for (const auto& [tag, material] : run.result->materials) {
    const auto name = run.material_names.find(tag);
    out += "<tr><th scope=\"row\">" +
           html_text(name == run.material_names.end() ? "material " + std::to_string(tag) : name->second) +
           "</th>" + cell(std::to_string(tag)) + cell(grouped_number(material.tets)) +
           cell(short_number(material.volume)) + "</tr>";
  }
  return out + "</tbody></table>";
}

std::string entries_list(const std::vector<PageEntry>& entries, std::size_t& first_mark) {
  std::string out = "<ul class=\"entries\">";
  for (const PageEntry& entry : entries) {
    out += "<li>" + html_text(entry.text);
    if (entry.kind)
      out += " <code title=\"" + html_text(explanation(*entry.kind)) + "\">" + html_text(entry.kind->name) +
             "</code>";
    if (!entry.detail.empty()) out += " <span class=\"detail\">" + html_text(entry.detail) + "</span>";
    for (const Vec3& place : entry.places) out += mark_button(first_mark++, place);
    out += "</li>";
  }
  return out + "</ul>";
}

}  // namespace tetwright
