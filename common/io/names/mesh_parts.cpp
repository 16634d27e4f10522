// SPDX-License-Identifier: Apache-2.0
#include "common/io/names/mesh_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "common/material_names.h"
#include "common/mesh/boundary_groups.h"
#include "common/mesh/face_buckets.h"
#include "common/number_text.h"
#include "common/unique_names.h"
#include "tetwright/error.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/parted_interfaces.h"

namespace tetwright {

namespace {

/// Whether two triangles with the same vertices have the same orientation.
bool equally_oriented(const Triangle& a, const Triangle& b) {
  const auto first = static_cast<std::size_t>(std::find(b.begin(), b.end(), a[0]) - b.begin());
  return a[1] == b[(first + 1) % 3];
}

}  // namespace

NameRules printable_names() { return {.form = printable_name}; }

MeshParts names_of_parts(const TetMesh& mesh, const NameRules& rules) {
  const auto numbers_of = [&](const std::set<std::int64_t>& own) {
    if (rules.max_number > 0) return positive_numbers(own, rules.max_number);
    std::map<std::int64_t, std::int64_t> same;
    for (const std::int64_t number : own) same[number] = number;
    return same;
  };
  MeshParts parts;
  UniqueNames of_materials(rules.form, rules.ignore_case);
  std::map<MaterialTag, std::string> written;
  for (const auto& [own, number] : numbers_of(tags_of(mesh.materials))) {
    const auto tag = static_cast<MaterialTag>(own);
    written[tag] = of_materials.add(material_name(mesh.material_names, tag));
    parts.materials.push_back({tag, number, written[tag], {}});
  }

  const BoundaryGroups groups(mesh);
  UniqueNames of_surfaces(rules.form, rules.ignore_case);
  std::set<std::int64_t> own;
  for (const BoundaryGroups::Group& g : groups.all()) own.insert(g.number);
  const std::map<std::int64_t, std::int64_t> numbers = numbers_of(own);
  for (const BoundaryGroups::Group& g : groups.all())
    parts.surfaces.push_back({g.surface_region, rules.surface_numbers ? numbers.at(g.number) : 0, {}, {}});
  // Names of the input take precedence, among them those that the format can hold as they are.
  const auto precedence = [&](const BoundaryGroups::Group& g) {
    return g.pair ? 2 : rules.form(g.surface_region.name) != g.surface_region.name ? 1 : 0;
  };
  for (const int turn : {0, 1, 2})
    for (std::size_t i = 0; i < groups.all().size(); ++i) {
      const BoundaryGroups::Group& g = groups.all()[i];
      if (precedence(g) != turn) continue;
      std::string& name = parts.surfaces[i].name;
      if (g.pair)
        name = of_surfaces.add_pair(pair_name(*g.pair, written));
      else
        name = of_surfaces.add(g.surface_region.name.empty()
                                   ? "surface_" + std::to_string(g.surface_region.number)
                                   : g.surface_region.name);
    }
  return parts;
}

MeshParts mesh_parts(const TetMesh& mesh, const NameRules& rules) {
  MeshParts parts = names_of_parts(mesh, rules);
  std::map<MaterialTag, std::size_t> material_of;
  for (const MeshParts::Material& m : parts.materials) material_of.emplace(m.tag, material_of.size());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    parts.materials[material_of.at(mesh.materials[t])].tets.push_back(static_cast<Index>(t));
  const BoundaryGroups groups(mesh);
  std::map<std::int64_t, std::size_t> surface_of;
  for (const BoundaryGroups::Group& g : groups.all()) surface_of.emplace(g.number, surface_of.size());
  for (std::size_t i = 0; i < mesh.interfaces.size(); ++i)
    parts.surfaces[surface_of.at(groups.number_of(mesh.interfaces[i]))].faces.push_back(i);
  return parts;
}

std::vector<BinDivision> parts_of_bins(std::span<const TetBins> divisions,
                                       const std::vector<MeshParts::Material>& materials,
                                       const NameRules& rules) {
  if (divisions.empty()) return {};
  UniqueNames names(rules.form, rules.ignore_case);
  std::int64_t last = 0;
  for (const MeshParts::Material& m : materials) {
    (void)names.add(m.name);
    last = std::max(last, m.number);
  }
  std::set<std::int64_t> numbers;
  for (const MeshParts::Material& m : materials) numbers.insert(m.number);
  std::int64_t all = 0;
  for (const TetBins& bins : divisions) all += static_cast<std::int64_t>(bins.bins.size());
  // After those of the materials, if there is room.
  const std::int64_t most = rules.max_number > 0 ? rules.max_number : std::numeric_limits<MaterialTag>::max();
  std::int64_t number = last <= most - all ? last : 0;
  std::vector<BinDivision> result;
  const auto add = [&](const TetBins& bins) {
    BinDivision& division = result.emplace_back(BinDivision{&bins, {}});
    for (const ValueBin& bin : bins.bins) {
      do ++number;
      while (numbers.contains(number));
      division.parts.push_back({&bin, number, names.add(bin.name), {}});
    }
    for (std::size_t t = 0; t < bins.of_tets.size(); ++t)
      division.parts[bins.of_tets[t]].tets.push_back(static_cast<Index>(t));
  };
  const std::size_t leading = leading_division(divisions);
  add(divisions[leading]);
  for (std::size_t d = 0; d < divisions.size(); ++d)
    if (d != leading) add(divisions[d]);
  return result;
}

std::vector<CohesivePart> cohesive_parts(const TetMesh& mesh, const std::set<std::string>& names,
                                         const std::set<std::int64_t>& numbers, const NameRules& rules) {
  std::vector<CohesivePart> parts;
  if (mesh.wedges.empty()) return parts;
  UniqueNames unique(rules.form, rules.ignore_case);
  for (const std::string& name : names) (void)unique.add(name);
  std::int64_t number = numbers.empty() ? 0 : std::max<std::int64_t>(0, *numbers.rbegin());
  if (number > std::numeric_limits<MaterialTag>::max() - std::ssize(mesh.wedges)) number = 0;
  for (auto& [name, wedges] : wedges_by_interface(mesh)) {
    do ++number;
    while (numbers.contains(number));
    parts.push_back({number, unique.add(name), std::move(wedges)});
  }
  return parts;
}

std::vector<CohesivePart> cohesive_parts(const TetMesh& mesh,
                                         const std::vector<MeshParts::Material>& materials,
                                         const NameRules& rules) {
  std::set<std::string> names;
  std::set<std::int64_t> numbers;
  for (const MeshParts::Material& m : materials) {
    names.insert(m.name);
    numbers.insert(m.number);
  }
  return cohesive_parts(mesh, names, numbers, rules);
}

std::string comment_on_bin(const ValueBin& bin, const std::string& field) {
  std::string text = "mean ";
  append_number(text, bin.mean);
  text += " of " + printable_name(field) + ", ";
  if (std::isfinite(bin.low)) {
    text += "from ";
    append_number(text, bin.low);
    text += ' ';
  }
  if (std::isfinite(bin.high)) {
    text += "to ";
    append_number(text, bin.high);
    text += ", ";
  }
  append_number(text, bin.tets);
  return text + (bin.tets == 1 ? " tet" : " tets");
}

std::string plain_name(const std::string& name, std::size_t longest) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  std::string out;
  for (const char c : name) out += is_letter(c) || (c >= '0' && c <= '9') ? c : '_';
  if (out.empty() || !is_letter(out[0])) out = "n" + out;
  return out.substr(0, longest);
}

