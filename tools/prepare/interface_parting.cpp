// SPDX-License-Identifier: Apache-2.0
#include "tools/prepare/interface_parting.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "common/message_text.h"
#include "common/trimmed.h"
#include "tetwright/error.h"
#include "tetwright/io.h"
#include "tetwright/mesh_quality.h"

namespace tetwright {

namespace {

constexpr const char* all_interfaces = "all";

using Materials = std::pair<MaterialTag, MaterialTag>;

const char* option_of(const InterfaceRequest& request) {
  return request.cohesive ? "--cohesive" : "--split-interface";
}

/// Faces inside a mesh that can part.
struct InnerFaces {
  explicit InnerFaces(const TetMesh& mesh) {
    for (const InterfaceTriangle& face : mesh.interfaces) {
      if (!face.other) continue;
      if (!face.is_sheet()) pairs.emplace(face.material, *face.other);
      const auto group = mesh.patch_groups.find({face.pair(), face.patch});
      if (group != mesh.patch_groups.end() && !group->second.name.empty()) names.insert(group->second.name);
    }
  }
  std::set<Materials> pairs;
  std::set<std::string> names;  ///< of sheets and groups
};

/// Tag of a material with this name or tag.
std::optional<MaterialTag> material_called(const TetMesh& mesh, const std::string& text) {
  for (const auto& [tag, name] : mesh.material_names)
    if (name == text) return tag;
  MaterialTag tag = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), tag);
  if (error == std::errc() && end == text.data() + text.size() &&
      std::find(mesh.materials.begin(), mesh.materials.end(), tag) != mesh.materials.end())
    return tag;
  return {};
}

/// The two materials of "A,B". Their names may have commas, too.
std::optional<Materials> materials_called(const TetMesh& mesh, const std::string& text) {
  for (std::size_t comma = text.find(','); comma != std::string::npos; comma = text.find(',', comma + 1)) {
    const auto a = material_called(mesh, std::string(trimmed(text.substr(0, comma))));
    const auto b = material_called(mesh, std::string(trimmed(text.substr(comma + 1))));
    if (a && b) return std::minmax(*a, *b);
  }
  return {};
}

/// The faces of a request; none if it has no faces.
std::vector<InterfaceToPart> faces_of(const InterfaceRequest& request, const TetMesh& mesh,
                                      const InnerFaces& inner) {
  std::vector<InterfaceToPart> faces;
  if (request.faces == all_interfaces) {
    for (const Materials& pair : inner.pairs) faces.push_back({pair, {}, request.cohesive});
    return faces;
  }
  if (const auto pair = materials_called(mesh, request.faces); pair && inner.pairs.contains(*pair))
    faces.push_back({*pair, {}, request.cohesive});
  if (faces.empty() && inner.names.contains(request.faces))
    faces.push_back({std::nullopt, request.faces, request.cohesive});
  return faces;
}

void report_missing(const InterfaceRequest& request, const TetMesh& mesh, const InnerFaces& inner,
                    PrepareReport& report) {
  std::vector<std::string> there;
  const auto name = [&](MaterialTag tag) {
    const auto known = mesh.material_names.find(tag);
    return known == mesh.material_names.end() ? std::to_string(tag) : known->second;
  };
  for (const auto& [a, b] : inner.pairs) there.push_back(name(a) + "," + name(b));
  there.insert(there.end(), inner.names.begin(), inner.names.end());
  report.diagnostics.push_back(
      {.code = DiagnosticCode::interface_not_found,
       .what = std::string(option_of(request)) + " " + in_quotes(request.faces) + ": no faces to part; " +
               (there.empty() ? "the mesh has no interface between materials and no sheet"
                              : "there are " + quoted_list(there))});
}

void report_parted(const std::vector<PartedInterface>& parted, PrepareReport& report) {
  for (const PartedInterface& p : parted) {
    if (!p.renamed_groups.empty())
      report.diagnostics.push_back({.code = DiagnosticCode::names_changed,
                                    .what = "names of patches (" + quoted_list(p.renamed_groups) + ")",
                                    .count = p.renamed_groups.size(),
                                    .done = "replaced by those of the sides, " + in_quotes(p.sides[0]) +
                                            " and " + in_quotes(p.sides[1])});
    if (p.joined_faces == 0) continue;
    report.diagnostics.push_back(
        {.code = DiagnosticCode::faces_not_parted,
         .what = "of " + std::to_string(p.faces + p.joined_faces) + " faces of " + in_quotes(p.name),
         .count = p.joined_faces,
         .done = "stay joined, as all their corners lie on its border",
         .places = p.joined_places});
  }
}

}  // namespace

void check_parting(const PrepareOptions& options) {
  for (const InterfaceRequest& request : options.parting) {
    if (request.faces.empty())
      throw UsageError(std::string(option_of(request)) +
                       " without a name; give A,B (two materials), all, or the name of a sheet");
    if (request.cohesive && options.order == 2)
      throw UsageError(
          "--cohesive makes wedges of six nodes, which do not fit tets of second order; leave out "
          "either it or --order 2");
  }
}

void part_result(Prepared& result, std::span<const InterfaceToPart> joined, PrepareRun& run) {
  TetMesh& mesh = result.mesh;
  std::vector<InterfaceToPart> faces;
  const InnerFaces inner(mesh);
  for (const InterfaceRequest& request : run.options.parting) {
    const std::vector<InterfaceToPart> found = faces_of(request, mesh, inner);
    if (found.empty()) report_missing(request, mesh, inner, run.report);
    faces.insert(faces.end(), found.begin(), found.end());
  }
  faces.insert(faces.end(), joined.begin(), joined.end());
  // The first one with a face decides: cohesive ones, and groups before the materials that they lie between.
  std::stable_sort(faces.begin(), faces.end(), [](const InterfaceToPart& a, const InterfaceToPart& b) {
    return std::pair(!a.cohesive, a.materials.has_value()) < std::pair(!b.cohesive, b.materials.has_value());
  });
  if (!faces.empty()) run.report.parted = part_interfaces(mesh, run.midside ? &*run.midside : nullptr, faces);
  report_parted(run.report.parted, run.report);
  if (run.report.result) run.report.result->points = mesh.points.size();
  decide_severities(run.options.acceptance, run.report);
}

}  // namespace tetwright
