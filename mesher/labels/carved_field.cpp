// SPDX-License-Identifier: Apache-2.0
#include "mesher/labels/carved_field.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/parallel/parallel_sort.h"
#include "mesher/tuning/cell_tuning.h"
#include "mesher/tuning/label_tuning.h"

namespace tetwright {

namespace {

/// Regions of the volume, then the bodies.
std::vector<FieldRegion> all_regions(const MaterialField& labels, const MaterialField& bodies) {
  std::vector<FieldRegion> all = labels.regions();
  all.insert(all.end(), bodies.regions().begin() + 1, bodies.regions().end());
  return all;
}

}  // namespace

/// Data that the fields of all refinements share.
struct CarvedField::Rules {
  std::vector<RegionIndex> of_protected, of_others;  ///< regions of the volume
  std::vector<std::uint8_t> is_protected;            ///< by region of the volume; empty: none is
  std::vector<LeafOrigin> near_bodies;               ///< leaves with distances of bodies, ascending
  double layer = 0;                                  ///< voxels of the frame
  unsigned crossed = 0;                              ///< sides of the volume that bodies cross
};

class CarvedField::Sampler final : public FieldSampler {
 public:
  Sampler(const CarvedField& field, std::unique_ptr<FieldSampler> labels,
          std::unique_ptr<FieldSampler> bodies)
      : FieldSampler(labels->per_voxel(), labels->min_slope()),
        rules_(*field.rules_),
        labels_(std::move(labels)),
        bodies_(std::move(bodies)),
        first_body_(static_cast<RegionIndex>(field.labels_->regions().size() - 1)),
        band_(static_cast<float>(field.band())),
        volume_(field.frame().volume()),
        per_voxel_(std::ldexp(1, field.refinement())),
        layer_(rules_.layer * per_voxel_),
        far_inside_(LabelTuning::Carving::far_share * field.bodies_->band()),
        distances_(field.labels_->regions().size()),
        sheets_(*this) {}

  NearestRegion nearest(const Vec3& point) override {
    const NearestRegion body = bodies_->nearest(point);
    return nearest_of(body, labels_->nearest(label_place(point, body)), point);
  }
  NearestRegion nearest_at_voxel(int x, int y, int z) override { return nearest(per_voxel_ * Vec3(x, y, z)); }
  void values(const Vec3& point, std::span<const RegionIndex> regions, float* out) override {
    const NearestRegion body = bodies_->nearest(point);
    const Vec3 place = label_place(point, body);
    const NearestRegion label = labels_->nearest(place), nearest = nearest_of(body, label, point);
    const float protection = rules_.of_protected.empty() ? HUGE_VALF : from_protected(point);
    const RegionIndex outside = outside_region;
    float depth;
    bodies_->values(point, {&outside, 1}, &depth);
    depth = std::min(depth, protection);
    const auto value_of = [&](RegionIndex r) {
      float distances[2];
      if (r > first_body_) {
        const auto own = static_cast<RegionIndex>(r - first_body_);
        bodies_->values(point, {&own, 1}, distances);
        return std::max(distances[0], -protection);
      }
      // Inside a body only protected labels are across an interface.
      const float base = is_protected_at(point, r) ? -std::fabs(depth) : depth;
      if (r == label.region) return base;
      // The layer is for labels that bodies carve.
      const bool here = is_protected(r) && place != point;
      const RegionIndex both[2] = {r, here ? labels_->nearest(point).region : label.region};
      labels_->values(here ? point : place, both, distances);
      return base + (distances[0] - distances[1]);
    };
    const float middle = value_of(nearest.region) + nearest.margin;
    for (const RegionIndex r : regions) *out++ = value_of(r) - middle;
  }
  void values_at_voxel(int x, int y, int z, std::span<const RegionIndex> regions, float* out) override {
    values(per_voxel_ * Vec3(x, y, z), regions, out);
  }
  std::optional<RegionSet> two_nearest(const Vec3& point) override {
    const NearestRegion body = bodies_->nearest(point);
    const Vec3 place = label_place(point, body);
    const NearestRegion label = labels_->nearest(place);
    if (is_protected_at(point, label.region)) return two_nearest_protected(point, label);
    std::optional<RegionSet> of_bodies = bodies_->two_nearest(point);
    if (of_bodies && of_bodies->contains(outside_region))
      of_bodies = replaced(*of_bodies, label.region);
    else if (of_bodies)
      of_bodies = replaced(*of_bodies, {});
    if (body.region != outside_region) {
      if (rules_.of_protected.empty()) return of_bodies;
      // Inside a body, whose nearest interface may be that with a protected label.
      const float distance = from_protected(point);
      if (distance >= std::min(body.margin, band_)) return of_bodies;
      return pair(static_cast<RegionIndex>(first_body_ + body.region), nearest_protected_);
    }
    const std::optional<RegionSet> of_labels = labels_->two_nearest(place);
    if (!of_labels || (of_bodies && body.margin < label.margin)) return of_bodies;
    return of_labels;
  }
  SheetSampler* sheets() override { return bodies_->sheets() ? &sheets_ : nullptr; }

