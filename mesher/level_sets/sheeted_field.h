// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "mesher/complex/sheet_zone.h"
#include "mesher/domain/material_field.h"

namespace tetwright {

/// The sides of sheets on which a point is: those of the sheets within SheetZone::reach() that it sees.
class SheetSides {
 public:
  /// At most this many; of more, those of the first components count.
  static constexpr std::size_t capacity = 12;
  /// A component and one of its sides.
  struct Side {
    std::uint32_t component = 0;
    bool in_front = false;
    auto operator<=>(const Side&) const = default;
  };

  void add(std::uint32_t component, bool in_front) {
    if (size_ < capacity) items_[size_++] = {component, in_front};
  }
  bool empty() const { return size_ == 0; }
  std::size_t size() const { return size_; }
  const Side* begin() const { return items_.data(); }
  const Side* end() const { return items_.data() + size_; }
  /// The side of a component, or null.
  const Side* of(std::uint32_t component) const {
    for (const Side& s : *this)
      if (s.component == component) return &s;
    return nullptr;
  }
  auto operator<=>(const SheetSides&) const = default;

 private:
  std::array<Side, capacity> items_{};  ///< ascending by component
  std::size_t size_ = 0;
};

/// A field whose regions are divided by sheets: a *part* of a region is what lies on the same sides of the
/// sheets around it. Cutting between parts makes faces on sheets, on their continuations beyond their borders
/// and at the rim of the zone. Regions of the field without sheets come first and keep their numbers.
class SheetedField final : public MaterialField {
 public:
  struct Part {
    RegionIndex region;  ///< of the field without sheets
    SheetSides sides;
    auto operator<=>(const Part&) const = default;
  };

  /// The parts of `base` that occur at points.
  /// \pre base.sheets()
  /// \param points lattice units
  /// \param regions those of `base` at the points; receives the parts. Margins are unchanged.
  /// \throws InputError if there are more parts than numbers
  static std::shared_ptr<const SheetedField> of_points(std::shared_ptr<const MaterialField> base,
                                                       std::span<const Vec3> points,
                                                       std::vector<NearestRegion>& regions);
  ~SheetedField() override;

  std::unique_ptr<FieldSampler> sampler() const override;
  std::shared_ptr<const MaterialField> refined(int refinement) const override;
  std::vector<MortonKey> interface_voxels() const override { return base_->interface_voxels(); }
  std::vector<LeafOrigin> band_leaves(RegionIndex region) const override {
    return base_->band_leaves(region);
  }
  const WallChanges* wall_changes() const override { return base_->wall_changes(); }

  const MaterialField& base() const { return *base_; }
  const Part& part(RegionIndex region) const { return parts_[region]; }
  /// The sheet between two parts of one region: the component of which they are on opposite sides; no_index
  /// if there is none.
  std::uint32_t component_between(RegionIndex a, RegionIndex b) const;

 private:
  class Sampler;

  SheetedField(std::shared_ptr<const MaterialField> base, std::vector<Part> parts);
  /// The number of a part, or that of the last region, which stands for all that occur nowhere.
  RegionIndex number_of(const Part& part) const;

  std::shared_ptr<const MaterialField> base_;
  std::vector<Part> parts_;  ///< by region: first those of the base without sides, then others ascending
};

}  // namespace tetwright
