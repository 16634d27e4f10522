// SPDX-License-Identifier: Apache-2.0
#include "simplify/constraints/constrained_mesh.h"

#include <utility>

#include "simplify/tuning/tuning.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

using Volumes = SimplifyTuning::Volumes;

}  // namespace

ConstrainedMesh::ConstrainedMesh(TetMesh&& input, const std::string& name,
                                 const std::vector<std::uint8_t>& frozen, bool fix_boundary,
                                 bool keep_volumes, const std::map<MaterialTag, double>* volumes)
    : mesh(std::move(input), name) {
  if (!(mesh.total_volume() > 0))
    throw InputError(
        name, 0,
        "the volumes of its tets add up to nothing or less; turn the tets so that they are positive");
  if (!frozen.empty()) mesh.freeze(frozen);
  if (fix_boundary) mesh.freeze_interfaces();
  if (keep_volumes) ledger.open(mesh, Volumes::max_change, volumes);
}

void ConstrainedMesh::keep_patches() {
  if (mesh.interface_patches()) mesh.set_interface_patches(grid.patches());
}

}  // namespace tetwright