 private:
  /// The sheets between bodies.
  class Sheets final : public SheetSampler {
   public:
    explicit Sheets(Sampler& of) : of_(of) {}
    std::optional<FieldSheet> thinnest_sheet(const Vec3& point, double reach) override {
      std::optional<FieldSheet> sheet = of_.bodies_->sheets()->thinnest_sheet(point, reach);
      if (!sheet) return sheet;
      sheet->region = sheet->region == outside_region
                          ? of_.labels_->nearest(of_.label_place(point, of_.bodies_->nearest(point))).region
                          : static_cast<RegionIndex>(of_.first_body_ + sheet->region);
      return sheet;
    }

   private:
    Sampler& of_;
  };

  /// The point whose label counts: in a layer around bodies, and inside them, that on the outer side of the
  /// layer, along the normal. Beside protected labels there is no layer.
  /// \param body the nearest region of the bodies at `point`
  Vec3 label_place(const Vec3& point, const NearestRegion& body) {
    along_ = Vec3::Zero();
    const bool inside = body.region != outside_region;
    if (body.margin >= (inside ? far_inside_ : layer_)) return point;
    const bool any_protected = !rules_.of_protected.empty();
    double layer = layer_;
    if (any_protected) {
      using Carving = LabelTuning::Carving;
      const double share = (from_protected(point) / layer_ - Carving::without_layer) /
                           (Carving::with_layer - Carving::without_layer);
      if (!(share > 0)) return point;
      layer *= std::min(share, 1.0);
    }
    const RegionIndex outside = outside_region;
    double value;
    Vec3 slope;
    bodies_->values_and_gradients(point, {&outside, 1}, &value, &slope);
    const double length = slope.norm();
    if (!(length > 0) || layer + value <= 0) return point;
    const Vec3 along = slope / length;
    Vec3 place = point - (layer + value) * along;
    if (any_protected && is_protected(labels_->nearest(place).region)) return point;
    along_ = along;
    return place;
  }

