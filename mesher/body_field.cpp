// SPDX-License-Identifier: Apache-2.0
#include "mesher/body_field.h"

#include <algorithm>
#include <iterator>

#include "mesher/level_sets/level_set_field.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

/// Cells of one voxel at these voxels.
RefinementRegions finest_cells(std::vector<MortonKey> voxels) {
  for (MortonKey& key : voxels) key >>= 3;
  voxels.erase(std::unique(voxels.begin(), voxels.end()), voxels.end());
  RefinementRegions finest;
  finest.cells = {{}, std::move(voxels)};
  return finest;
}

}  // namespace

BodyField build_field(const MesherInput& input, const GridFrame& voxels, bool keep_outside,
                      const ThinWalls::Limits& limits, const RefinementBudget& budget,
                      std::vector<BodyCells> cells, Progress* progress) {
  BodyField result;
  std::vector<std::shared_ptr<const LevelSet>> surfaces;
  std::vector<LocalThickness> all_measured(input.bodies.size());
  cells.resize(input.bodies.size());
  std::vector<LocalThickness*> all;
  for (std::size_t b = 0; b < input.bodies.size(); ++b) {
    const RepairedSurface& surface = input.bodies[b].surface;
    NarrowPatches &narrow = cells[b].narrow, &asked = cells[b].asked;
    std::vector<MortonKey> exact;
    std::set_union(narrow.voxels.begin(), narrow.voxels.end(), asked.voxels.begin(), asked.voxels.end(),
                   std::back_inserter(exact));
    surfaces.push_back(LevelSet::of_surface(surface, voxels, progress));
    result.caps.push_back(surfaces[b]->caps());
    for (Vec3& p : result.caps[b].points) p = voxels.to_input(p);
    all_measured[b] =
        measure_local_thickness(surface, *surfaces[b], voxels,
                                {limits.min_gap / voxels.cell_size, limits.min_thickness / voxels.cell_size},
                                std::move(exact), progress);
    // Smaller cells at narrow patches would tear thin walls next to them.
    if (!all_measured[b].voxels.empty()) {
      narrow = {};
      all_measured[b].exact = std::move(asked.voxels);
      follow_cells(all_measured[b], asked.finer);
    }
    result.finer = combine(std::move(result.finer), std::move(narrow.finer));
    result.finer = combine(std::move(result.finer), std::move(asked.finer));
    all.push_back(&all_measured[b]);
    if (progress) progress->throw_if_stopped();
  }
  choose_depths(all, budget);
  std::vector<std::shared_ptr<const LevelSet>> level_sets;
  const auto add = [&](std::shared_ptr<const LevelSet> level_set) {
    level_sets.push_back(std::move(level_set));
    return static_cast<std::uint16_t>(level_sets.size() - 1);
  };
  // Outside is where no body is: the maximum of their negatives.
  std::vector<LevelSetRegion> regions{{keep_outside ? outside_name : "", outside_tag, {}}};
  for (std::size_t b = 0; b < input.bodies.size(); ++b) {
    const MesherInput::Body& body = input.bodies[b];
    const auto number = static_cast<std::uint16_t>(b);
    ThinWallPlan plan = plan_thin_walls(all_measured[b]);
    all_measured[b] = {};
    if (progress) progress->throw_if_stopped();
    const std::uint16_t surface =
        add(plan.walls ? LevelSet::with_walls(*surfaces[b], std::move(plan.walls)) : surfaces[b]);
    result.finer = combine(std::move(result.finer), std::move(plan.finer));
    result.filling_tets += plan.filling_tets;
    result.filling_tets_thickened += plan.filling_tets_thickened;
    for (const ChangedWall& w : plan.changed) result.changed.emplace_back(b, w);
    regions[outside_region].terms.push_back({surface, true, number});
    // The body carves all earlier ones.
    for (std::size_t r = 1; r < regions.size(); ++r) regions[r].terms.push_back({surface, true, number});
    std::uint16_t outer = surface;
    double depth = 0;
    if (b == 0)
      for (const MaterialLayer& layer : input.layers) {
        depth += layer.thickness;
        auto inner_side =
            LevelSet::at_depth(body.surface, *surfaces[b], depth / voxels.cell_size, voxels, progress);
        if (inner_side->interface_cells().empty())
          throw InputError(body.file, 0,
                           "the layers down to '" + layer.name +
                               "' are thicker than the body itself, which has no " +
                               "point so deep inside; make them thinner");
        const std::uint16_t inner = add(std::move(inner_side));
        regions.push_back({layer.name,
                           layer.tag,
                           {{outer, false, number, outer != surface}, {inner, true, number, true}},
                           static_cast<RegionIndex>(b + 1)});
        outer = inner;
      }
    regions.push_back(
        {body.name, body.tag, {{outer, false, number, outer != surface}}, static_cast<RegionIndex>(b + 1)});
  }
  std::shared_ptr<const ContactZone> zone;
  if (input.complex) zone = std::make_shared<const ContactZone>(*input.complex, voxels);
  std::shared_ptr<const SheetZone> sheets;
  if (input.complex && !input.complex->sheets.empty()) {
    sheets = std::make_shared<const SheetZone>(*input.complex, voxels);
    result.finer = combine(std::move(result.finer), finest_cells(sheets->voxels()));
  }
  result.field = std::make_shared<const LevelSetField>(voxels, std::move(level_sets), std::move(regions),
                                                       std::move(zone), std::move(sheets));
  return result;
}

}  // namespace tetwright