std::map<std::int64_t, std::int64_t> positive_numbers(const std::set<std::int64_t>& numbers,
                                                      std::int64_t max) {
  std::map<std::int64_t, std::int64_t> written;
  std::int64_t next = 1;
  for (const std::int64_t number : numbers) {
    if (number >= 1 && number <= max) {
      written[number] = number;
      continue;
    }
    while (numbers.contains(next)) ++next;
    written[number] = next++;
  }
  return written;
}

std::set<std::int64_t> tags_of(const std::vector<MaterialTag>& materials) {
  std::set<std::int64_t> tags;
  for (std::size_t t = 0; t < materials.size(); ++t)
    if (t == 0 || materials[t] != materials[t - 1]) tags.insert(materials[t]);
  return tags;
}

std::vector<TetFace> faces_of_tets(const TetMesh& mesh) {
  std::vector<std::pair<Triangle, std::size_t>> wanted;
  wanted.reserve(mesh.interfaces.size());
  std::vector<std::uint8_t> flagged(mesh.points.size(), 0);
  for (std::size_t i = 0; i < mesh.interfaces.size(); ++i) {
    Triangle ids = mesh.interfaces[i].ids;
    for (const Index v : ids) flagged[v] = 1;
    std::sort(ids.begin(), ids.end());
    wanted.emplace_back(ids, i);
  }
  std::sort(wanted.begin(), wanted.end());
  std::vector<TetFace> out(mesh.interfaces.size(), {no_index, 0});
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const Tet& tet = mesh.tets[t];
    for (int f = 0; f < 4; ++f) {
      const auto& corners = tet_faces[static_cast<std::size_t>(f)];
      if (!flagged[tet[corners[0]]] || !flagged[tet[corners[1]]] || !flagged[tet[corners[2]]]) continue;
      const Triangle ids = sorted_face(tet, f).vertices;
      const auto at = std::lower_bound(wanted.begin(), wanted.end(), std::pair(ids, std::size_t{0}));
      if (at == wanted.end() || at->first != ids) continue;
      const InterfaceTriangle& face = mesh.interfaces[at->second];
      // A sheet has its material on both sides: choose the tet behind the face.
      if (face.material == mesh.materials[t] &&
          (!face.is_sheet() ||
           equally_oriented(face.ids, {tet[corners[0]], tet[corners[1]], tet[corners[2]]})))
        out[at->second] = {static_cast<Index>(t), static_cast<std::uint8_t>(f)};
    }
  }
  for (const TetFace& face : out) TETWRIGHT_CHECK(face.tet != no_index);
  return out;
}

