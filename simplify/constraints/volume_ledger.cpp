// SPDX-License-Identifier: Apache-2.0
#include "simplify/constraints/volume_ledger.h"

#include "simplify/tuning/tuning.h"
#include "tetwright/resources.h"

namespace tetwright {

std::vector<double> region_volumes(const EditableMesh& mesh) {
  // Parts of fixed size, added in order, so that rounding is the same for any number of threads.
  constexpr std::size_t grain = 16 * SimplifyTuning::Grains::slots;
  const std::size_t regions = mesh.region_count();
  std::vector<std::vector<double>> parts((mesh.tet_slots() + grain - 1) / grain);
  parallel_for(0, mesh.tet_slots(), grain, [&](std::size_t begin, std::size_t end) {
    std::vector<double>& sums = parts[begin / grain];
    sums.assign(regions, 0);
    for (std::size_t i = begin; i < end; ++i)
      if (const auto t = static_cast<Index>(i); !mesh.dead(t)) sums[mesh.region(t)] += mesh.signed_volume(t);
  });
  std::vector<double> volumes(regions, 0);
  for (const std::vector<double>& part : parts)
    for (std::size_t r = 0; r < regions; ++r) volumes[r] += part[r];
  return volumes;
}

void VolumeLedger::open(const EditableMesh& mesh, double share,
                        const std::map<MaterialTag, double>* initial) {
  const std::vector<double> current = region_volumes(mesh);
  const double scale = mesh.space().scale();
  allowed_.clear();
  net_.clear();
  for (std::size_t r = 0; r < current.size(); ++r) {
    double before = current[r];
    if (initial) {
      const auto found = initial->find(mesh.tag(static_cast<RegionId>(r)));
      if (found != initial->end()) before = scale * scale * scale * found->second;
    }
    allowed_.push_back(std::fabs(share * before));
    net_.push_back(current[r] - before);
  }
}

}  // namespace tetwright