  bool is_protected(RegionIndex label) const {
    return !rules_.is_protected.empty() && rules_.is_protected[label] != 0;
  }
  /// Beyond the border protected labels do not hold bodies back.
  bool is_protected_at(const Vec3& point, RegionIndex label) const {
    return is_protected(label) && beyond(point) <= 0;
  }
  static RegionSet pair(RegionIndex a, RegionIndex b) {
    RegionSet both;
    both.insert(std::min(a, b));
    both.insert(std::max(a, b));
    return both;
  }
  /// Regions of the bodies' field as those of this one.
  RegionSet replaced(const RegionSet& of_bodies, RegionIndex label) const {
    RegionIndex both[2] = {label, label};
    std::size_t count = 0;
    for (const RegionIndex r : of_bodies)
      both[count++] = r == outside_region ? label : static_cast<RegionIndex>(first_body_ + r);
    return pair(both[0], both[1]);
  }
  NearestRegion nearest_of(const NearestRegion& body, const NearestRegion& label, const Vec3& point) {
    if (is_protected_at(point, label.region)) {
      if (body.region == outside_region) return {label.region, std::min(label.margin, band_)};
      return {label.region, std::min({label.margin, static_cast<float>(-beyond(point)), band_})};
    }
    if (body.region == outside_region) return {label.region, std::min({label.margin, body.margin, band_})};
    float margin = std::min(body.margin, band_);
    if (!rules_.of_protected.empty()) margin = std::min(margin, from_protected(point));
    return {static_cast<RegionIndex>(first_body_ + body.region), margin};
  }
  /// How far a point is beyond the border on the sides that bodies cross, lattice units; negative inside.
  /// \param slope receives the derivative, may be null
  double beyond(const Vec3& point, Vec3* slope = nullptr) const {
    double farthest = -HUGE_VAL;
    for (int a = 0; a < 3; ++a)
      for (const bool upper : {false, true}) {
        if (!(rules_.crossed >> (2 * a + upper) & 1)) continue;
        const double off = upper ? point[a] - volume_.high[a] : volume_.low[a] - point[a];
        if (off <= farthest) continue;
        farthest = off;
        if (slope) *slope = upper ? Vec3::Unit(a) : Vec3(-Vec3::Unit(a));
      }
    return farthest;
  }
  /// In a protected label, whose neighbour inside a body is the body.
  std::optional<RegionSet> two_nearest_protected(const Vec3& point, const NearestRegion& label) {
    std::optional<RegionSet> both = labels_->two_nearest(point);
    const NearestRegion body = bodies_->nearest(point);
    if (body.region != outside_region && -beyond(point) < std::min(label.margin, band_))
      return pair(label.region, static_cast<RegionIndex>(first_body_ + body.region));
    if (!both) return both;
    RegionIndex across = label.region;
    for (const RegionIndex r : *both)
      if (r != label.region) across = r;
    if (is_protected(across)) return both;
    if (body.region == outside_region) return both;
    return pair(label.region, static_cast<RegionIndex>(first_body_ + body.region));
  }
  /// The signed distance from the protected labels together: half the difference between the smallest
  /// distance of one of them and that of another label. Reads the distances of all labels.
  float from_protected(const Vec3& point) {
    const auto smallest_of = [&](const std::vector<RegionIndex>& regions, RegionIndex& which) {
      labels_->values(point, regions, distances_.data());
      const auto end = distances_.begin() + static_cast<std::ptrdiff_t>(regions.size());
      const auto smallest = std::min_element(distances_.begin(), end);
      which = regions[static_cast<std::size_t>(smallest - distances_.begin())];
      return *smallest;
    };
    const float others = smallest_of(rules_.of_others, nearest_other_);
    const float distance = 0.5f * (smallest_of(rules_.of_protected, nearest_protected_) - others);
    return std::max(distance, static_cast<float>(beyond(point)));
  }
  /// Values but for a common term.
  void values_and_gradients(const Vec3& point, std::span<const RegionIndex> regions, double* out,
                            Vec3* slopes) override {
    const Vec3 place = label_place(point, bodies_->nearest(point));
    const Vec3 along = along_;
    const RegionIndex label = labels_->nearest(place).region;
    const Signed protection = protected_distance(point);
    const RegionIndex outside = outside_region;
    Signed depth;
    bodies_->values_and_gradients(point, {&outside, 1}, &depth.value, &depth.slope);
    if (protection.value < depth.value) depth = protection;
    for (const RegionIndex r : regions) {
      if (r > first_body_) {
        const auto body = static_cast<RegionIndex>(r - first_body_);
        bodies_->values_and_gradients(point, {&body, 1}, out, slopes);
        if (-protection.value > *out) *out = -protection.value, *slopes = -protection.slope;
      } else {
        const double sign = is_protected_at(point, r) && depth.value > 0 ? -1 : 1;
        *out = sign * depth.value;
        *slopes = sign * depth.slope;
        if (r != label) {
          const bool here = is_protected(r) && place != point;
          const RegionIndex both[2] = {r, here ? labels_->nearest(point).region : label};
          double values[2];
          Vec3 of_labels[2];
          labels_->values_and_gradients(here ? point : place, both, values, of_labels);
          const Vec3 slope = of_labels[0] - of_labels[1];
          *out += values[0] - values[1];
          *slopes += here ? slope : Vec3(slope - slope.dot(along) * along);
        }
      }
      ++out;
      ++slopes;
    }
  }
  struct Signed {
    double value = HUGE_VAL;
    Vec3 slope = Vec3::Zero();
  };
  /// from_protected() with its gradient; infinite without protected labels.
  Signed protected_distance(const Vec3& point) {
    Signed distance;
    if (rules_.of_protected.empty()) return distance;
    (void)from_protected(point);
    const RegionIndex both[2] = {nearest_protected_, nearest_other_};
    double values[2];
    Vec3 slopes[2];
    labels_->values_and_gradients(point, both, values, slopes);
    const Signed inside{0.5 * (values[0] - values[1]), 0.5 * (slopes[0] - slopes[1])};
    Signed outside;
    outside.value = beyond(point, &outside.slope);
    return outside.value > inside.value ? outside : inside;
  }

