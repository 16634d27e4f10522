#include "mesher/field_builder.h"

#include <array>

#include "common/error.h"
#include "common/parallel_sort.h"
#include "mesher/level_set_field.h"
#include "mesher/vdb_files.h"

namespace tetwright {

std::shared_ptr<const MaterialField> build_field(const PreparedInput& input, const GridFrame& voxels,
                                                 bool keep_outside, Progress* progress) {
  std::vector<std::shared_ptr<const LevelSet>> level_sets;
  const auto add = [&](std::shared_ptr<const LevelSet> level_set) {
    level_sets.push_back(std::move(level_set));
    return static_cast<std::uint16_t>(level_sets.size() - 1);
  };
  // Outside is where no body is: the largest of their negatives.
  std::vector<LevelSetRegion> regions{{keep_outside ? outside_name : "", outside_tag, {}}};
  for (std::size_t b = 0; b < input.bodies.size(); ++b) {
    const PreparedInput::Body& body = input.bodies[b];
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

void write_fields(const MaterialField& field, const std::string& path) {
  const std::shared_ptr<const MaterialField> on_voxels = field.refined(0);
  std::vector<LevelSetSource> sources;
  for (std::size_t r = 1; r < field.regions().size(); ++r) {
    const FieldRegion& region = field.regions()[r];
    LevelSetSource source;
    source.name = region.name;
    source.leaves = field.band_leaves(static_cast<RegionIndex>(r));
    source.distances = [on_voxels, number = static_cast<RegionIndex>(r)](const LeafOrigin& leaf,
                                                                         std::span<float, leaf_points> out) {
      const std::unique_ptr<FieldSampler> sampler = on_voxels->sampler();
      for (int i = 0; i < leaf_points; ++i) {
        const int x = leaf[0] + i / (leaf_side * leaf_side), y = leaf[1] + i / leaf_side % leaf_side,
                  z = leaf[2] + i % leaf_side;
        // Its own distance need not pass 0 where it meets others: of what is thin it may be above all along.
        const NearestRegion there = sampler->nearest_at_voxel(x, y, z);
        std::array<float, 2> both;
        sampler->values_at_voxel(x, y, z, std::array{number, there.region}, both.data());
        out[static_cast<std::size_t>(i)] =
            there.region == number ? -there.margin : 0.5F * (both[0] - both[1]);
      }
    };
    sources.push_back(std::move(source));
  }
  write_level_sets(path, field.voxels(), on_voxels->band(), sources);
}

}  // namespace tetwright
