// SPDX-License-Identifier: Apache-2.0
#include "mesher/thin/field_thickness.h"

#include <algorithm>
#include <cmath>

#include "common/parallel/parallel_sort.h"
#include "mesher/tuning/distance_tuning.h"
#include "mesher/tuning/domain_tuning.h"

namespace tetwright {

namespace {

/// A cell of 1/2^depth voxels that contains part of a sheet.
struct SheetCell {
  int depth;
  MortonKey key;  ///< in cells of its own size
  RegionIndex region;
  bool too_thin;  ///< not resolved and not split
  bool operator<(const SheetCell& o) const { return depth != o.depth ? depth < o.depth : key < o.key; }
};

void descend(SheetSampler& sampler, int depth, const std::array<int, 3>& low, std::vector<SheetCell>& out) {
  const double side = std::ldexp(1, -depth);
  const Vec3 centre = side * (Vec3(low[0], low[1], low[2]) + Vec3::Constant(0.5));
  const auto sheet = sampler.thinnest_sheet(centre, half_cube_diagonal * side);
  if (!sheet || sheet->thickness >= DistanceTuning::Sheets::min_cells * side) return;
  const bool too_thin = depth == DomainTuning::Refinement::max_levels || sheet->closed;
  out.push_back({depth, morton_encode(low), sheet->region, too_thin});
  if (too_thin) return;
  for (int k = 0; k < 8; ++k)
    descend(sampler, depth + 1, {2 * low[0] + (k & 1), 2 * low[1] + (k >> 1 & 1), 2 * low[2] + (k >> 2)},
            out);
}

void add_place(std::vector<ThinPart>& parts, RegionIndex region, const Vec3& place) {
  for (ThinPart& p : parts)
    if (p.region == region) {
      ++p.places;
      return;
    }
  parts.push_back({region, 1, place});
}

Vec3 place_of(const SheetCell& c) {
  const std::array<int, 3> low = morton_decode(c.key);
  return std::ldexp(1, -c.depth) * (Vec3(low[0], low[1], low[2]) + Vec3::Constant(0.5));
}

}  // namespace

ThinSheets find_thin_sheets(const MaterialField& field, const std::vector<MortonKey>& interface_voxels) {
  ThinSheets sheets;
  if (!field.sampler()->sheets()) return sheets;
  std::vector<SheetCell> found =
      parallel_collect<SheetCell>(0, interface_voxels.size(), DistanceGrains::sampled_voxels,
                                  [&](std::size_t begin, std::size_t end, std::vector<SheetCell>& out) {
                                    const std::unique_ptr<FieldSampler> sampler = field.sampler();
                                    for (std::size_t i = begin; i < end; ++i)
                                      descend(*sampler->sheets(), 0, morton_decode(interface_voxels[i]), out);
                                  });
  parallel_sort(found);
  for (const SheetCell& c : found)
    if (!c.too_thin)
      sheets.finer.refinement = std::max(sheets.finer.refinement, c.depth + 1);
    else
      add_place(sheets.too_thin, c.region, place_of(c));
  sheets.finer.cells.resize(static_cast<std::size_t>(sheets.finer.refinement) + 1);
  for (const SheetCell& c : found)
    if (!c.too_thin)
      sheets.finer.cells[static_cast<std::size_t>(sheets.finer.refinement - c.depth)].push_back(c.key);
  return sheets;
}

std::vector<ThinPart> find_thin_parts(const MaterialField& field,
                                      const std::vector<MortonKey>& interface_voxels) {
  struct Found {
    MortonKey voxel;
    RegionIndex region;
  };
  const std::vector<Found> found = parallel_collect<Found>(
      0, interface_voxels.size(), DistanceGrains::sampled_voxels,
      [&](std::size_t begin, std::size_t end, std::vector<Found>& out) {
        const std::unique_ptr<FieldSampler> owned = field.sampler();
        FieldSampler& sampler = *owned;
        for (std::size_t i = begin; i < end; ++i) {
          const auto [x, y, z] = morton_decode(interface_voxels[i]);
          const Vec3 centre = Vec3(x, y, z) + Vec3::Constant(0.5);
          const std::optional<RegionSet> two = sampler.two_nearest(centre);
          Vec3 place = centre, normal;
          if (!two || !sampler.project(*two, place)) continue;
          if ((place - centre).cwiseAbs().maxCoeff() > 0.5) continue;  // in another voxel
          sampler.between((*two)[0], (*two)[1], place, normal);
          if (!(normal.norm() > 0)) continue;
          normal.normalize();
          for (double side : {-1.0, 1.0}) {
            const RegionIndex near =
                sampler.nearest(place + side * DistanceTuning::ThinParts::identified_at * normal).region;
            const Vec3 across = place + side * DistanceTuning::ThinParts::thick_at * normal;
            const RegionIndex far = sampler.nearest(across).region;
            if (far == near) continue;
            Vec3 slope;  // grows out of the region
            sampler.between(near, far, across, slope);
            if (!(side * slope.dot(normal) > -DistanceTuning::ThinParts::max_cosine * slope.norm())) continue;
            const auto sheet = sampler.sheets() ? sampler.sheets()->thinnest_sheet(
                                                      place, DistanceTuning::ThinParts::identified_at)
                                                : std::nullopt;
            if (!sheet || sheet->region != near) out.push_back({interface_voxels[i], near});
          }
        }
      });
  std::vector<ThinPart> parts;
  for (const Found& f : found) {
    const auto [x, y, z] = morton_decode(f.voxel);
    add_place(parts, f.region, Vec3(x, y, z) + Vec3::Constant(0.5));
  }
  std::sort(parts.begin(), parts.end(),
            [](const ThinPart& a, const ThinPart& b) { return a.region < b.region; });
  return parts;
}

}  // namespace tetwright
