#include "mesher/level_set_field.h"

#include <algorithm>
#include <cmath>

#include "common/parallel_sort.h"

namespace tetwright {

namespace {

/// Where two surfaces that face each other more or less are nearer than this (voxels) they are one: faces
/// that bodies have in common are known to a few hundredths of a voxel, near sharp edges to a few tenths, and
/// slivers of another region between them would be noise. Cosine between their normals.
constexpr double contact = 0.4, contact_facing = -0.7;
/// Cosine between the normals of two surfaces: nearer to -1 what is between them is a sheet; else it is a
/// wedge, which is thin at its edge whatever the cells.
constexpr double sheet_facing = -0.95;
/// Thinner sheets (voxels) are what is left between two faces that were meant to be one.
constexpr double noticed = 0.1;

std::vector<FieldRegion> names_of(const std::vector<LevelSetRegion>& regions) {
  std::vector<FieldRegion> out;
  for (const LevelSetRegion& r : regions) out.push_back({r.name, r.tag});
  return out;
}

}  // namespace

class LevelSetField::Sampler final : public FieldSampler {
 public:
  explicit Sampler(const LevelSetField& f)
      : FieldSampler(std::ldexp(1, f.refinement())),
        field(f),
        per_voxel(std::ldexp(1, f.refinement())),
        distances(f.level_sets().size()),
        gradients(f.level_sets().size()) {
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
  std::optional<Sheet> thinnest_sheet(const Vec3& point, double reach) override;

 private:
  void values_and_gradients(const Vec3& point, std::span<const RegionIndex> regions, double* out,
                            Vec3* slopes) override {
    read_gradients(point);
    for (RegionIndex r : regions) {
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
  }
  void read_gradients(const Vec3& point) {
    place = point;
    const Vec3 at = point / per_voxel;
    for (std::size_t j = 0; j < distances.size(); ++j)
      distances[j] = per_voxel * readers[j]->at(at, gradients[j]);
    has_gradients = true;
  }
  void read_voxel(int x, int y, int z) {
    place = per_voxel * Vec3(x, y, z);
    for (std::size_t j = 0; j < distances.size(); ++j)
      distances[j] = per_voxel * readers[j]->at_node(x, y, z);
    has_gradients = false;
  }

  /// The largest term of a region, and which one it is; more where the region is a sliver between surfaces
  /// in contact.
  double value(RegionIndex r) {
    const RegionTerm* unused;
    return value(r, unused);
  }
  double value(RegionIndex r, const RegionTerm*& largest) {
    const std::vector<RegionTerm>& terms = field.terms(r);
    double best = 0;
    largest = nullptr;
    for (const RegionTerm& t : terms) {
      const double v = signed_term(t);
      if (!largest || v > best) best = v, largest = &t;
    }
    const double thinnest = contact * per_voxel;
    if (terms.size() < 2 || best < -thinnest || best > thinnest) return best;
    double more = 0;
    for (std::size_t i = 0; i < terms.size(); ++i)
      for (std::size_t k = i + 1; k < terms.size(); ++k)
        if (in_contact(terms[i], terms[k]) && cosine(terms[i], terms[k]) < contact_facing)
          more = std::max(more, thinnest - sheet(terms[i], terms[k]));
    return best + more;
  }
  /// Across a sheet one distance grows as the other falls: the sum is its thickness anywhere.
  double sheet(const RegionTerm& a, const RegionTerm& b) const { return -signed_term(a) - signed_term(b); }
  bool in_contact(const RegionTerm& a, const RegionTerm& b) const {
    return a.body != b.body && sheet(a, b) < contact * per_voxel;
  }
  /// Of the angle between the directions in which two terms grow.
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
  Vec3 place;        ///< where was read, lattice units
  bool has_gradients = false;
  std::vector<std::unique_ptr<LevelSetSampler>> readers;
  std::vector<double> distances;
  std::vector<Vec3> gradients;
};

LevelSetField::LevelSetField(const GridFrame& voxels, std::vector<std::shared_ptr<const LevelSet>> level_sets,
                             std::vector<LevelSetRegion> regions, int refinement)
    : MaterialField(voxels, names_of(regions), level_set_band, refinement),
      level_sets_(std::move(level_sets)),
      level_set_regions_(std::move(regions)) {}

LevelSetField::~LevelSetField() = default;

std::unique_ptr<FieldSampler> LevelSetField::sampler() const { return std::make_unique<Sampler>(*this); }

std::shared_ptr<const MaterialField> LevelSetField::refined(int refinement) const {
  return std::make_shared<LevelSetField>(voxels(), level_sets_, level_set_regions_, refinement);
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
  // Where a later material covers an earlier one's surface there is no interface.
  constexpr std::size_t grain = 1024;
  return parallel_collect<MortonKey>(
      0, keys.size(), grain, [&](std::size_t begin, std::size_t end, std::vector<MortonKey>& out) {
        Sampler sampler(*this);
        const double voxel = std::ldexp(1, refinement());
        for (std::size_t i = begin; i < end; ++i) {
          const auto [x, y, z] = morton_decode(keys[i]);
          const RegionIndex first = sampler.nearest_at_voxel(x, y, z).region;
          bool mixed = false;
          for (int k = 1; k < 8 && !mixed; ++k)
            mixed = sampler.nearest_at_voxel(x + (k & 1), y + (k >> 1 & 1), z + (k >> 2)).region != first;
          // A sheet between equal corners: the middles of edges, faces and of the voxel.
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

std::optional<FieldSampler::Sheet> LevelSetField::Sampler::thinnest_sheet(const Vec3& point, double reach) {
  read_gradients(point);
  std::optional<Sheet> thinnest;
  for (std::size_t r = 1; r < field.regions().size(); ++r) {
    const auto& terms = field.terms(static_cast<RegionIndex>(r));
    if (terms.size() < 2 || value(static_cast<RegionIndex>(r)) > reach) continue;
    for (std::size_t i = 0; i < terms.size(); ++i)
      for (std::size_t k = i + 1; k < terms.size(); ++k) {
        const double thickness = sheet(terms[i], terms[k]);
        if (!(thickness > noticed * per_voxel) || cosine(terms[i], terms[k]) > sheet_facing) continue;
        if (!thinnest || thickness < thinnest->thickness)
          thinnest = Sheet{static_cast<RegionIndex>(r), thickness, in_contact(terms[i], terms[k])};
      }
  }
  return thinnest;
}

}  // namespace tetwright
