// SPDX-License-Identifier: Apache-2.0
#include "mesher/level_sets/level_set_field.h"

#include <algorithm>
#include <cmath>

#include "common/parallel/parallel_sort.h"
#include "mesher/tuning/distance_tuning.h"
#include "mesher/tuning/domain_tuning.h"

namespace tetwright {

namespace {

using Sheets = DistanceTuning::Sheets;

std::vector<FieldRegion> names_of(const std::vector<LevelSetRegion>& regions) {
  std::vector<FieldRegion> out;
  out.reserve(regions.size());
  for (const LevelSetRegion& r : regions) out.push_back({r.name, r.tag});
  return out;
}

std::array<int, 3> voxel_of(const Vec3& point) {
  std::array<int, 3> voxel;
  for (int a = 0; a < 3; ++a) voxel[a] = static_cast<int>(std::max(0.0, std::floor(point[a])));
  return voxel;
}

}  // namespace

class LevelSetField::Sampler final : public FieldSampler, private SheetSampler {
 public:
  explicit Sampler(const LevelSetField& f)
      : FieldSampler(std::ldexp(1, f.refinement())),
        field(f),
        per_voxel(std::ldexp(1, f.refinement())),
        distances(f.level_sets().size()),
        gradients(f.level_sets().size()),
        carved(f.terms(outside_region).size()) {
    readers.reserve(distances.size());
    for (const auto& level_set : f.level_sets())
      readers.push_back(std::make_unique<LevelSetSampler>(*level_set));
  }

  NearestRegion nearest(const Vec3& point) override {
    read(point);
    return nearest();
  }
  NearestRegion nearest_at_voxel(int x, int y, int z) override {
    read_voxel(x, y, z);
    return nearest();
  }
  void values(const Vec3& point, std::span<const RegionIndex> regions, float* out) override {
    read(point);
    for (RegionIndex r : regions) *out++ = static_cast<float>(value(r));
  }
  void values_at_voxel(int x, int y, int z, std::span<const RegionIndex> regions, float* out) override {
    read_voxel(x, y, z);
    for (RegionIndex r : regions) *out++ = static_cast<float>(value(r));
  }
  std::optional<RegionSet> two_nearest(const Vec3& point) override;
  SheetSampler* sheets() override { return distances.size() > 1 ? this : nullptr; }

 private:
  std::optional<FieldSheet> thinnest_sheet(const Vec3& point, double reach) override;
  std::optional<FieldSheet> thinnest_sheet_in_zone(double reach);
  std::optional<FieldSheet> sheet_here() const;
  void values_and_gradients(const Vec3& point, std::span<const RegionIndex> regions, double* out,
                            Vec3* slopes) override {
    read_gradients(point);
    for (RegionIndex r : regions) {
      if (in_zone) {
        *out++ = zone_value(r, slopes++);
        continue;
      }
      const RegionTerm* largest;
      *out++ = value(r, largest);
      *slopes++ = signed_gradient(*largest);
    }
  }

  void read(const Vec3& point) {
    place = point;
    const Vec3 at = point / per_voxel;
    for (std::size_t j = 0; j < distances.size(); ++j) distances[j] = per_voxel * readers[j]->at(at);
    has_gradients = false;
    find_carving_maxima();
    enter_zone(at);
  }
  void read_gradients(const Vec3& point) {
    place = point;
    const Vec3 at = point / per_voxel;
    for (std::size_t j = 0; j < distances.size(); ++j)
      distances[j] = per_voxel * readers[j]->at(at, gradients[j]);
    has_gradients = true;
    find_carving_maxima();
    enter_zone(at);
  }
  void read_voxel(int x, int y, int z) {
    place = per_voxel * Vec3(x, y, z);
    for (std::size_t j = 0; j < distances.size(); ++j)
      distances[j] = per_voxel * readers[j]->at_node(x, y, z);
    has_gradients = false;
    find_carving_maxima();
    enter_zone(Vec3(x, y, z));
  }

