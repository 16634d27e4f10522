// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// A triangle prepared for distance queries of many points: squared_distance() with precomputed terms that
/// depend only on the triangle.
class TriangleDistance {
 public:
  TriangleDistance(const Vec3& a, const Vec3& b, const Vec3& c) : a_(a), ab_(b - a), ac_(c - a) {
    const double d00 = ab_.squaredNorm(), d01 = ab_.dot(ac_), d11 = ac_.squaredNorm();
    const double det = d00 * d11 - d01 * d01;
    if (det > 0) {
      // Dual vectors: their dot products are the barycentric coordinates of b and c.
      to_b_ = (d11 * ab_ - d01 * ac_) / det;
      to_c_ = (d00 * ac_ - d01 * ab_) / det;
      const Vec3 across = ab_.cross(ac_);
      normal_ = across / across.norm();
    }
    bc_ = ac_ - ab_;
    const double d22 = bc_.squaredNorm();
    if (d00 > 0) ab_share_ = ab_ / d00;
    if (d11 > 0) ac_share_ = ac_ / d11;
    if (d22 > 0) bc_share_ = bc_ / d22;
  }

  /// Squared distance of a point, or `at_most` if it is no smaller.
  double squared(const Vec3& p, double at_most) const {
    const Vec3 ap = p - a_;
    const double height = normal_.dot(ap), height2 = height * height;
    if (height2 >= at_most) return at_most;
    const double v = to_b_.dot(ap), w = to_c_.dot(ap);
    if (v >= 0 && w >= 0 && v + w <= 1 && !normal_.isZero(0)) return height2;
    // Distance along the edges. An edge that has the point on the triangle's side can be skipped: another one
    // is at least as near.
    double best = at_most;
    const auto segment = [&](const Vec3& from, const Vec3& along, const Vec3& share) {
      const double s = std::clamp(share.dot(from), 0.0, 1.0);
      best = std::min(best, (from - s * along).squaredNorm());
    };
    const bool flat = normal_.isZero(0);
    if (flat || w < 0) segment(ap, ab_, ab_share_);
    if (flat || v < 0) segment(ap, ac_, ac_share_);
    if (flat || v + w > 1) segment(ap - ab_, bc_, bc_share_);
    return best;
  }

 private:
  Vec3 a_, ab_, ac_, bc_;
  Vec3 to_b_ = Vec3::Zero(), to_c_ = Vec3::Zero(), normal_ = Vec3::Zero();  ///< zero for a flat triangle
  Vec3 ab_share_ = Vec3::Zero(), ac_share_ = Vec3::Zero(), bc_share_ = Vec3::Zero();
};

}  // namespace tetwright
