#include "mesher/material_field.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "common/parallel_sort.h"

namespace tetwright {

MaterialField::MaterialField(const GridFrame& voxels, std::vector<std::shared_ptr<const LevelSet>> level_sets,
                             std::vector<FieldRegion> regions, int refinement)
    : voxels_(voxels),
      frame_(refined_frame(voxels, refinement)),
      refinement_(refinement),
      band_(std::ldexp(level_set_band, refinement)),
      level_sets_(std::move(level_sets)),
      regions_(std::move(regions)) {}

MaterialField::~MaterialField() = default;

std::shared_ptr<const MaterialField> MaterialField::refined(int refinement) const {
  return std::make_shared<MaterialField>(voxels_, level_sets_, regions_, refinement);
}

std::vector<MortonKey> MaterialField::interface_voxels() const {
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
        FieldSampler sampler(*this);
        const double voxel = std::ldexp(1, refinement_);
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

}  // namespace

struct FieldSampler::Impl {
  explicit Impl(const MaterialField& f)
      : field(f),
        per_voxel(std::ldexp(1, f.refinement())),
        values(f.level_sets().size()),
        gradients(f.level_sets().size()) {
    readers.reserve(values.size());
    for (const auto& level_set : f.level_sets())
      readers.push_back(std::make_unique<LevelSetSampler>(*level_set));
  }

  void read(const Vec3& point) {
    place = point;
    const Vec3 at = point / per_voxel;
    for (std::size_t j = 0; j < values.size(); ++j) values[j] = per_voxel * readers[j]->at(at);
    has_gradients = false;
  }
  void read_gradients(const Vec3& point) {
    place = point;
    const Vec3 at = point / per_voxel;
    for (std::size_t j = 0; j < values.size(); ++j) values[j] = per_voxel * readers[j]->at(at, gradients[j]);
    has_gradients = true;
  }
  void read_voxel(int x, int y, int z) {
    place = per_voxel * Vec3(x, y, z);
    for (std::size_t j = 0; j < values.size(); ++j) values[j] = per_voxel * readers[j]->at_node(x, y, z);
    has_gradients = false;
  }