  /// Looks up the complex where it decides.
  void enter_zone(const Vec3& at) {
    in_zone = field.zone() && field.zone()->contains(at);
    if (!in_zone) return;
    place_in_voxels = at;
    here = field.zone()->nearest(at);
    narrow = field.has_layers() ? std::nullopt : field.zone()->narrow(at, here);
  }
  /// The signed distance of one of the three regions at a narrow part: the region between them gives way to
  /// the later one of both others, so that the earlier one's surface stays as it is. The outside comes last.
  ContactZone::Distance narrow_value(RegionIndex r) const {
    const ContactZone::Distance &near = here.distance, &far = narrow->distance;
    const auto negative = [](const ContactZone::Distance& d) {
      return ContactZone::Distance{-d.value, -d.gradient};
    };
    const bool near_first =
        narrow->across == outside_region || (here.across != outside_region && here.across < narrow->across);
    const ContactZone::Distance &first = near_first ? near : far, &later = near_first ? far : near;
    if (r == (near_first ? here.across : narrow->across)) return first;
    const ContactZone::Distance moved{later.value - narrow->deficit, later.gradient - narrow->slope};
    const ContactZone::Distance own = r == here.region ? negative(moved) : moved;
    return own.value < -first.value ? negative(first) : own;
  }
  bool gives_way() const { return narrow && narrow->deficit > 0; }
  /// The signed distance of a region in the zone: that of its body, and of the other surfaces by which layers
  /// divide the body.
  double zone_value(RegionIndex r, Vec3* gradient) {
    const LevelSetRegion& region = field.level_set_regions()[r];
    if (gives_way() && (region.of_complex == here.region || region.of_complex == here.across ||
                        region.of_complex == narrow->across)) {
      const ContactZone::Distance d = narrow_value(region.of_complex);
      if (gradient) *gradient = d.gradient;
      return per_voxel * d.value;
    }
    const bool inside = region.of_complex == here.region;
    const auto distance = field.zone()->distance(place_in_voxels, region.of_complex);
    double best = per_voxel * (distance ? distance->value : level_set_band) * (inside ? -1 : 1);
    if (gradient)
      *gradient = distance ? Vec3(inside ? -distance->gradient : distance->gradient) : Vec3(Vec3::Zero());
    for (std::size_t i = 0; i < field.own_terms(r); ++i) {
      const RegionTerm& term = region.terms[i];
      if (!term.offset || signed_term(term) <= best) continue;
      best = signed_term(term);
      if (gradient) *gradient = signed_gradient(term);
    }
    return best;
  }

  /// For each of the outside's terms, finds the largest of this and the following terms; ties go to the
  /// first. Every region shares its last terms with the outside, see LevelSetField::own_terms().
  void find_carving_maxima() {
    const std::vector<RegionTerm>& terms = field.terms(outside_region);
    for (std::size_t i = terms.size(); i-- > 0;) {
      const double v = signed_term(terms[i]);
      carved[i] = i + 1 == terms.size() || v >= carved[i + 1].value ? Carving{v, &terms[i]} : carved[i + 1];
    }
  }

