#include "mesher/distance/body_field.h"

#include "common/error.h"
#include "mesher/distance/level_set_field.h"

namespace tetwright {

std::shared_ptr<const MaterialField> build_field(const MesherInput& input, const GridFrame& voxels,
                                                 bool keep_outside, Progress* progress) {
  std::vector<std::shared_ptr<const LevelSet>> level_sets;
  const auto add = [&](std::shared_ptr<const LevelSet> level_set) {
    level_sets.push_back(std::move(level_set));
    return static_cast<std::uint16_t>(level_sets.size() - 1);
  };
  // Outside is where no body is: the largest of their negatives.
  std::vector<LevelSetRegion> regions{{keep_outside ? outside_name : "", outside_tag, {}}};
  for (std::size_t b = 0; b < input.bodies.size(); ++b) {
    const MesherInput::Body& body = input.bodies[b];
    const auto number = static_cast<std::uint16_t>(b);
    const std::uint16_t surface = add(LevelSet::of_surface(body.surface, voxels, progress));
    regions[outside_region].terms.push_back({surface, true, number});
    // Carves all earlier ones.
    for (std::size_t r = 1; r < regions.size(); ++r) regions[r].terms.push_back({surface, true, number});
    std::uint16_t outer = surface;
    double depth = 0;
    if (b == 0)
      for (const MaterialLayer& layer : input.layers) {
        depth += layer.thickness;
        auto inner_side = LevelSet::at_depth(body.surface, *level_sets[surface], depth / voxels.cell_size,
                                             voxels, progress);
        if (inner_side->interface_cells().empty())
          throw InputError(body.file, 0,
                           "the layers down to '" + layer.name +
                               "' are thicker than the body itself, which has no " +
                               "point so deep inside; make them thinner");
        const std::uint16_t inner = add(std::move(inner_side));
        regions.push_back({layer.name, layer.tag, {{outer, false, number}, {inner, true, number}}});
        outer = inner;
      }
    regions.push_back({body.name, body.tag, {{outer, false, number}}});
  }
  return std::make_shared<const LevelSetField>(voxels, std::move(level_sets), std::move(regions));
}

}  // namespace tetwright