  const Rules& rules_;
  const std::unique_ptr<FieldSampler> labels_, bodies_;
  const RegionIndex first_body_;  ///< the region before the first body's
  const float band_;              ///< lattice units
  const CellBox volume_;          ///< lattice units
  const double per_voxel_;        ///< lattice units
  const double layer_;            ///< around bodies, lattice units
  const double far_inside_;       ///< from the surfaces, lattice units
  Vec3 along_ = Vec3::Zero();     ///< of the last label_place(): unit normal, or zero
  std::vector<float> distances_;  ///< workspace of from_protected()
  RegionIndex nearest_protected_ = outside_region, nearest_other_ = outside_region;  ///< of from_protected()
  Sheets sheets_;
};

std::shared_ptr<const CarvedField> CarvedField::make(std::shared_ptr<const LabelField> labels,
                                                     std::shared_ptr<const MaterialField> bodies,
                                                     std::vector<std::uint8_t> is_protected, double layer,
                                                     unsigned crossed) {
  auto rules = std::make_shared<Rules>();
  if (std::find(is_protected.begin(), is_protected.end(), 1) == is_protected.end()) is_protected.clear();
  for (std::size_t r = 0; r < is_protected.size(); ++r)
    (is_protected[r] ? rules->of_protected : rules->of_others).push_back(static_cast<RegionIndex>(r));
  rules->is_protected = std::move(is_protected);
  rules->layer = layer;
  rules->crossed = crossed;
  rules->near_bodies = bodies->band_leaves(outside_region);
  return std::shared_ptr<const CarvedField>(
      new CarvedField(std::move(labels), std::move(bodies), std::move(rules)));
}

CarvedField::CarvedField(std::shared_ptr<const MaterialField> labels,
                         std::shared_ptr<const MaterialField> bodies, std::shared_ptr<const Rules> rules)
    : MaterialField(labels->voxels(), all_regions(*labels, *bodies),
                    std::ldexp(std::min(labels->band(), bodies->band()), -labels->refinement()),
                    labels->refinement()),
      labels_(std::move(labels)),
      bodies_(std::move(bodies)),
      rules_(std::move(rules)) {}

CarvedField::~CarvedField() { drop_samplers(); }

std::unique_ptr<FieldSampler> CarvedField::sampler() const {
  return std::make_unique<Sampler>(*this, labels_->sampler(), bodies_->sampler());
}

std::shared_ptr<const MaterialField> CarvedField::refined(int refinement) const {
  return std::shared_ptr<const CarvedField>(
      new CarvedField(labels_->refined(refinement), bodies_->refined(refinement), rules_));
}

std::shared_ptr<const MaterialField> CarvedField::with_true_walls() const {
  return std::shared_ptr<const CarvedField>(
      new CarvedField(labels_, bodies_->wall_changes()->with_true_walls(), rules_));
}

std::vector<MortonKey> CarvedField::interface_voxels() const {
  std::vector<MortonKey> keys = labels_->interface_voxels();
  if (rules_->of_protected.empty()) {
    // Deep inside bodies there is no interface of labels.
    const double half_diagonal = std::sqrt(0.75) * std::ldexp(1, bodies_->refinement());
    const double per_voxel = std::ldexp(1, bodies_->refinement());
    keys = parallel_collect<MortonKey>(
        0, keys.size(), CellGrains::elements,
        [&](std::size_t begin, std::size_t end, std::vector<MortonKey>& out) {
          const std::unique_ptr<FieldSampler> sampler = bodies_->sampler();
          for (std::size_t i = begin; i < end; ++i) {
            const auto [x, y, z] = morton_decode(keys[i]);
            const NearestRegion body = sampler->nearest(per_voxel * (Vec3(x, y, z) + Vec3::Constant(0.5)));
            if (body.region == outside_region || body.margin <= half_diagonal) out.push_back(keys[i]);
          }
        });
  }
  const std::vector<MortonKey> of_bodies = bodies_->interface_voxels();
  keys.insert(keys.end(), of_bodies.begin(), of_bodies.end());
  parallel_sort_unique(keys);
  return keys;
}

std::vector<LeafOrigin> CarvedField::band_leaves(RegionIndex region) const {
  const std::size_t labels = labels_->regions().size();
  if (region >= labels && rules_->of_protected.empty())
    return bodies_->band_leaves(static_cast<RegionIndex>(region - labels + 1));
  std::vector<LeafOrigin> leaves = rules_->near_bodies;
  const auto add = [&](RegionIndex label) {
    const std::vector<LeafOrigin> more = labels_->band_leaves(label);
    leaves.insert(leaves.end(), more.begin(), more.end());
  };
  if (region < labels)
    add(region);
  else
    for (const RegionIndex r : rules_->of_protected) add(r);
  parallel_sort_unique(leaves);
  return leaves;
}

std::optional<Vec3> CarvedField::project(const Vec3& point, MaterialOrOutside first, MaterialOrOutside second,
                                         double max_distance) const {
  if (first.has_value() != second.has_value() && crosses_border(first ? *first : *second))
    return bodies_->project(point, first, second, max_distance);
  return MaterialField::project(point, first, second, max_distance);
}

bool CarvedField::is_near_bodies(const Vec3& point) const {
  const Vec3 at = std::ldexp(1, -refinement()) * point;
  LeafOrigin leaf;
  for (int a = 0; a < 3; ++a) leaf[a] = static_cast<int>(std::floor(at[a] / leaf_side)) * leaf_side;
  return std::binary_search(rules_->near_bodies.begin(), rules_->near_bodies.end(), leaf);
}

bool CarvedField::is_certain(const Vec3& point) const {
  return !is_near_bodies(point) && labels_->volume()->is_certain(point);
}

bool CarvedField::leaves_out(RegionIndex region, const Vec3& point) const {
  const unsigned sides = sides_beyond(point, frame().volume());
  // A body with a face in a side that none crosses continues there, see continued_beyond().
  return region < labels_->regions().size() ? sides != 0 : (sides & ~rules_->crossed) != 0;
}

bool CarvedField::is_far_beyond(const Vec3& point) const {
  const CellBox volume = frame().volume();
  const double far = std::ldexp(LabelTuning::Carving::far_beyond, refinement());
  for (int a = 0; a < 3; ++a)
    if (point[a] < volume.low[a] - far || point[a] > volume.high[a] + far) return !is_near_bodies(point);
  return false;
}

bool CarvedField::crosses_border(MaterialTag material) const {
  const auto is_it = [&](const FieldRegion& r) { return r.tag == material; };
  return rules_->crossed != 0 && std::any_of(bodies_->regions().begin() + 1, bodies_->regions().end(), is_it);
}

}  // namespace tetwright