  /// The signed distance of a region and its largest term. The distance is increased where the region is a
  /// sliver between surfaces in contact. Costs O(own terms), except near the region's surface.
  double value(RegionIndex r) {
    if (in_zone) return zone_value(r, nullptr);
    const RegionTerm* unused;
    return value(r, unused);
  }
  double value(RegionIndex r, const RegionTerm*& largest) {
    const std::vector<RegionTerm>& terms = field.terms(r);
    const std::size_t own = field.own_terms(r);
    double best = 0;
    largest = nullptr;
    for (std::size_t i = 0; i < own; ++i) {
      const double v = signed_term(terms[i]);
      if (!largest || v > best) best = v, largest = &terms[i];
    }
    if (own < terms.size()) {
      const Carving& carving = carved[carved.size() - (terms.size() - own)];
      if (!largest || carving.value > best) best = carving.value, largest = carving.term;
    }
    const double thinnest = Sheets::contact * per_voxel;
    if (terms.size() < 2 || best < -thinnest || best > thinnest) return best;
    return best + sliver_excess(terms, best);
  }
  /// The maximum, over pairs of bodies in contact that face each other, of the contact distance minus the
  /// thickness of the region between them; 0 where the region is not a sliver.
  /// \param best the largest term
  double sliver_excess(const std::vector<RegionTerm>& terms, double best) {
    const double thinnest = Sheets::contact * per_voxel;
    // The terms of a sliver add up to more than -thinnest, so none is below this. The factor allows for
    // rounding.
    const double smallest = -1.001 * (thinnest + std::abs(best));
    candidates.clear();
    for (const RegionTerm& t : terms)
      if (signed_term(t) >= smallest) candidates.push_back(&t);
    double more = 0;
    for (std::size_t i = 0; i < candidates.size(); ++i)
      for (std::size_t k = i + 1; k < candidates.size(); ++k)
        if (const RegionTerm& a = *candidates[i], &b = *candidates[k];
            in_contact(a, b) && cosine(a, b) < Sheets::contact_cosine)
          more = std::max(more, thinnest - sheet(a, b));
    return more;
  }
  /// The thickness of the region between two terms: one grows as the other falls, so minus their sum is
  /// constant.
  double sheet(const RegionTerm& a, const RegionTerm& b) const { return -signed_term(a) - signed_term(b); }
  bool in_contact(const RegionTerm& a, const RegionTerm& b) const {
    return a.body != b.body && sheet(a, b) < Sheets::contact * per_voxel;
  }
  /// Cosine of the angle between the gradients of two terms.
  double cosine(const RegionTerm& a, const RegionTerm& b) {
    if (!has_gradients) {
      const Vec3 at = place / per_voxel;
      for (const RegionTerm& t : {a, b}) readers[t.level_set]->at(at, gradients[t.level_set]);
    }
    const Vec3 ga = signed_gradient(a), gb = signed_gradient(b);
    const double lengths = ga.norm() * gb.norm();
    return lengths > 0 ? ga.dot(gb) / lengths : 0;
  }
  double signed_term(const RegionTerm& t) const {
    return t.negated ? -distances[t.level_set] : distances[t.level_set];
  }
  Vec3 signed_gradient(const RegionTerm& t) const {
    return t.negated ? Vec3(-gradients[t.level_set]) : gradients[t.level_set];
  }

  NearestRegion nearest() {
    if (in_zone && !field.has_layers() && !gives_way())
      return {here.region, static_cast<float>(std::min(per_voxel * here.distance.value, field.band()))};
    const std::size_t count = field.regions().size();
    RegionIndex best = 0;
    double smallest = value(0), next = HUGE_VAL;
    for (std::size_t r = 1; r < count; ++r) {
      const double v = value(static_cast<RegionIndex>(r));
      if (v < smallest) {
        next = smallest;
        smallest = v;
        best = static_cast<RegionIndex>(r);
      } else if (v < next) {
        next = v;
      }
    }
    return {best, static_cast<float>(std::min(0.5 * (next - smallest), field.band()))};
  }

