// SPDX-License-Identifier: Apache-2.0
#include "simplify/mesh/input_check.h"

#include <algorithm>
#include <cstddef>

#include "simplify/tuning/tuning.h"
#include "tetwright/error.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

void check_fields(const std::vector<MeshField>& fields, std::size_t items, const char* of,
                  const std::string& name) {
  for (const MeshField& f : fields)
    if (f.components < 1 || f.values.size() != static_cast<std::size_t>(f.components) * items)
      throw InputError(name, 0,
                       "the field '" + f.name + "' has " + std::to_string(f.values.size()) + " values, not " +
                           std::to_string(f.components) + " for each of " + std::to_string(items) + " " + of);
}

/// First tet with an index that is no point; no_index if there is none.
Index first_out_of_range(const TetMesh& mesh) {
  constexpr std::size_t grain = SimplifyTuning::Grains::slots;
  const std::size_t parts = (mesh.tets.size() + grain - 1) / grain;
  std::vector<Index> first(parts, no_index);
  parallel_chunks(parts, [&](std::size_t part, unsigned) {
    const std::size_t end = std::min(mesh.tets.size(), (part + 1) * grain);
    for (std::size_t t = part * grain; t < end && first[part] == no_index; ++t)
      if (*std::max_element(mesh.tets[t].begin(), mesh.tets[t].end()) >= mesh.points.size())
        first[part] = static_cast<Index>(t);
  });
  const auto found = std::find_if(first.begin(), first.end(), [](Index t) { return t != no_index; });
  return found == first.end() ? no_index : *found;
}

}  // namespace

void check_arrays(const TetMesh& mesh, const std::vector<std::uint8_t>& frozen, const std::string& name) {
  if (mesh.materials.size() != mesh.tets.size())
    throw InputError(name, 0,
                     std::to_string(mesh.tets.size()) + " tets, but " +
                         std::to_string(mesh.materials.size()) + " materials; give one for each tet");
  if (const Index t = first_out_of_range(mesh); t != no_index)
    throw InputError(name, 0,
                     "tet " + std::to_string(t) + " refers to point " +
                         std::to_string(*std::max_element(mesh.tets[t].begin(), mesh.tets[t].end())) +
                         ", but there are " + std::to_string(mesh.points.size()) + " points, counted from 0");
  for (const InterfaceTriangle& f : mesh.interfaces)
    if (*std::max_element(f.ids.begin(), f.ids.end()) >= mesh.points.size())
      throw InputError(name, 0, "an interface triangle refers to a point that does not exist");
  check_fields(mesh.point_fields, mesh.points.size(), "points", name);
  check_fields(mesh.cell_fields, mesh.tets.size(), "tets", name);
  if (!frozen.empty() && frozen.size() != mesh.points.size())
    throw UsageError("there are " + std::to_string(frozen.size()) + " values of frozen points for " +
                     std::to_string(mesh.points.size()) + " points; give one for each, or none");
}

void check_mesh(const TetMesh& mesh, const std::vector<std::uint8_t>& frozen, const std::string& name) {
  using Memory = SimplifyTuning::Memory;
  if (mesh.tets.empty()) throw InputError(name, 0, "no tets in it");
  check_arrays(mesh, frozen, name);
  require_memory(Memory::program_bytes + Memory::bytes_per_tet * static_cast<double>(mesh.tets.size()),
                 name + ": work on its " + std::to_string(mesh.tets.size()) + " tets",
                 "free some, or use a machine or a container limit with more");
}

}  // namespace tetwright
