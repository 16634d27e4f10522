// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/msh.h"

#include <algorithm>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "common/io/tets/msh_data.h"
#include "common/io/tets/msh_elements.h"
#include "common/io/tets/msh_groups.h"
#include "common/number_text.h"

namespace tetwright {

namespace {

/// \param name as UniqueNames has it: shortening it again would make it equal to another
void append_name(std::string& out, int dimension, std::int64_t group, const std::string& name) {
  append_number(out, dimension);
  out += ' ';
  append_number(out, group);
  out += " \"" + name + "\"\n";
}

void begin_element(std::string& out, std::size_t number, std::int64_t type, std::int64_t physical,
                   std::int64_t geometrical) {
  append_number(out, number);
  out += ' ';
  append_number(out, type);
  out += " 2 ";
  append_number(out, physical);
  out += ' ';
  append_number(out, geometrical);
}

void append_nodes(std::string& out, std::span<const Index> nodes, std::size_t first = 0) {
  for (const Index node : nodes) {
    out += ' ';
    append_number(out, first + node + 1);
  }
}

}  // namespace

std::string write_msh(const MeshToWrite& written) {
  const TetMesh& mesh = written.mesh;
  const MidsideNodes* midside = written.midside;
  std::string out = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
  const MshGroups groups(mesh);
  // Each tet has one physical group: its bin of the leading division, if there are bins, else its material.
  std::map<MaterialTag, std::string> names = groups.material_names;
  std::vector<MaterialTag> of_tets;
  if (!written.bins.empty()) {
    names.clear();
    of_tets.resize(mesh.tets.size());
    const std::vector<BinDivision> divisions = msh_bins(mesh, written.bins);
    for (const BinPart& part : divisions.front().parts) {
      names[static_cast<MaterialTag>(part.number)] = part.name;
      for (const Index t : part.tets) of_tets[t] = static_cast<MaterialTag>(part.number);
    }
  }
  const std::vector<MaterialTag>& physical = written.bins.empty() ? mesh.materials : of_tets;
  const std::vector<CohesivePart> cohesive = msh_cohesive(mesh, physical, names);
  for (const CohesivePart& part : cohesive) names[static_cast<MaterialTag>(part.number)] = part.name;
  if (!names.empty() || !groups.face_names.empty()) {
    out += "$PhysicalNames\n";
    append_number(out, groups.face_names.size() + names.size());
    out += '\n';
    for (const auto& [number, name] : groups.face_names) append_name(out, 2, number, name);
    for (const auto& [tag, name] : names) append_name(out, 3, tag, name);
    out += "$EndPhysicalNames\n";
  }
  out += "$Nodes\n";
  append_number(out, written.nodes());
  out += '\n';
  for (std::size_t i = 0; i < written.nodes(); ++i) {
    append_number(out, i + 1);
    out += ' ';
    append_point(out, written.node(i));
    out += '\n';
  }
  // Tets come first: their numbers are then the same with and without triangles, and simple readers use only
  // the first block of elements.
  out += "$EndNodes\n$Elements\n";
  append_number(out, mesh.tets.size() + mesh.interfaces.size() + mesh.wedges.size());
  out += '\n';
  // The second tag is the number of the geometrical entity and must be positive: one for each group.
  std::vector<MaterialTag> tags = physical;
  std::sort(tags.begin(), tags.end());
  tags.erase(std::unique(tags.begin(), tags.end()), tags.end());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    begin_element(out, t + 1, midside ? element::quadratic_tet.msh : element::tet.msh, physical[t],
                  std::lower_bound(tags.begin(), tags.end(), physical[t]) - tags.begin() + 1);
    append_nodes(out, mesh.tets[t]);
    if (midside)
      for (const std::size_t m : msh_midside_order)
        append_nodes(out, std::span(&midside->of_tets[t][m], 1), mesh.points.size());
    out += '\n';
  }
  for (std::size_t i = 0; i < mesh.interfaces.size(); ++i) {
    const auto group = groups.faces.number_of(mesh.interfaces[i]);
    begin_element(out, mesh.tets.size() + i + 1,
                  midside ? element::quadratic_triangle.msh : element::triangle.msh, group, group);
    append_nodes(out, mesh.interfaces[i].ids);
    if (midside) append_nodes(out, midside->of_faces[i], mesh.points.size());
    out += '\n';
  }
  std::size_t number = mesh.tets.size() + mesh.interfaces.size();
  for (std::size_t i = 0; i < cohesive.size(); ++i)
    for (const std::size_t w : cohesive[i].wedges) {
      begin_element(out, ++number, element::wedge.msh, cohesive[i].number,
                    std::ssize(tags) + static_cast<std::ptrdiff_t>(i) + 1);
      append_nodes(out, mesh.wedges[w]);
      out += '\n';
    }
  out += "$EndElements\n";
  append_msh_data(out, "NodeData", written.node_fields(), written.nodes());
  append_msh_data(out, "ElementData", fields_of_elements(mesh), mesh.tets.size() + mesh.interfaces.size());
  return out;
}

}  // namespace tetwright