  const LevelSetField& field;
  double per_voxel;  ///< lattice units
  Vec3 place;        ///< last point read, lattice units
  bool has_gradients = false;
  bool in_zone = false;  ///< the complex decides at the last point read, with the following three
  Vec3 place_in_voxels;
  ContactZone::Nearest here{};
  std::optional<ContactZone::Narrow> narrow;
  std::vector<std::unique_ptr<LevelSetSampler>> readers;
  std::vector<double> distances;
  std::vector<Vec3> gradients;
  /// The largest of the outside's terms starting from a given one.
  struct Carving {
    double value;
    const RegionTerm* term;
  };
  std::vector<Carving> carved;
  std::vector<const RegionTerm*> candidates;  ///< workspace of sliver_excess()
};

LevelSetField::LevelSetField(const GridFrame& voxels, std::vector<std::shared_ptr<const LevelSet>> level_sets,
                             std::vector<LevelSetRegion> regions, std::shared_ptr<const ContactZone> zone,
                             std::shared_ptr<const SheetZone> sheets, int refinement)
    : MaterialField(voxels, names_of(regions), level_set_band, refinement),
      level_sets_(std::move(level_sets)),
      level_set_regions_(std::move(regions)),
      zone_(std::move(zone)),
      sheets_(std::move(sheets)) {
  const std::vector<RegionTerm>& carving = level_set_regions_[outside_region].terms;
  for (std::size_t r = 1; r < level_set_regions_.size(); ++r)
    has_layers_ |= r > 1 && level_set_regions_[r].of_complex == level_set_regions_[r - 1].of_complex;
  for (const LevelSetRegion& region : level_set_regions_) {
    const auto shared =
        std::mismatch(region.terms.rbegin(), region.terms.rend(), carving.rbegin(), carving.rend());
    own_terms_.push_back(static_cast<std::size_t>(region.terms.rend() - shared.first));
  }
}

LevelSetField::~LevelSetField() { drop_samplers(); }

std::unique_ptr<FieldSampler> LevelSetField::sampler() const { return std::make_unique<Sampler>(*this); }

std::shared_ptr<const MaterialField> LevelSetField::refined(int refinement) const {
  return std::make_shared<LevelSetField>(voxels(), level_sets_, level_set_regions_, zone_, sheets_,
                                         refinement);
}

const WallChanges* LevelSetField::wall_changes() const {
  const bool any = std::any_of(level_sets_.begin(), level_sets_.end(),
                               [](const auto& level_set) { return level_set->walls() != nullptr; });
  return any ? this : nullptr;
}

std::shared_ptr<const MaterialField> LevelSetField::with_true_walls() const {
  std::vector<std::shared_ptr<const LevelSet>> as_is;
  for (const auto& level_set : level_sets_) as_is.push_back(LevelSet::with_true_walls(level_set));
  return std::make_shared<LevelSetField>(voxels(), std::move(as_is), level_set_regions_, zone_, sheets_,
                                         refinement());
}

bool LevelSetField::contains(const Vec3& point) const {
  const Vec3 at = std::ldexp(1, -refinement()) * point;
  return std::any_of(level_sets_.begin(), level_sets_.end(), [&](const auto& level_set) {
    return level_set->walls() && level_set->walls()->depth(voxel_of(at)) >= 0;
  });
}

double LevelSetField::parallel_thickness(const Vec3& point) const {
  const Vec3 at = std::ldexp(1, -refinement()) * point;
  double thinnest = HUGE_VAL;
  for (const auto& level_set : level_sets_)
    if (const WallDistances* walls = level_set->walls())
      if (const int depth = walls->depth(voxel_of(at)); depth >= 0)
        thinnest = std::min(thinnest, walls->parallel_thickness(at, depth));
  return std::ldexp(thinnest, refinement());
}

std::vector<LeafOrigin> LevelSetField::band_leaves(RegionIndex region) const {
  std::vector<LeafOrigin> all;
  for (const RegionTerm& term : terms(region)) {
    const std::vector<LeafOrigin> leaves = level_sets_[term.level_set]->leaves();
    all.insert(all.end(), leaves.begin(), leaves.end());
  }
  parallel_sort_unique(all);
  return all;
}

std::vector<MortonKey> LevelSetField::interface_voxels() const {
  std::vector<MortonKey> keys;
  for (const auto& level_set : level_sets_) {
    const std::vector<MortonKey> crossed = level_set->interface_cells();
    keys.insert(keys.end(), crossed.begin(), crossed.end());
  }
  if (level_sets_.size() == 1) return keys;
  parallel_sort_unique(keys);
  // The surface of a material has no interface where a later material covers it.
  return parallel_collect<MortonKey>(
      0, keys.size(), DistanceGrains::cells_of_regions,
      [&](std::size_t begin, std::size_t end, std::vector<MortonKey>& out) {
        Sampler sampler(*this);
        const double voxel = std::ldexp(1, refinement());
        for (std::size_t i = begin; i < end; ++i) {
          const auto [x, y, z] = morton_decode(keys[i]);
          const RegionIndex first = sampler.nearest_at_voxel(x, y, z).region;
          bool mixed = false;
          for (int k = 1; k < 8 && !mixed; ++k)
            mixed = sampler.nearest_at_voxel(x + (k & 1), y + (k >> 1 & 1), z + (k >> 2)).region != first;
          // A sheet may lie between equal corners: test midpoints of edges, centres of faces and of the
          // voxel.
          for (int k = 0; k < 27 && !mixed; ++k) {
            const int i0 = k % 3, i1 = k / 3 % 3, i2 = k / 9;
            if (i0 != 1 && i1 != 1 && i2 != 1) continue;
            const Vec3 place = voxel * Vec3(x + 0.5 * i0, y + 0.5 * i1, z + 0.5 * i2);
            mixed = sampler.nearest(place).region != first;
          }
          if (mixed) out.push_back(keys[i]);
        }
      });
}

std::optional<RegionSet> LevelSetField::Sampler::two_nearest(const Vec3& point) {
  read(point);
  const NearestRegion first = nearest();
  if (first.margin >= field.band()) return std::nullopt;
  double smallest = HUGE_VAL;
  RegionIndex second = first.region;
  for (std::size_t r = 0; r < field.regions().size(); ++r) {
    const auto region = static_cast<RegionIndex>(r);
    if (region == first.region) continue;
    if (const double v = value(region); v < smallest) smallest = v, second = region;
  }
  RegionSet both;
  both.insert(first.region);
  both.insert(second);
  return both;
}

/// \pre in_zone; reads another point
std::optional<FieldSheet> LevelSetField::Sampler::thinnest_sheet_in_zone(double reach) {
  if (here.distance.value > reach / per_voxel) return {};
  const std::optional<FieldSheet> own = sheet_here();
  // The point may be beside the sheet.
  enter_zone(place_in_voxels - (here.distance.value + Sheets::depth) * here.distance.gradient);
  const std::optional<FieldSheet> across = in_zone ? sheet_here() : std::nullopt;
  return !own || (across && across->thickness < own->thickness) ? across : own;
}

std::optional<FieldSheet> LevelSetField::Sampler::sheet_here() const {
  if (!narrow || here.region == outside_region) return {};
  if (narrow->cosine <= Sheets::max_cosine) {
    if (narrow->thickness < Sheets::min_thickness) return {};
    return FieldSheet{here.region, per_voxel * narrow->thickness, false};
  }
  // A wedge is thin at its edge in cells of any size: if it is sharp, or no other material fills the space
  // around it, the smallest ones have to do there.
  if (narrow->cosine > Sheets::max_wedge_cosine && here.across != outside_region &&
      narrow->across != outside_region)
    return {};
  constexpr double smallest = Sheets::min_cells / (1 << DomainTuning::Refinement::max_levels);
  return FieldSheet{here.region, per_voxel * std::max(smallest, narrow->thickness), false};
}

std::optional<FieldSheet> LevelSetField::Sampler::thinnest_sheet(const Vec3& point, double reach) {
  read_gradients(point);
  if (in_zone) return thinnest_sheet_in_zone(reach);
  std::optional<FieldSheet> thinnest;
  for (std::size_t r = 1; r < field.regions().size(); ++r) {
    const auto& terms = field.terms(static_cast<RegionIndex>(r));
    if (terms.size() < 2 || value(static_cast<RegionIndex>(r)) > reach) continue;
    for (std::size_t i = 0; i < terms.size(); ++i)
      for (std::size_t k = i + 1; k < terms.size(); ++k) {
        const double thickness = sheet(terms[i], terms[k]);
        if (!(thickness > Sheets::min_thickness * per_voxel) ||
            cosine(terms[i], terms[k]) > Sheets::max_cosine)
          continue;
        if (!thinnest || thickness < thinnest->thickness)
          thinnest = FieldSheet{static_cast<RegionIndex>(r), thickness, in_contact(terms[i], terms[k])};
      }
  }
  return thinnest;
}

}  // namespace tetwright