TriangleMesh interface_surface(const TetMesh& mesh, const NameRules& rules) {
  TriangleMesh surface;
  surface.space = mesh.space;
  std::vector<Index> new_index(mesh.points.size(), no_index);
  for (const InterfaceTriangle& t : mesh.interfaces)
    for (const Index v : t.ids) new_index[v] = 0;
  for (std::size_t p = 0; p < mesh.points.size(); ++p) {
    if (new_index[p] == no_index) continue;
    new_index[p] = static_cast<Index>(surface.points.size());
    surface.points.push_back(mesh.points[p]);
  }
  for (const MeshParts::Surface& s : mesh_parts(mesh, rules).surfaces) {
    for (const std::size_t f : s.faces) {
      const Triangle& ids = mesh.interfaces[f].ids;
      surface.triangles.push_back({new_index[ids[0]], new_index[ids[1]], new_index[ids[2]]});
      surface.triangle_groups.push_back(static_cast<std::uint32_t>(surface.groups.size()));
    }
    surface.groups.push_back({s.number, s.name});
  }
  return surface;
}

std::vector<Index> nodes_of_faces(const TetMesh& mesh, const std::vector<std::size_t>& faces,
                                  const std::vector<std::array<Index, 3>>* midside) {
  std::vector<Index> nodes;
  for (const std::size_t f : faces) {
    for (const Index v : mesh.interfaces[f].ids) nodes.push_back(v);
    if (midside)
      for (const Index m : (*midside)[f]) nodes.push_back(static_cast<Index>(mesh.points.size()) + m);
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

}  // namespace tetwright
