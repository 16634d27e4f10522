// SPDX-License-Identifier: Apache-2.0
#include "common/mesh/dihedral_counter.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace tetwright {

namespace {

constexpr std::size_t bins = DihedralHistogram::bins;

/// Cosines closer to each other may belong to equal angles. Rounding changes a cosine by less than 1e-15, and
/// the angle of dihedral_angles() by less than 1e-15 radians, which is less in its cosine. Angles of lattices
/// are at ends of bins (45, 60, 90 degrees) and are to be in one bin, whatever the rounding.
constexpr double uncertain = 1e-12;
/// Squared normals in this range neither underflow nor overflow in products of two.
constexpr double min_square = 1e-140, max_square = 1e140;

/// Finds the bin of a cosine.
class CosineBins {
 public:
  CosineBins() {
    static_assert(DihedralHistogram::step == 5);
    constexpr double cosine = 0.99619469809174555, sine = 0.08715574274765817;  // of 5 degrees
    double c = 1, s = 0;
    for (double& end : ends_) {
      const double next = c * cosine - s * sine;
      s = s * cosine + c * sine;
      c = next;
      end = c + uncertain;
    }
    for (std::size_t i = 0; i < cells; ++i) {
      const double largest = 2 * static_cast<double>(i + 1) / cells - 1;
      firsts_[i] = static_cast<std::uint8_t>(bin_from(0, largest));
    }
  }

  /// \param cosine at least -1 and at most 1, but for rounding
  std::size_t bin(double cosine) const {
    const double cell = std::clamp((cosine + 1) * (0.5 * cells), 0.0, cells - 1.0);
    return bin_from(firsts_[static_cast<std::size_t>(cell)], cosine);
  }

 private:
  static constexpr std::size_t cells = 256;

  std::size_t bin_from(std::size_t bin, double cosine) const {
    while (bin < ends_.size() && cosine < ends_[bin]) ++bin;
    return bin;
  }

  std::array<double, bins - 1> ends_;  ///< of all bins but the last: an angle at the end is not in the bin
  std::array<std::uint8_t, cells> firsts_{};  ///< first bin of equal parts of [-1, 1]
};

/// \param degrees 0 to 180
std::size_t dihedral_bin(double degrees) {
  constexpr double uncertain_degrees = 57.3 * uncertain;
  return std::min(bins - 1,
                  static_cast<std::size_t>((degrees + uncertain_degrees) / DihedralHistogram::step));
}

}  // namespace

void DihedralCounter::add_exact(double degrees) {
  if (std::isnan(degrees)) return;
  min_ = std::min(min_, degrees);
  max_ = std::max(max_, degrees);
  ++histogram_.counts[dihedral_bin(degrees)];
}

void DihedralCounter::add(const std::array<Vec3, 4>& tet) {
  static const CosineBins cosine_bins;
  std::array<Vec3, 4> normals;
  std::array<double, 4> scales;
  bool in_range = true;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto& f = tet_faces[k];
    normals[k] = (tet[f[1]] - tet[f[0]]).cross(tet[f[2]] - tet[f[0]]);
    const double square = normals[k].squaredNorm();
    in_range &= square > min_square && square < max_square;
    scales[k] = 1 / std::sqrt(square);
  }
  if (!in_range) {
    for (const double degrees : dihedral_angles(tet)) add_exact(degrees);
    return;
  }
  std::array<double, 6> exact;
  bool computed = false;
  for (std::size_t e = 0; e < 6; ++e) {
    // The two faces at an edge lie opposite the two vertices that are not on it.
    const auto& other = tet_edges[5 - e];
    const double cosine = -normals[other[0]].dot(normals[other[1]]) * (scales[other[0]] * scales[other[1]]);
    const std::size_t bin = cosine_bins.bin(cosine);
    const bool may_be_min = cosine > min_cosine_ - uncertain, may_be_max = cosine < max_cosine_ + uncertain;
    ++histogram_.counts[bin];
    if (!may_be_min && !may_be_max) continue;
    if (!computed) exact = dihedral_angles(tet);
    computed = true;
    min_ = std::min(min_, exact[e]);
    max_ = std::max(max_, exact[e]);
    min_cosine_ = std::max(min_cosine_, cosine);
    max_cosine_ = std::min(max_cosine_, cosine);
  }
}

void DihedralCounter::add(const DihedralCounter& other) {
  min_ = std::min(min_, other.min_);
  max_ = std::max(max_, other.max_);
  min_cosine_ = std::max(min_cosine_, other.min_cosine_);
  max_cosine_ = std::min(max_cosine_, other.max_cosine_);
  for (std::size_t b = 0; b < bins; ++b) histogram_.counts[b] += other.histogram_.counts[b];
}

}  // namespace tetwright
