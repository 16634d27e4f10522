// SPDX-License-Identifier: Apache-2.0
#include "mesher/level_sets/sheeted_field.h"

#include <algorithm>
#include <cmath>

#include "common/parallel/parallel_sort.h"
#include "mesher/tuning/distance_tuning.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

/// The sides that a point of a region has.
SheetSides sides_of(const SheetZone& zone, const std::vector<SheetZone::Near>& near, RegionIndex region) {
  SheetSides sides;
  for (const SheetZone::Near& n : near)
    if (n.visible && n.distance < SheetZone::reach() && zone.is_in(n.component, region))
      sides.add(n.component, n.in_front());
  return sides;
}

/// A distance with its gradient.
struct Slope {
  double value = 0;
  Vec3 gradient = Vec3::Zero();
  void raise_to(double v, const Vec3& g) {
    if (v > value) value = v, gradient = g;
  }
};

/// Distance, voxels, of a point from the part of space with the given sides; 0 if these are its own.
/// \param here the point's own sides
Slope distance_to(const SheetSides& there, const SheetSides& here, const std::vector<SheetZone::Near>& near) {
  Slope across, hidden, beyond;
  const auto find = [&](std::uint32_t component) {
    const auto at =
        std::lower_bound(near.begin(), near.end(), component,
                         [](const SheetZone::Near& n, std::uint32_t c) { return n.component < c; });
    return at != near.end() && at->component == component ? &*at : nullptr;
  };
  for (const SheetSides::Side& side : there) {
    const SheetZone::Near* n = find(side.component);
    if (const SheetSides::Side* own = here.of(side.component)) {
      if (own->in_front != side.in_front)
        across.raise_to(std::abs(n->ahead), n->in_front() ? n->ahead_gradient : Vec3(-n->ahead_gradient));
    } else if (!n) {
      beyond.raise_to(SheetZone::reach(), Vec3::Zero());
    } else if (n->distance < SheetZone::reach()) {
      hidden.raise_to(n->distance, n->away);
    } else {
      beyond.raise_to(n->distance - SheetZone::reach(), n->away);
    }
  }
  // A sheet that is crossed hides others behind it; these do not make the way longer.
  if (across.value > 0) return across;
  if (hidden.value > 0) return hidden;
  for (const SheetSides::Side& side : here)
    if (!there.of(side.component))
      if (const SheetZone::Near* n = find(side.component))
        beyond.raise_to(SheetZone::reach() - n->distance, -n->away);
  return beyond;
}

std::vector<FieldRegion> regions_of(const MaterialField& base, const std::vector<SheetedField::Part>& parts) {
  std::vector<FieldRegion> regions;
  regions.reserve(parts.size());
  for (const SheetedField::Part& part : parts) regions.push_back(base.regions()[part.region]);
  return regions;
}

}  // namespace

class SheetedField::Sampler final : public FieldSampler {
 public:
  explicit Sampler(const SheetedField& f)
      : FieldSampler(std::ldexp(1, f.refinement())),
        field(f),
        zone(*f.base().sheets()),
        per_voxel(std::ldexp(1, f.refinement())),
        base(f.base().sampler()) {}

  NearestRegion nearest(const Vec3& point) override {
    read(point);
    if (here.empty()) return at_base;
    float margin = at_base.margin;
    for (const SheetZone::Near& n : near)
      if (here.of(n.component))
        margin = std::min(margin, static_cast<float>(per_voxel * std::min(std::abs(n.ahead),
                                                                          SheetZone::reach() - n.distance)));
    return {field.number_of({at_base.region, here}), margin};
  }
  NearestRegion nearest_at_voxel(int x, int y, int z) override { return nearest(per_voxel * Vec3(x, y, z)); }
  void values(const Vec3& point, std::span<const RegionIndex> regions, float* out) override {
    read(point);
    for (const RegionIndex r : regions) *out++ = static_cast<float>(value(r).value);
  }
  void values_at_voxel(int x, int y, int z, std::span<const RegionIndex> regions, float* out) override {
    values(per_voxel * Vec3(x, y, z), regions, out);
  }
  std::optional<RegionSet> two_nearest(const Vec3& point) override { return base->two_nearest(point); }

 private:
  void values_and_gradients(const Vec3& point, std::span<const RegionIndex> regions, double* out,
                            Vec3* slopes) override {
    read(point);
    for (const RegionIndex r : regions) {
      const Slope s = value(r);
      *out++ = s.value;
      *slopes++ = s.gradient;
    }
  }

  void read(const Vec3& point) {
    place = point;
    at_base = base->nearest(point);
    zone.find(point / per_voxel, near);
    here = sides_of(zone, near, at_base.region);
  }