  /// The largest term of a region, and which one it is; more where the region is a sliver between surfaces
  /// in contact.
  double value(RegionIndex r) {
    const RegionTerm* unused;
    return value(r, unused);
  }
  double value(RegionIndex r, const RegionTerm*& largest) {
    const std::vector<RegionTerm>& terms = field.regions()[r].terms;
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
    return t.negated ? -values[t.level_set] : values[t.level_set];
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

  const MaterialField& field;
  double per_voxel;  ///< lattice units
  Vec3 place;        ///< where was read, lattice units
  bool has_gradients = false;
  std::vector<std::unique_ptr<LevelSetSampler>> readers;
  std::vector<double> values;
  std::vector<Vec3> gradients;
};

FieldSampler::FieldSampler(const MaterialField& field) : impl_(std::make_unique<Impl>(field)) {}
FieldSampler::~FieldSampler() = default;

NearestRegion FieldSampler::nearest(const Vec3& point) {
  impl_->read(point);
  return impl_->nearest();
}

NearestRegion FieldSampler::nearest_at_voxel(int x, int y, int z) {
  impl_->read_voxel(x, y, z);
  return impl_->nearest();
}

void FieldSampler::values(const Vec3& point, std::span<const RegionIndex> regions, float* out) {
  impl_->read(point);
  for (RegionIndex r : regions) *out++ = static_cast<float>(impl_->value(r));
}

void FieldSampler::values_at_voxel(int x, int y, int z, std::span<const RegionIndex> regions, float* out) {
  impl_->read_voxel(x, y, z);
  for (RegionIndex r : regions) *out++ = static_cast<float>(impl_->value(r));
}

std::optional<RegionSet> FieldSampler::two_nearest(const Vec3& point) {
  impl_->read(point);
  const NearestRegion nearest = impl_->nearest();
  if (nearest.margin >= impl_->field.band()) return std::nullopt;
  double smallest = HUGE_VAL;
  RegionIndex second = nearest.region;
  for (std::size_t r = 0; r < impl_->field.regions().size(); ++r) {
    const auto region = static_cast<RegionIndex>(r);
    if (region == nearest.region) continue;
    if (const double v = impl_->value(region); v < smallest) smallest = v, second = region;
  }
  RegionSet both;
  both.insert(nearest.region);
  both.insert(second);
  return both;
}

double FieldSampler::between(RegionIndex a, RegionIndex b, const Vec3& point, Vec3& gradient) {
  impl_->read_gradients(point);
  const RegionTerm *ta, *tb;
  const double va = impl_->value(a, ta), vb = impl_->value(b, tb);
  gradient = 0.5 * (impl_->signed_gradient(*ta) - impl_->signed_gradient(*tb));
  return 0.5 * (va - vb);
}

bool FieldSampler::project(const RegionSet& regions, Vec3& point) {
  constexpr int steps = 8;
  constexpr double close_enough = 1e-3;  // voxels; far below what they resolve
  // Squared; below, the point is near a ridge of the distance.
  constexpr double smallest_slope = 0.1;
  // Damping (Levenberg 1944): two of the distances may be the same thing on one side of a junction curve, and
  // their difference has no slope there, but then it says nothing about the step either.
  constexpr double damping = 0.01;
  const double enough = close_enough * impl_->per_voxel;
  const int equations = regions.size() - 1;
  if (equations < 1) return false;
  Eigen::Matrix<double, Eigen::Dynamic, 3, 0, 3, 3> slopes(equations, 3);
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1> misses(equations);
  for (int step = 0; step < steps; ++step) {
    impl_->read_gradients(point);
    const RegionTerm *first, *other;
    const double value = impl_->value(regions[0], first);
    double worst = 0;
    for (int k = 0; k < equations; ++k) {
      misses[k] = 0.5 * (value - impl_->value(regions[k + 1], other));
      slopes.row(k) = 0.5 * (impl_->signed_gradient(*first) - impl_->signed_gradient(*other)).transpose();
      worst = std::max(worst, std::abs(misses[k]));
    }
    if (worst < enough) {
      const NearestRegion nearest = impl_->nearest();
      return regions.contains(nearest.region) || impl_->value(nearest.region) > value - 2 * enough;
    }
    if (equations == 1) {
      const double slope = slopes.row(0).squaredNorm();
      if (slope < smallest_slope) return false;
      point -= slopes.row(0).transpose() * (misses[0] / slope);
    } else {
      // The shortest step that makes all equal to first order.
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3> square = slopes * slopes.transpose();
      square.diagonal().array() += damping;
      point -= slopes.transpose() * square.partialPivLu().solve(misses);
    }
  }
  return false;
}

std::optional<FieldSampler::Sheet> FieldSampler::thinnest_sheet(const Vec3& point, double reach) {
  impl_->read_gradients(point);
  std::optional<Sheet> thinnest;
  for (std::size_t r = 1; r < impl_->field.regions().size(); ++r) {
    const auto& terms = impl_->field.regions()[r].terms;
    if (terms.size() < 2 || impl_->value(static_cast<RegionIndex>(r)) > reach) continue;
    for (std::size_t i = 0; i < terms.size(); ++i)
      for (std::size_t k = i + 1; k < terms.size(); ++k) {
        const double thickness = impl_->sheet(terms[i], terms[k]);
        if (!(thickness > noticed * impl_->per_voxel) || impl_->cosine(terms[i], terms[k]) > sheet_facing)
          continue;
        if (!thinnest || thickness < thinnest->thickness)
          thinnest = Sheet{static_cast<RegionIndex>(r), thickness, impl_->in_contact(terms[i], terms[k])};
      }
  }
  return thinnest;
}

std::optional<RegionIndex> MaterialField::find(Region region) const {
  if (!region) return outside_region;
  // A kept outside has a name and a tag, else region 0 has neither.
  for (std::size_t r = regions_[outside_region].name.empty() ? 1 : 0; r < regions_.size(); ++r)
    if (regions_[r].tag == *region) return static_cast<RegionIndex>(r);
  return std::nullopt;
}

double MaterialField::signed_distance(const Vec3& point, MaterialTag material) const {
  const std::optional<RegionIndex> region = find(material);
  float value = static_cast<float>(band_);
  if (region) FieldSampler(*this).values(frame_.to_grid(point), {&*region, 1}, &value);
  return frame_.cell_size * value;
}

std::optional<Vec3> MaterialField::project(const Vec3& point, Region first, Region second,
                                           double max_distance) const {
  const std::optional<RegionIndex> a = find(first), b = find(second);
  if (!a || !b || *a == *b) return std::nullopt;
  RegionSet both;
  both.insert(*a);
  both.insert(*b);
  const Vec3 start = frame_.to_grid(point);
  Vec3 end = start;
  if (!FieldSampler(*this).project(both, end)) return std::nullopt;
  if ((end - start).norm() * frame_.cell_size > max_distance) return std::nullopt;
  return frame_.to_input(end);
}

}  // namespace tetwright