  /// Twice the distance of the last point read from a part of a region: 0 in that part. Its differences are
  /// those of signed distances where two parts meet, and exact in all others.
  Slope value(RegionIndex r) {
    const Part& part = field.part(r);
    Slope result;
    if (r + 1u == field.regions().size()) {  // the point must not be in a part that occurs nowhere
      result.value = -field.band();
      return result;
    }
    if (part.region != at_base.region) {
      Vec3 gradient;
      const double half = base->between(part.region, at_base.region, place, gradient);
      result.raise_to(2 * half, 2 * gradient);
    }
    // The sides that the point has if it is in the region.
    const SheetSides& own =
        part.region == at_base.region ? here : (there = sides_of(zone, near, part.region));
    const Slope sides = distance_to(part.sides, own, near);
    result.raise_to(2 * per_voxel * sides.value, 2 * sides.gradient);
    return result;
  }

  const SheetedField& field;
  const SheetZone& zone;
  double per_voxel;  ///< lattice units
  std::unique_ptr<FieldSampler> base;
  Vec3 place;  ///< last point read, lattice units; with the following
  NearestRegion at_base{};
  std::vector<SheetZone::Near> near;
  SheetSides here, there;
};

SheetedField::SheetedField(std::shared_ptr<const MaterialField> base, std::vector<Part> parts)
    : MaterialField(base->voxels(), regions_of(*base, parts), std::ldexp(base->band(), -base->refinement()),
                    base->refinement()),
      base_(std::move(base)),
      parts_(std::move(parts)) {}

SheetedField::~SheetedField() { drop_samplers(); }

std::shared_ptr<const SheetedField> SheetedField::of_points(std::shared_ptr<const MaterialField> base,
                                                            std::span<const Vec3> points,
                                                            std::vector<NearestRegion>& regions) {
  const SheetZone& zone = *base->sheets();
  const double voxels = std::ldexp(1, -base->refinement());
  struct Labelled {
    Part part;
    Index point;
  };
  const std::vector<Labelled> labelled =
      parallel_collect<Labelled>(0, points.size(), DistanceGrains::sheet_points,
                                 [&](std::size_t begin, std::size_t end, std::vector<Labelled>& out) {
                                   std::vector<SheetZone::Near> near;
                                   for (std::size_t i = begin; i < end; ++i) {
                                     if (regions[i].region == outside_region) continue;
                                     zone.find(voxels * points[i], near);
                                     const SheetSides sides = sides_of(zone, near, regions[i].region);
                                     if (!sides.empty())
                                       out.push_back({{regions[i].region, sides}, static_cast<Index>(i)});
                                   }
                                 });
  std::vector<Part> parts;
  parts.reserve(labelled.size());
  for (const Labelled& l : labelled) parts.push_back(l.part);
  std::sort(parts.begin(), parts.end());
  parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
  std::vector<Part> all;
  for (std::size_t r = 0; r < base->regions().size(); ++r) all.push_back({static_cast<RegionIndex>(r), {}});
  all.insert(all.end(), parts.begin(), parts.end());
  all.push_back({outside_region, {}});  // see number_of()
  if (all.size() >= on_interface)
    throw UsageError("the sheets divide the bodies into more than " + std::to_string(on_interface) +
                     " parts; use fewer sheets");
  std::shared_ptr<const SheetedField> field(new SheetedField(std::move(base), std::move(all)));
  for (const Labelled& l : labelled) regions[l.point].region = field->number_of(l.part);
  return field;
}

RegionIndex SheetedField::number_of(const Part& part) const {
  if (part.sides.empty()) return part.region;
  const auto first = parts_.begin() + static_cast<std::ptrdiff_t>(base_->regions().size());
  const auto known = std::lower_bound(first, parts_.end() - 1, part);
  if (known == parts_.end() - 1 || *known != part) return static_cast<RegionIndex>(parts_.size() - 1);
  return static_cast<RegionIndex>(known - parts_.begin());
}

std::unique_ptr<FieldSampler> SheetedField::sampler() const { return std::make_unique<Sampler>(*this); }

std::shared_ptr<const MaterialField> SheetedField::refined(int refinement) const {
  return std::shared_ptr<const SheetedField>(new SheetedField(base_->refined(refinement), parts_));
}

std::uint32_t SheetedField::component_between(RegionIndex a, RegionIndex b) const {
  if (parts_[a].region != parts_[b].region) return no_index;
  for (const SheetSides::Side& side : parts_[a].sides)
    if (const SheetSides::Side* other = parts_[b].sides.of(side.component);
        other && other->in_front != side.in_front)
      return side.component;
  return no_index;
}

}  // namespace tetwright
